#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace strata::app {

// Writes bags (RFC 8493, BagIt 1.0) with checksums of SHA-256 as zip files.

// A file of the payload.
struct BagFile {
  std::string path;  // in the payload, with `/` between folders
  std::string sha256;
  std::uint64_t bytes = 0;
  std::string media_type;
  std::string description;  // for people
  std::string license;      // address; empty: that of the whole deposit
};

class Bag {
 public:
  // Passes the content with this hash to the sink in pieces. The sink returns false to stop.
  using ReadStored =
      std::function<Result<void>(const std::string& sha256, std::uint64_t begin, std::uint64_t end,
                                 const std::function<bool(std::span<const std::uint8_t>)>& sink)>;

  // Keeps the files that are made for the bag in `folder`, which must exist and outlive the bag.
  Bag(std::filesystem::path folder, ReadStored read_stored)
      : folder_(std::move(folder)), read_stored_(std::move(read_stored)) {}

  // Returns the path with a number before the extension if the payload already has the path, in any
  // case of the letters. The next `add` must use the result.
  std::string free_path(const std::string& path) const;
  // Returns the place where the caller writes the next file that `add_made` adds.
  std::filesystem::path next_file() const;

  // Add a file that the caller has written to next_file(), a short text, bytes, and a content of
  // the store, which is read when the bag is written. `file` has the path, and its description.
  Result<void> add_made(BagFile file);
  Result<void> add(BagFile file, std::string_view text);
  Result<void> add(BagFile file, std::span<const std::uint8_t> bytes);
  void add_stored(BagFile file);  // with hash and size

  const std::vector<BagFile>& files() const { return files_; }
  std::uint64_t bytes() const;

  // Writes the zip, in which the bag is the folder `name`. `info` are the lines of bag-info.txt
  // without those about the size. Returns the size of the zip, `storage_full`, `cancelled`, or the
  // error of the store. Blocks.
  Result<std::uint64_t> write(const std::string& name,
                              const std::vector<std::pair<std::string, std::string>>& info,
                              const std::filesystem::path& zip, Progress& progress) const;

 private:
  void keep(BagFile file, std::optional<std::filesystem::path> made);

  const std::filesystem::path folder_;
  const ReadStored read_stored_;
  std::vector<BagFile> files_;
  // The file of each entry of files_, or nothing for a content of the store.
  std::vector<std::optional<std::filesystem::path>> made_;
  std::set<std::string> taken_;  // paths in lower case
};

// Returns a name that all operating systems can use as the name of a file: `fallback` if nothing
// remains.
std::string portable_name(const std::string& name, const std::string& fallback);

}  // namespace strata::app
