#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "expression/expression.h"
#include "query/conditions/expression_evaluator.h"
#include "store/store.h"

namespace strata::room {

// Names of surface values in a formula, for names that are not layers: `x y z` (world, model units)
// and `area` (of the texel, m²) everywhere; values that need the whole mesh (kShapeNames) only if
// they are given as a layer `surface.…`.
inline constexpr std::array kShapeNames{"nx", "ny", "nz", "height", "slope", "curvature"};
inline constexpr std::string_view kShapePrefix = "surface.";

// Returns those of kShapeNames that the formula reads: it names them, and no layer has that name.
std::vector<std::string> shapes_read(const Expression& expression,
                                     const std::vector<query::LayerView>& layers);

// Returns the layers that the role sees; the others do not exist for it.
std::vector<query::LayerView> layers_seen_by(const std::vector<query::LayerView>& layers,
                                             Role role);

// Binds a formula over layers to the records behind their keys, read from the database: the present
// records, or those at the time of the model's edit `at`, with the columns that `seen_by` sees.
// Blocks. Refused (invalid at `field`, with the character): a layer without records, a column that
// does not exist or has another kind. Suggestions name only layers of `candidates` (null:
// `layers`), which every reader of the error may see.
Result<query::BoundExpression> bind_expression(
    const Expression& expression, const std::vector<query::LayerView>& layers, store::Store& store,
    Role seen_by, std::optional<std::int64_t> at, const std::string& field,
    const std::vector<query::LayerView>* candidates = {});

// The same for a formula whose result is written into a layer with that visibility: it may read
// only data that is visible to every user who sees the layer, so that no hidden data shows through.
// `layers` are all layers of the model; the result contains those that the formula may read. Also
// refused (invalid at `field`): data that only `author` and similar roles see.
struct BoundForLayer {
  query::BoundExpression expression;
  std::vector<query::LayerView> layers;
};
Result<BoundForLayer> bind_for_layer(const Expression& expression,
                                     const std::vector<query::LayerView>& layers,
                                     store::Store& store, Role author, Visibility layer,
                                     const std::string& field);

}  // namespace strata::room
