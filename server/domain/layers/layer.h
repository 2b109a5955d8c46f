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

// The formula of a computed layer. The server computes the texels of such a layer.
struct LayerFormula {
  // A number or a condition over layers of the model (expression/expression_parser).
  std::string expression;
  // Compute the layer again soon after an input has changed.
  bool automatic = false;
  // The model's sequence at the last computation with its present unit and up. 0 without one.
  std::int64_t computed_sequence = 0;
  bool records_changed = false;  // records of an input table have changed since then
  struct Input {
    std::string slug;              // slug of the layer in the expression
    std::optional<LayerId> layer;  // nullopt if the layer was deleted
    std::optional<TableId> table;  // the table with the records that the expression reads
    bool operator==(const Input&) const = default;
  };
  std::vector<Input> inputs;  // by slug
  bool stale = true;          // the values are out of date, according to this copy of the metadata
};

// The analysis that computed a layer, as one of its steps (app/layers/analysis.h).
struct LayerAnalysis {
  std::string name;
  int step = 0;  // from 1
  int of = 0;    // number of steps
  JobId job = 0;
  bool operator==(const LayerAnalysis&) const = default;
};

// The origin of values that were computed and not painted.
enum class LayerOrigin { expression, shape };

struct Layer {
  LayerId id = 0;
  ModelId model_id = 0;
  std::string name;
  std::string slug;  // unique in the model, never all digits
  LayerKind kind = LayerKind::numeric;
  ValueType type = ValueType::u8;
  int resolution = 2048;  // texels per side: a power of two from atlas.lowest_resolution to 16384
  std::string unit;
  std::string description;
  Labels labels;        // the name in other languages
  Labels descriptions;  // the description in other languages
  // The heading in the list of layers, the same for all users. Without leading and trailing blanks.
  std::optional<std::string> group;
  Palette palette;
  // True if the palette is not stored, but follows the colors of the terms of the table.
  bool palette_of_terms = false;
  double opacity = 1;
  LayerBlend blend = LayerBlend::normal;
  bool visible = true;
  // Users below curator can change neither the texels nor the metadata.
  bool locked = false;
  // Edits of users below curator are provisional until a curator accepts or rejects them.
  bool review = false;
  Visibility visibility = Visibility::everyone;
  int order = 0;  // drawn in ascending order: the layer with the highest number is on top
  // For database layers: the table of the project whose keys the texels hold.
  std::optional<TableId> table;
  std::optional<LayerFormula> formula;
  std::optional<LayerOrigin> origin;
  std::optional<LayerAnalysis> analysis;  // only of a layer with an origin
  // Set when a layer with an origin is unlocked. Its values may then differ from the computed
  // values.
  bool edited_by_hand = false;
  std::int64_t sequence = 0;  // of the last edit of the layer
  std::int64_t version = 1;   // of the metadata, for ETag and If-Match
};

// Returns whether the values are the computed ones. They cannot change until the layer is unlocked.
inline bool is_as_computed(const Layer& layer) {
  return layer.origin && layer.locked && !layer.edited_by_hand;
}

nlohmann::json to_json(const LayerAnalysis& analysis);
nlohmann::json to_json(const Layer& layer);

}  // namespace strata
