#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/ids.h"

namespace strata {

// A shape for the brush, of the whole site (media/shape_texture.h). Its shape never changes, so
// that a stroke's record means the same for ever; a deleted tool is no longer listed or found by
// its slug, but its id still names its shape.
struct Tool {
  ToolId id = 0;
  std::string name;
  // unique among those that are not deleted; neither all digits nor `disc` nor `square`
  std::string slug;
  bool deleted = false;
  std::int64_t version = 1;
};

nlohmann::json to_json(const Tool& tool);

}  // namespace strata
