#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/palette.h"

namespace strata {

enum class LayerKind { numeric, database };

struct Layer {
  std::int64_t id = 0;
  std::int64_t model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  LayerKind kind = LayerKind::numeric;
  ValueType type = ValueType::u8;
  int resolution = 2048;  // texels a side: a power of two, atlas.lowest_resolution…16384
  std::string unit;
  std::string description;
  Palette palette;
  double opacity = 1;
  bool visible = true;
  int order = 0;                      // drawn ascending: higher is on top
  std::optional<std::int64_t> table;  // database: the project's table whose keys the texels hold
  std::int64_t sequence = 0;          // of the last edit in it
  std::int64_t version = 1;           // of the metadata, for ETag and If-Match
};

nlohmann::json to_json(const Layer& layer);

}  // namespace strata
