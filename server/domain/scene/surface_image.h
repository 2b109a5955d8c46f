#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/ids.h"

namespace strata {

// A picture on the surface, in texture coordinates (uv origin bottom left: the picture's top row is
// v = 1).
struct SurfaceImage {
  SurfaceImageId id = 0;
  ModelId model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  std::string description;
  std::string media_type;  // "image/jpeg" or "image/png"
  int width = 0, height = 0;
  std::uint64_t bytes = 0;  // of the encoded picture
  std::string sha256;       // of the encoded picture, lower-case hex
  double opacity = 1;
  bool visible = true;
  int order = 0;  // blended ascending: higher is on top
  std::int64_t version = 1;
};

nlohmann::json to_json(const SurfaceImage& image);

}  // namespace strata
