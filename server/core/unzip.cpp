#include "core/unzip.h"

#include <zip.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/text/utf8.h"

namespace strata {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPiece = 1u << 20;
constexpr std::size_t kMaxPath = 4000;  // bytes

struct DiscardZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

class Unzipper {
 public:
  Unzipper(const fs::path& folder, Progress& progress) : folder_(folder), progress_(progress) {}

  Result<void> run(const fs::path& zip, const UnzipLimits& limits) {
    int error = 0;
    zip_.reset(zip_open(zip.c_str(), ZIP_RDONLY, &error));
    if (!zip_)
      return fail(ErrorCode::invalid, "Not a zip",
                  zip.string() + " cannot be opened as a zip. Download the file again.");
    std::error_code ignored;
    STRATA_TRY(check_sizes(limits, fs::file_size(zip, ignored)));
    for (zip_uint64_t i = 0; i < count_; ++i) STRATA_TRY(unpack(i));
    return {};
  }

 private:
  static tl::unexpected<Error> refuse(const std::string& name, const std::string& why) {
    return fail(ErrorCode::invalid, "Zip damaged",
                "The file " + mended_utf8(name.substr(0, 300)) + " in the zip " + why + ".");
  }

  // All sizes are known before the first byte is written.
  Result<void> check_sizes(const UnzipLimits& limits, std::uint64_t zip_bytes) {
    count_ =
        static_cast<zip_uint64_t>(std::max<zip_int64_t>(0, zip_get_num_entries(zip_.get(), 0)));
    if (count_ > limits.files)
      return fail(ErrorCode::too_large, "Too many files",
                  "The zip contains " + std::to_string(count_) + " files. At most " +
                      std::to_string(limits.files) + " are allowed.");
    std::uint64_t packed = 0;
    for (zip_uint64_t i = 0; i < count_; ++i) {
      zip_stat_t stat;
      zip_stat_init(&stat);
      if (zip_stat_index(zip_.get(), i, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
        return refuse(name_of(i), "is damaged");
      if (stat.size > limits.bytes - total_)
        return fail(ErrorCode::too_large, "Zip too large",
                    "The unpacked files have more than " + std::to_string(limits.bytes) +
                        " bytes. Free disk space, or set TMPDIR to a larger disk.");
      total_ += stat.size;
      packed += std::min<std::uint64_t>(stat.comp_size, zip_bytes + 1);
    }
    if (packed > zip_bytes)
      return fail(ErrorCode::too_large, "Zip refused",
                  "Files in the zip share their bytes, as in a zip bomb. Get the file from its "
                  "publisher again.");
    return {};
  }

  std::string name_of(zip_uint64_t index) const {
    const char* name = zip_get_name(zip_.get(), index, 0);
    return name ? name : "";
  }

  Result<void> unpack(zip_uint64_t index) {
    std::string name = name_of(index);
    const bool is_folder = name.ends_with('/');
    if (is_folder) name.pop_back();
    if (!is_safe_path(name)) return refuse(name, "has a path that is not allowed");
    const fs::path place = folder_ / fs::path(name);
    std::error_code error;
    fs::create_directories(is_folder ? place : place.parent_path(), error);
    if (error) return refuse(name, "cannot be written: " + error.message());
    if (is_folder) return {};
    if (fs::exists(fs::symlink_status(place, error))) return refuse(name, "appears twice");
    zip_stat_t stat;
    zip_stat_init(&stat);
    zip_stat_index(zip_.get(), index, 0, &stat);
    if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
      return refuse(name, "is encrypted. Make the zip without a password");
    return copy(index, name, place, stat.size);
  }

  Result<void> copy(zip_uint64_t index, const std::string& name, const fs::path& place,
                    std::uint64_t bytes) {
    const std::unique_ptr<zip_file_t, CloseFile> file(zip_fopen_index(zip_.get(), index, 0));
    if (!file) return refuse(name, "is damaged");
    std::ofstream out(place, std::ios::binary);
    for (std::uint64_t left = bytes;;) {
      if (progress_.cancelled()) return cancelled_problem();
      // libzip compares the checksum at the end of the file.
      const zip_int64_t read = zip_fread(file.get(), piece_.data(), piece_.size());
      if (read < 0) return refuse(name, "is damaged");
      if (read == 0 && left > 0) return refuse(name, "is shorter than the zip states");
      if (read == 0) break;
      if (static_cast<std::uint64_t>(read) > left)
        return refuse(name, "is larger than the zip states");
      left -= static_cast<std::uint64_t>(read);
      done_ += static_cast<std::uint64_t>(read);
      out.write(piece_.data(), read);
      progress_.report(static_cast<double>(done_) / static_cast<double>(total_), "Unpacking");
    }
    out.close();
    if (!out)
      return fail(ErrorCode::storage_full, "File not written",
                  "The folder for temporary files is full. Free disk space, or set TMPDIR to a "
                  "larger disk.");
    return {};
  }

  const fs::path& folder_;
  Progress& progress_;
  std::unique_ptr<zip_t, DiscardZip> zip_;
  zip_uint64_t count_ = 0;
  std::uint64_t total_ = 0, done_ = 0;  // bytes
  std::vector<char> piece_ = std::vector<char>(kPiece);
};

}  // namespace

bool is_safe_path(std::string_view path) {
  if (path.empty() || path.size() > kMaxPath || path.front() == '/') return false;
  const auto is_bad = [](char c) {
    return c == '\\' || c == ':' || (c >= 0 && c < ' ') || c == 127;
  };
  if (std::ranges::any_of(path, is_bad)) return false;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    const std::string_view part = path.substr(at, end - at);
    if (part.empty() || part == "." || part == "..") return false;
    at = end + 1;
  }
  return true;
}

Result<void> unzip(const fs::path& zip, const fs::path& folder, const UnzipLimits& limits,
                   Progress& progress) {
  return Unzipper(folder, progress).run(zip, limits);
}

}  // namespace strata
