#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/layers/layer_blend.h"
#include "domain/layers/palette.h"
#include "domain/people/visibility.h"
#include "domain/tables/labels.h"

namespace strata {

enum class LayerKind { numeric, database };

// The formula of a computed layer. Only computations write its texels.
struct LayerFormula {
  // a number or a condition over layers of the model (expression/expression_parser)
  std::string expression;
  // computed again soon after an input has changed
  bool automatic = false;
  std::int64_t computed_sequence = 0;  // of the model, at the last computation; 0: never
  bool records_changed = false;        // records of an input table changed since then
  struct Input {
    std::string slug;              // the layer's name in the expression
    std::optional<LayerId> layer;  // nothing: it was deleted
    std::optional<TableId> table;  // the table that the expression reads by the layer's keys
    bool operator==(const Input&) const = default;
  };
  std::vector<Input> inputs;  // by slug
  bool stale = true;          // as far as known here
};

// The origin of a layer's values that nobody painted.
enum class LayerOrigin { expression, shape };

struct Layer {
  LayerId id = 0;
  ModelId model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  LayerKind kind = LayerKind::numeric;
  ValueType type = ValueType::u8;
  int resolution = 2048;  // texels per side: a power of two, atlas.lowest_resolution…16384
  std::string unit;
  std::string description;
  Labels labels;        // its name in other languages
  Labels descriptions;  // its description in other languages
  // heading in the list of layers, for all users; without blanks at its ends
  std::optional<std::string> group;
  Palette palette;
  // follows the colors of its table's terms, and is not stored
  bool palette_of_terms = false;
  double opacity = 1;
  LayerBlend blend = LayerBlend::normal;
  bool visible = true;
  // users below curator can change neither its texels nor its metadata
  bool locked = false;
  // edits of users below curator are provisional until a curator accepts or rejects them
  bool review = false;
  Visibility visibility = Visibility::everyone;
  int order = 0;                 // drawn ascending: higher is on top
  std::optional<TableId> table;  // database: the project's table whose keys the texels hold
  std::optional<LayerFormula> formula;
  std::optional<LayerOrigin> origin;
  // with an origin: it was unlocked since then, so its values may differ from the computed ones
  bool edited_by_hand = false;
  std::int64_t sequence = 0;  // of its last edit
  std::int64_t version = 1;   // of the metadata, for ETag and If-Match
};

// Its values are the computed ones, and nobody can change them until the layer is unlocked.
inline bool is_as_computed(const Layer& layer) {
  return layer.origin && layer.locked && !layer.edited_by_hand;
}

nlohmann::json to_json(const Layer& layer);

}  // namespace strata
