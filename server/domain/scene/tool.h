#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/ids.h"

namespace strata {

// A brush shape of the site (media/shape_texture.h). Its shape never changes, so that stroke
// records stay valid permanently; a deleted tool is not listed or found by its slug, but its id
// still selects its shape.
struct Tool {
  ToolId id = 0;
  std::string name;
  // unique among existing tools; neither all digits nor `disc` nor `square`
  std::string slug;
  bool deleted = false;
  std::int64_t version = 1;
};

nlohmann::json to_json(const Tool& tool);

}  // namespace strata
