#include "mesh/io/unpack.h"

#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "core/text/utf8.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;

struct DiscardArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct CloseEntry {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

// A file without a name. The system deletes it after its last use.
class ScratchFile {
 public:
  static Result<ScratchFile> make(const std::filesystem::path& folder) {
    std::string path = (folder / "strata-unpack-XXXXXX").string();
    ScratchFile file;
    file.descriptor_ = ::mkstemp(path.data());
    if (file.descriptor_ < 0)
      return fail(ErrorCode::storage_full, "No space to unpack",
                  "The server cannot create a file for unpacking in " + folder.string() + ": " +
                      std::strerror(errno) + ".");
    ::unlink(path.c_str());
    return file;
  }
  ScratchFile(ScratchFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  ScratchFile& operator=(ScratchFile&&) = delete;
  ~ScratchFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  Result<void> append(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0)
        return fail(
            ErrorCode::storage_full, "No space to unpack",
            std::string("The server cannot unpack the archive: ") + std::strerror(errno) + ".");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
  }
  Result<MappedFile> map() const {
    return MappedFile::open("/proc/self/fd/" + std::to_string(descriptor_));
  }

 private:
  ScratchFile() = default;
  int descriptor_ = -1;
};

// Returns true for folders and for files added by macOS.
bool is_hidden(std::string_view name) {
  if (name.starts_with("__MACOSX/") || name.ends_with('/')) return true;
  return name.substr(name.find_last_of("/\\") + 1).starts_with('.');
}

class Unpacker {
 public:
  Unpacker(std::span<const std::uint8_t> zip, const std::filesystem::path& scratch,
           Progress& progress, const std::function<bool(std::string_view)>& accepts)
      : zip_(zip),
        scratch_(scratch),
        progress_(progress),
        accepts_(accepts),
        room_(zip.size() * kMaxUnpackGain + kUnpackAlways) {}

  Result<std::vector<InputFiles::Entry>> run() {
    STRATA_TRY(open());
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    if (count < 0 || static_cast<std::uint64_t>(count) > kMaxArchiveEntries)
      return refuse_file("The zip contains " + std::to_string(count) + " files; at most " +
                         std::to_string(kMaxArchiveEntries) +
                         " are allowed. Pack only one scan with its pictures.");
    std::vector<InputFiles::Entry> entries;
    for (zip_int64_t i = 0; i < count; ++i) {
      progress_.report(0, "Unpacking");
      const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
      if (name == nullptr || is_hidden(name) || !accepts_(name)) continue;
      auto entry = STRATA_TRY(unpack(static_cast<zip_uint64_t>(i), mended_utf8(name)));
      entries.push_back(std::move(entry));
    }
    return entries;
  }

 private:
  Result<void> open() {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(zip_.data(), zip_.size(), 0, &error);
    if (source != nullptr) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
    if (!archive_) {
      if (source != nullptr) zip_source_free(source);
      const std::string why = zip_error_strerror(&error);
      zip_error_fini(&error);
      return refuse_file("The zip cannot be opened: " + why +
                         ". Create the zip or upload it again.");
    }
    zip_error_fini(&error);
    return {};
  }

  Result<InputFiles::Entry> unpack(zip_uint64_t index, const std::string& name) {
    std::string shown;
    for (const char c : name.substr(0, 200))
      shown += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    const auto damaged = [&](const std::string& why) {
      return refuse_file("\"" + shown + "\" in the zip cannot be unpacked: " + why + ".");
    };
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(archive_.get(), index, 0, &stat) != 0)
      return damaged(zip_strerror(archive_.get()));
    if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
      return damaged("it is encrypted. Create the zip without a password");
    const std::unique_ptr<zip_file_t, CloseEntry> file(zip_fopen_index(archive_.get(), index, 0));
    if (!file) return damaged(zip_strerror(archive_.get()));
    auto scratch = STRATA_TRY(ScratchFile::make(scratch_));
    if (chunk_.empty()) chunk_.resize(kChunk);
    for (;;) {
      if (progress_.cancelled()) return cancelled_problem();
      const zip_int64_t read = zip_fread(file.get(), chunk_.data(), chunk_.size());
      if (read < 0) return damaged(zip_file_strerror(file.get()));
      if (read == 0) break;
      if (static_cast<std::uint64_t>(read) > room_)
        return refuse_file("The unpacked files are more than " + std::to_string(kMaxUnpackGain) +
                           " times as large as the zip. If this is correct, send the files without "
                           "the zip.");
      room_ -= static_cast<std::uint64_t>(read);
      STRATA_TRY(scratch.append({chunk_.data(), static_cast<std::size_t>(read)}));
    }
    auto mapped = STRATA_TRY(scratch.map());
    const auto bytes = mapped.bytes();
    return InputFiles::Entry{name, bytes, std::move(mapped)};
  }

  std::span<const std::uint8_t> zip_;
  const std::filesystem::path& scratch_;
  Progress& progress_;
  const std::function<bool(std::string_view)>& accepts_;
  std::uint64_t room_;
  std::unique_ptr<zip_t, DiscardArchive> archive_;
  std::vector<std::uint8_t> chunk_;
};

}  // namespace

bool is_scan_file(std::string_view name) {
  static constexpr std::array<std::string_view, 11> kCompanions{
      ".mtl", ".bin", ".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp", ".bmp", ".tga", ".ktx2"};
  if (input_kind(name) != InputKind::companion) return true;
  std::string lower(name.substr(name.find_last_of("/\\") + 1));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::any_of(kCompanions.begin(), kCompanions.end(),
                     [&](auto ending) { return lower.ends_with(ending); });
}

Result<std::vector<InputFiles::Entry>> unpack_archive(
    std::span<const std::uint8_t> zip, const std::filesystem::path& scratch, Progress& progress,
    const std::function<bool(std::string_view)>& accepts) {
  return Unpacker(zip, scratch, progress, accepts).run();
}

}  // namespace strata::mesh
