#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/ids.h"

namespace strata {

// An image on the surface, in texture coordinates. The uv origin is at the bottom left, and the top
// row of the image is at v = 1.
struct SurfaceImage {
  SurfaceImageId id = 0;
  ModelId model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  std::string description;
  std::string media_type;  // "image/jpeg" or "image/png"
  int width = 0, height = 0;
  std::uint64_t bytes = 0;  // size of the encoded image
  std::string sha256;       // of the encoded image, in lowercase hex
  double opacity = 1;
  bool visible = true;
  int order = 0;  // blended in ascending order: the image with the highest number is on top
  std::int64_t version = 1;
};

nlohmann::json to_json(const SurfaceImage& image);

}  // namespace strata
