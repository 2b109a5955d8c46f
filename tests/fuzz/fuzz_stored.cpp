// Fuzzes files that the server has written to disks and buckets, and the replies of S3 servers:
// lists of a bucket, the mark of the files, names of the write-ahead log, labels of copies,
// manifests of backups, and addresses of buckets.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/progress.h"
#include "store/cluster/archive_wal.h"
#include "store/cluster/backup.h"
#include "store/files/files_mark.h"
#include "store/files/s3_files.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

void read_bucket(std::string_view text) {
  constexpr std::string_view kPrefix = "site/";
  if (const auto page = store::read_s3_page(text, kPrefix))
    demand(page->is_last || !page->last_key.empty());
  const store::S3Environment environment{"key", "secret", "", "", "", ""};
  const auto half = text.size() / 2;
  const store::FilesPlace place{"s3://" + std::string(text.substr(0, half)),
                                std::string(text.substr(half))};
  if (const auto there = store::s3_place(place, environment))
    demand(there->bucket.url.starts_with("http") &&
           (there->prefix.empty() || there->prefix.ends_with('/')));
}

void read_names(std::string_view text) {
  if (const auto mark = store::parse_files_mark(std::string(text))) {
    const auto again = store::parse_files_mark(store::to_text(*mark));
    demand(again && again->id == mark->id && again->owner == mark->owner);
  }
  if (const auto segment = store::parse_wal_name(text))
    demand(store::parse_wal_name(store::wal_name(*segment)) == segment);
  if (const auto segment = store::first_segment_of(text)) {
    demand(store::parse_wal_name(store::wal_name(*segment)) == segment);
    (void)store::wal_can_go(text, *segment);
  }
}

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("strata-fuzz-stored-" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

// There is no dump, so no manifest belongs to a complete backup.
void read_manifest(std::string_view text) {
  static const Folder folder;
  std::ofstream(folder.path / "manifest.json", std::ios::binary) << text;
  Progress progress;
  demand(!store::check_backup(folder.path, progress).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_bucket(text);
  read_names(text);
  read_manifest(text);
  return 0;
}
