#include "app/deposit/read_bag.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/digest.h"
#include "core/mapped_file.h"
#include "core/text/bytes.h"
#include "core/text/hex.h"
#include "core/text/utf8.h"
#include "core/unzip.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kManifest = "manifest-sha256.txt";
constexpr const char* kTagManifest = "tagmanifest-sha256.txt";
constexpr std::uint64_t kMaxTagFile = std::uint64_t{1} << 30;  // a million files
constexpr std::size_t kPiece = 1u << 20;
constexpr std::size_t kDigits = 64;

tl::unexpected<Error> damaged(const std::string& file, const std::string& why) {
  return fail(ErrorCode::invalid, "Deposit damaged",
              "The file " + mended_utf8(file.substr(0, 500)) + " of the deposit " + why +
                  ". Get the deposit from its repository again.");
}

// Percent signs and line ends are encoded (RFC 8493, section 2.1.3).
std::string decoded(std::string_view path) {
  std::string text;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string_view code = path.substr(i, 3);
    const char c = code == "%25"                    ? '%'
                   : code == "%0A" || code == "%0a" ? '\n'
                   : code == "%0D" || code == "%0d" ? '\r'
                                                    : '\0';
    text += c == '\0' ? path[i] : c;
    if (c != '\0') i += 2;
  }
  return text;
}

// Calls `each` with every line of a text, without its end.
template <class Each>
Result<void> for_each_line(std::string_view text, const Each& each) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.empty()) STRATA_TRY(each(line));
  }
  return {};
}

class BagCheck {
 public:
  BagCheck(const fs::path& bag, Progress& progress) : bag_(bag), progress_(progress) {}

  Result<void> run() {
    STRATA_TRY(check_declaration());
    const auto tags = STRATA_TRY(read_manifest(kTagManifest, ""));
    for (const auto& [path, sum] : tags) STRATA_TRY(check_file(path, sum));
    for (const char* needed : {kManifest, "bag-info.txt", "bagit.txt"})
      if (!tags.contains(needed)) return damaged(needed, "has no checksum");
    const auto payload = STRATA_TRY(read_manifest(kManifest, "data/"));
    STRATA_TRY(check_listed(payload));
    STRATA_TRY(check_oxum(payload.size()));
    for (const auto& [path, sum] : payload) STRATA_TRY(check_file(path, sum));
    return {};
  }

 private:
  using Sums = std::map<std::string, std::string>;  // checksum by path

  Result<MappedFile> open_tag(const std::string& name) {
    const fs::path place = bag_ / name;
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(place, error))) return damaged(name, "is missing");
    if (fs::file_size(place, error) > kMaxTagFile) return damaged(name, "is too large");
    return MappedFile::open(place);
  }

  Result<void> check_declaration() {
    const auto file = STRATA_TRY(open_tag("bagit.txt"));
    if (!file.view().starts_with("BagIt-Version: 1.0") &&
        !file.view().starts_with("BagIt-Version: 0.97"))
      return fail(ErrorCode::invalid, "Unknown version of BagIt",
                  "This program reads bags of the versions 0.97 and 1.0. Choose a deposit that "
                  "Strata has made.");
    return {};
  }

  Result<Sums> read_manifest(const char* name, std::string_view folder) {
    const auto file = STRATA_TRY(open_tag(name));
    Sums sums;
    STRATA_TRY(for_each_line(file.view(), [&](std::string_view line) -> Result<void> {
      const auto path_at = line.find_first_not_of(" \t*", std::min(kDigits, line.size()));
      if (line.size() <= kDigits || path_at == std::string_view::npos || path_at == kDigits)
        return damaged(name, "has a line of another form");
      std::string path = decoded(line.substr(path_at));
      if (!is_safe_path(path) || !path.starts_with(folder))
        return damaged(path, "has a path that is not allowed");
      std::string sum(line.substr(0, kDigits));
      std::ranges::transform(sum, sum.begin(), [](char c) {
        return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
      });
      if (!sums.emplace(path, std::move(sum)).second)
        return damaged(path, "appears twice in " + std::string(name));
      return {};
    }));
    return sums;
  }

  // Checks that the payload has exactly the files of the manifest.
  Result<void> check_listed(const Sums& payload) {
    for (const auto& [path, sum] : payload) {
      std::error_code error;
      if (!fs::is_regular_file(fs::symlink_status(bag_ / path, error)))
        return damaged(path, "is missing");
    }
    std::error_code error;
    for (auto it = fs::recursive_directory_iterator(bag_ / "data", error);
         !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
      const std::string path = fs::relative(it->path(), bag_).generic_string();
      const auto status = it->symlink_status();
      if (fs::is_directory(status)) continue;
      if (!fs::is_regular_file(status)) return damaged(path, "is not a plain file");
      if (!payload.contains(path)) return damaged(path, "is not in the manifest");
      bytes_ += it->file_size(error);
    }
    return error ? Result<void>(damaged("data", "is not readable")) : Result<void>();
  }

  Result<void> check_oxum(std::size_t files) {
    const auto info = STRATA_TRY(open_tag("bag-info.txt"));
    const std::string expected = std::to_string(bytes_) + "." + std::to_string(files);
    return for_each_line(info.view(), [&](std::string_view line) -> Result<void> {
      constexpr std::string_view kOxum = "Payload-Oxum: ";
      if (line.starts_with(kOxum) && line.substr(kOxum.size()) != expected)
        return damaged("bag-info.txt", "states another size of the files than " + expected);
      return {};
    });
  }

  Result<void> check_file(const std::string& path, const std::string& sum) {
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(bag_ / path, error)))
      return damaged(path, "is missing");
    const auto file = STRATA_TRY(MappedFile::open(bag_ / path));
    Sha256Stream hash;
    for (std::size_t at = 0; at < file.view().size(); at += kPiece) {
      if (progress_.cancelled()) return cancelled_problem();
      const std::string_view piece = file.view().substr(at, kPiece);
      hash.add(bytes_of(piece));
      file.release(piece);
      checked_ += piece.size();
      progress_.report(static_cast<double>(checked_) / static_cast<double>(bytes_ + 1),
                       "Checking the files");
    }
    if (to_hex(hash.finish()) != sum) return damaged(path, "has another checksum than expected");
    return {};
  }

  const fs::path& bag_;
  Progress& progress_;
  std::uint64_t bytes_ = 0, checked_ = 0;
};

}  // namespace

Result<void> check_bag(const fs::path& bag, Progress& progress) {
  return BagCheck(bag, progress).run();
}

Result<fs::path> unpack_bag(const fs::path& zip, const fs::path& folder, Progress& progress) {
  std::error_code error;
  const auto space = fs::space(folder, error);
  STRATA_TRY(unzip(zip, folder, {.bytes = error ? 0 : space.available}, progress));
  std::optional<fs::path> bag;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (bag || !entry.is_directory(error))
      return fail(ErrorCode::invalid, "Not a deposit",
                  "The zip must contain one folder with the files of a bag. Choose the zip of a "
                  "deposit.");
    bag = entry.path();
  }
  if (!bag) return fail(ErrorCode::invalid, "Not a deposit", "The zip is empty.");
  return *bag;
}

}  // namespace strata::app
