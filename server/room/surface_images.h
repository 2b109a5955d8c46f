#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/scene/surface_image.h"
#include "store/content/idempotent_response.h"

namespace strata::room {

// The surface images of an open model. Functions that change an image wait for the database and
// notify the listeners. Thread-safe.
class SurfaceImages {
 public:
  virtual ~SurfaceImages() = default;
  virtual std::vector<SurfaceImage> all() const = 0;                    // by order
  virtual Result<SurfaceImage> find(const std::string& ref) const = 0;  // id or slug
  virtual Result<SurfaceImage> create(
      SurfaceImage image, std::span<const std::uint8_t> picture,
      const store::IdempotentResponse<SurfaceImage>& answer = {}) = 0;
  virtual Result<SurfaceImage> update(
      const SurfaceImage& image, const store::IdempotentResponse<SurfaceImage>& answer = {}) = 0;
  virtual Result<void> erase(SurfaceImageId id, const store::IdempotentResponse<>& answer = {}) = 0;
};

}  // namespace strata::room
