#include "mesh/load.h"

#include "core/mapped_file.h"
#include "mesh/load_formats.h"

namespace strata::mesh {
namespace {

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
    if (!mapped) return refuse_file(mapped.error().detail);
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
