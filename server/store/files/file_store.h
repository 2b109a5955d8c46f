#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "store/files/content.h"
#include "store/files/files_place.h"

namespace strata::store {

struct StoredFile {
  Sha256 hash{};
  std::uint64_t bytes = 0;
  std::chrono::system_clock::time_point changed;
};

// Content by its SHA-256, in a folder or a bucket. The names are the same in both, so either can be
// copied to the other: `ab/cd/` and the hash in hexadecimal digits. Thread-safe. A call to an S3
// server ends after a limited time, and one to a folder when its disk responds. If the disk or the
// server does not respond, the error is `unavailable`, and if it has no space, `storage_full`.
class FileStore {
 public:
  virtual ~FileStore() = default;
  virtual std::string place() const = 0;        // for people, without secrets
  virtual std::uint64_t max_bytes() const = 0;  // of one content
  // Stores the content durably, also if it is already there. Other readers and writers see either
  // nothing, or the whole content.
  virtual Result<void> put(const Content& content, const std::function<bool()>& cancelled) = 0;
  // Returns the bytes from `begin`, fewer than `size` at the end of the file. Returns `not_found`
  // if there is no such file. Does not check the hash.
  virtual Result<std::vector<std::uint8_t>> read(const Sha256& hash, std::uint64_t begin,
                                                 std::size_t size) = 0;
  // Deletes the file if it exists. Returns whether it existed.
  virtual Result<bool> remove(const Sha256& hash) = 0;
  // Calls `visit` for all files, in any order, until it returns an error.
  virtual Result<void> list(const std::function<Result<void>(const StoredFile&)>& visit) = 0;
  // Removes the files of incomplete uploads that ended more than `age` ago, for example because a
  // process was killed.
  virtual Result<void> remove_unfinished(std::chrono::seconds age) = 0;
  // Returns the mark, a small file that identifies the store, or nothing if it does not exist. A
  // folder without a mark stores and returns no content, because its disk may not be mounted.
  virtual Result<std::optional<std::string>> read_mark() = 0;
  virtual Result<void> write_mark(const std::string& text) = 0;
};

inline constexpr const char* kFilesMark = "strata-files.json";

// Checks the place, but not its content. A folder is created if its parent exists.
Result<std::unique_ptr<FileStore>> open_file_store(const FilesPlace& place);

// The first function returns `ab/cd/` and the hash, the second one the hash of such a name.
std::string file_name_of(const Sha256& hash);
std::optional<Sha256> hash_of_file_name(std::string_view name);

}  // namespace strata::store
