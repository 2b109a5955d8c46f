#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/ids.h"

namespace strata {

// A brush shape of the site (media/shape_texture.h). The shape never changes, so records of strokes
// stay valid. A deleted tool is not listed and cannot be found by its slug, but its id still
// selects its shape.
struct Tool {
  ToolId id = 0;
  std::string name;
  // Unique among the tools that are not deleted. Must not consist only of digits, and must not
  // be `disc` or `square`.
  std::string slug;
  bool deleted = false;
  std::int64_t version = 1;
};

nlohmann::json to_json(const Tool& tool);

}  // namespace strata
