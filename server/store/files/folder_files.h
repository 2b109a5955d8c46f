#pragma once

#include <filesystem>

#include "store/files/file_store.h"

namespace strata::store {

// Content in a folder, on a disk of this machine or of the network. A file is written to the folder
// `unfinished` and synced, and then renamed.
class FolderFiles : public FileStore {
 public:
  static Result<std::unique_ptr<FileStore>> open(const std::filesystem::path& folder);

  std::string place() const override { return folder_.string(); }
  std::uint64_t max_bytes() const override { return std::uint64_t{1} << 62; }
  Result<void> put(const Content& content, const std::function<bool()>& cancelled) override;
  Result<std::vector<std::uint8_t>> read(const Sha256& hash, std::uint64_t begin,
                                         std::size_t size) override;
  Result<bool> remove(const Sha256& hash) override;
  Result<void> list(const std::function<Result<void>(const StoredFile&)>& visit) override;
  Result<void> remove_unfinished(std::chrono::seconds age) override;
  Result<std::optional<std::string>> read_mark() override;
  Result<void> write_mark(const std::string& text) override;

 private:
  using Write = std::function<Result<void>(const std::function<Result<void>(Bytes)>& sink)>;
  explicit FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path path_of(const Sha256& hash) const { return folder_ / file_name_of(hash); }
  Result<void> check_folder() const;
  // Returns a `conflict` error if the folder contains files that Strata has not made.
  Result<void> check_is_new() const;
  Result<void> check_user(int descriptor) const;  // of a new file
  Result<void> write_file(const std::filesystem::path& file, const Write& write);

  const std::filesystem::path folder_;  // absolute
};

}  // namespace strata::store
