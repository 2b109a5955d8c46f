#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Blobs;
class Pool;

using TourFileId = Id<struct TourFileTag>;

// A file of a tour: an image, sound, video or subtitles. Its content never changes.
struct TourFile {
  TourFileId id = 0;
  NamedPartId tour_id = 0;
  std::string name;        // a file name without folders
  std::string media_type;  // determined from its bytes
  std::uint64_t bytes = 0;
  std::string sha256;                // hexadecimal
  std::optional<int> width, height;  // for images: size in pixels
};

struct NewTourFile {
  std::string name;
  std::filesystem::path file;
  std::string media_type;
  std::optional<int> width, height;
};

// Files of tours. Part of Store, whose rules for threads and errors apply.
class TourFiles {
 public:
  static constexpr std::int64_t kMaxFiles = 200;                    // per tour
  static constexpr std::int64_t kMaxBytes = std::int64_t{2} << 30;  // per tour

  TourFiles(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  // Returns a `conflict` error for too many files or bytes.
  Result<TourFile> add(NamedPartId tour_id, const NewTourFile& file, const std::string& user,
                       const IdempotentResponse<TourFile>& answer = {});
  Result<std::vector<TourFile>> of_tour(NamedPartId tour_id);  // sorted by id
  Result<TourFile> find(NamedPartId tour_id, TourFileId id);
  // Deletes the files of the tour that are not in `used` and are older than `age`. An open editor
  // may still use a newer file.
  Result<void> drop_unused(NamedPartId tour_id, const std::set<TourFileId>& used,
                           std::chrono::seconds age);

 private:
  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
