#include "mesh/load.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "mesh/load_formats.h"

namespace strata::mesh {
namespace {

// A file as read-only memory. The file must not shrink meanwhile: uploads and imports are finished before they are
// read.
class MappedFile {
 public:
  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile() {
    if (data_) ::munmap(data_, size_);
  }

  static Result<MappedFile> open(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return refuse_file("The file cannot be opened: " + std::string(std::strerror(errno)) + ".");
    MappedFile mapped;
    struct stat status {};
    const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
    if (regular && status.st_size > 0) {
      void* data = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, MAP_PRIVATE, descriptor, 0);
      if (data != MAP_FAILED) {
        mapped.data_ = data;
        mapped.size_ = static_cast<std::size_t>(status.st_size);
        ::madvise(data, mapped.size_, MADV_SEQUENTIAL);
      }
    }
    const int error = errno;
    ::close(descriptor);
    if (!regular) return refuse_file("This is not a regular file.");
    if (status.st_size > 0 && !mapped.data_)
      return refuse_file("The file cannot be read: " + std::string(std::strerror(error)) + ".");
    return mapped;
  }

  std::span<const std::uint8_t> bytes() const { return {static_cast<const std::uint8_t*>(data_), size_}; }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

enum class Format { ply, obj };

Result<Format> format_of(const std::string& filename) {
  std::string extension = std::filesystem::path(filename).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (extension == ".ply") return Format::ply;
  if (extension == ".obj") return Format::obj;
  return fail(415, "Unknown mesh format", "\"" + extension + "\" files are not read; give a .ply or an .obj.",
              "filename");
}

Result<LoadedMesh> parse(Format format, std::span<const std::uint8_t> bytes, Progress& progress) {
  if (bytes.empty()) return refuse_file("The file is empty.");
  auto loaded = format == Format::ply ? parse_ply(bytes, progress) : parse_obj(bytes, progress);
  if (!loaded) return loaded;
  if (loaded->mesh.triangles.empty()) {
    return refuse_file(
        loaded->mesh.positions.empty()
            ? "The file holds no triangle: it is empty."
            : "The file holds " + std::to_string(loaded->mesh.positions.size()) +
                  " vertices but no triangle: a point cloud cannot carry layers. Mesh it before importing it.");
  }
  return loaded;
}

}  // namespace

Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename, Progress& progress) {
  const auto format = format_of(filename);
  if (!format) return tl::unexpected(format.error());
  auto loaded = [&]() -> Result<LoadedMesh> {
    const auto mapped = MappedFile::open(file);
    if (!mapped) return tl::unexpected(mapped.error());
    return parse(*format, mapped->bytes(), progress);
  }();  // unmapped here: `repair` needs the memory
  if (!loaded) return loaded;
  if (auto repaired = repair(*loaded, progress); !repaired) return tl::unexpected(repaired.error());
  return loaded;
}

Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress) {
  const auto format = format_of(filename);
  if (!format) return tl::unexpected(format.error());
  auto loaded = parse(*format, bytes, progress);
  if (!loaded) return loaded;
  if (auto repaired = repair(*loaded, progress); !repaired) return tl::unexpected(repaired.error());
  return loaded;
}

}  // namespace strata::mesh
