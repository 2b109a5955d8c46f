#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "media/photographs/posed_photographs.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Blobs;
class Pool;

using PhotographId = Id<struct PhotographTag>;

// The image of a photograph, as the user sent it.
struct Original {
  std::string media_type;  // "image/jpeg", "image/png" or "image/tiff"
  std::uint64_t bytes = 0;
  std::string sha256;  // hexadecimal
  int width = 0, height = 0;
};

struct NewOriginal {
  std::filesystem::path file;
  std::string media_type;
  int width = 0, height = 0;
};

// A photograph of a model. `posed.name` is unique in the model.
struct Photograph {
  PhotographId id = 0;
  ModelId model_id = 0;
  photo::PosedPhotograph posed;  // in world coordinates of the model
  std::optional<Original> original;
  std::string rights_uri, rights_holder;  // empty: those of the model
  std::int64_t version = 1;
};

// The effect of adding photographs to those of a model.
struct MergedPhotographs {
  std::int64_t added = 0, updated = 0;
  std::int64_t total = 0;  // of the model
  std::vector<photo::RefusedPhotograph> refused;
};

// Photographs of models, with the poses of their cameras. Part of Store, whose rules for threads
// and errors apply.
class Photographs {
 public:
  static constexpr std::int64_t kMaxPhotographs = 20'000;  // per model

  Photographs(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  // Adds photographs without images, and replaces the pose and calibration of those with the same
  // name. Refuses a photograph whose name appears earlier in the list, or whose image does not have
  // the size of the new calibration. Returns a `conflict` error for too many photographs.
  Result<MergedPhotographs> merge(ModelId model_id,
                                  std::span<const photo::PosedPhotograph> photographs,
                                  const IdempotentResponse<MergedPhotographs>& answer = {});

  struct PageRequest {
    int limit = 0, offset = 0;
    std::string after{};                  // a name
    std::string text{};                   // a part of the name, without regard to case
    std::optional<bool> with_original{};  // only photographs that have an image, or have none
  };
  struct Page {
    std::vector<Photograph> photographs;        // sorted by the bytes of their names
    std::int64_t total = 0, with_original = 0;  // of the requested photographs, on all pages
  };
  Result<Page> page(ModelId model_id, const PageRequest& request);
  Result<std::vector<Photograph>> of_model(ModelId model_id);  // sorted in the same way
  // The ids and names alone, for the match of an image file with up to 20 000 names.
  Result<std::vector<std::pair<PhotographId, std::string>>> names(ModelId model_id);
  Result<Photograph> find(ModelId model_id, PhotographId id);

  // Replaces the image, and deletes the content of the former one if nothing else uses it. Returns
  // an `invalid` error if the calibration is for a photograph with other sides, and a `conflict`
  // error if the site has a node whose program does not know photographs.
  Result<Photograph> set_original(ModelId model_id, PhotographId id, const NewOriginal& original,
                                  const IdempotentResponse<Photograph>& answer = {});

  // Sets the license and the rights holder of the photographs with these ids, or of all photographs
  // of the model if `ids` is empty. Returns the number of changed photographs.
  Result<std::int64_t> set_rights(ModelId model_id, std::span<const PhotographId> ids,
                                  const std::string& rights_uri, const std::string& rights_holder,
                                  const IdempotentResponse<std::int64_t>& answer = {});

  Result<void> remove(ModelId model_id, PhotographId id, const IdempotentResponse<>& answer = {});
  Result<void> remove_all(ModelId model_id, const IdempotentResponse<>& answer = {});

 private:
  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
