#include "store/files/file_store.h"

#include "core/text/hex.h"
#include "store/files/folder_files.h"
#include "store/files/s3_files.h"

namespace strata::store {

std::string file_name_of(const Sha256& hash) {
  const std::string hex = to_hex(hash);
  return hex.substr(0, 2) + "/" + hex.substr(2, 2) + "/" + hex;
}

std::optional<Sha256> hash_of_file_name(std::string_view name) {
  constexpr std::size_t kFolders = 6;  // ab/cd/
  Sha256 hash{};
  if (name.size() != kFolders + 2 * hash.size()) return std::nullopt;
  const std::string_view hex = name.substr(kFolders);
  for (std::size_t i = 0; i < hash.size(); ++i) {
    const int high = hex_digit_value(hex[2 * i]), low = hex_digit_value(hex[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    hash[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return file_name_of(hash) == name ? std::optional(hash) : std::nullopt;
}

Result<std::unique_ptr<FileStore>> open_file_store(const FilesPlace& place) {
  if (place.place.starts_with("s3:")) return S3Files::open(place, s3_environment());
  if (!place.endpoint.empty())
    return fail(ErrorCode::malformed, "Not a bucket",
                "An endpoint needs a bucket: --files s3://BUCKET/PREFIX.", "--files-endpoint");
  return FolderFiles::open(place.place);
}

}  // namespace strata::store
