#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "domain/people/visibility.h"
#include "domain/tables/labels.h"

namespace strata {

enum class LayerKind { numeric, database };

// What a computed layer is made of. Its texels are written by computing alone.
struct LayerFormula {
  // a number or a condition over layers of the model (expression/expression_parser)
  std::string expression;
  // computed again soon after something that it reads has changed
  bool automatic = false;
  std::int64_t computed_sequence = 0;  // of the model, when it was computed last; 0: never
  bool records_changed = false;        // of a table that it reads, since then
  struct Input {
    std::string slug;              // as the expression names the layer
    std::optional<LayerId> layer;  // nothing: it was deleted
    std::optional<TableId> table;  // whose records it reads by the layer's keys
    bool operator==(const Input&) const = default;
  };
  std::vector<Input> inputs;  // by slug
  bool stale = true;          // as far as it is known here
};

// What computed a layer's values, where nobody painted them.
enum class LayerOrigin { expression, shape };

struct Layer {
  LayerId id = 0;
  ModelId model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  LayerKind kind = LayerKind::numeric;
  ValueType type = ValueType::u8;
  int resolution = 2048;  // texels a side: a power of two, atlas.lowest_resolution…16384
  std::string unit;
  std::string description;
  Labels labels;        // its name in other languages
  Labels descriptions;  // its description in other languages
  Palette palette;
  // it follows the colours of the terms of its table, and is not kept
  bool palette_of_terms = false;
  double opacity = 1;
  bool visible = true;
  // against everybody below curator: neither its texels nor what it is may be changed
  bool locked = false;
  // edits of those below curator are provisional until a curator accepts or rejects them
  bool review = false;
  Visibility visibility = Visibility::everyone;
  int order = 0;                 // drawn ascending: higher is on top
  std::optional<TableId> table;  // database: the project's table whose keys the texels hold
  std::optional<LayerFormula> formula;
  std::optional<LayerOrigin> origin;
  // with an origin: it was unlocked since, so that its values need not be those that were computed
  bool edited_by_hand = false;
  std::int64_t sequence = 0;  // of the last edit in it
  std::int64_t version = 1;   // of the metadata, for ETag and If-Match
};

// Its values are what was computed, and nobody may change them until it is unlocked to be edited by
// hand.
inline bool is_as_computed(const Layer& layer) {
  return layer.origin && layer.locked && !layer.edited_by_hand;
}

nlohmann::json to_json(const Layer& layer);

}  // namespace strata
