#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/scene/surface_image.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Blobs;
class Pool;

// Images of the surface of a model, stored unchanged. Part of Store, whose rules for threads and
// errors apply.
class SurfaceImages {
 public:
  SurfaceImages(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  static constexpr int kMaxSurfaceImages = 32;  // per model

  Result<std::vector<SurfaceImage>> of_model(ModelId model_id);  // sorted by their order
  Result<SurfaceImage> find(ModelId model_id, const std::string& ref);
  Result<SurfaceImage> create(const SurfaceImage& image, std::span<const std::uint8_t> picture,
                              const IdempotentResponse<SurfaceImage>& answer = {});
  // Changes the properties, but not the image file.
  Result<SurfaceImage> update(const SurfaceImage& image,
                              const IdempotentResponse<SurfaceImage>& answer = {});
  Result<void> remove(SurfaceImageId id, const IdempotentResponse<>& answer = {});
  Result<std::vector<std::uint8_t>> picture(SurfaceImageId id);

 private:
  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
