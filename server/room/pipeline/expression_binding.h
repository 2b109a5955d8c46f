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

// Names in a formula that are not layers refer to surface values. `x y z` (world, model units) and
// `area` (of the texel, m²) are always available. Values that need the whole mesh (kShapeNames) are
// only available if they are given as a layer `surface.…`.
inline constexpr std::array kShapeNames{"nx", "ny", "nz", "height", "slope", "curvature"};
inline constexpr std::string_view kShapePrefix = "surface.";

// Returns the kShapeNames that the formula names and that are not names of layers.
std::vector<std::string> shapes_read(const Expression& expression,
                                     const std::vector<query::LayerView>& layers);

// Returns the layers that the role sees.
std::vector<query::LayerView> layers_seen_by(const std::vector<query::LayerView>& layers,
                                             Role role);

// Binds a formula over layers to the records of their keys. Reads the current records, or the
// records at the model's edit `at`, with the columns that `seen_by` sees. Blocks. Returns `invalid`
// for a layer without records, and for a missing column or one of another type. The error has
// `field` and the position in the formula. Suggestions contain only layers in `candidates`, or in
// `layers` if `candidates` is null. All readers of the error must be allowed to see these.
Result<query::BoundExpression> bind_expression(
    const Expression& expression, const std::vector<query::LayerView>& layers, store::Store& store,
    Role seen_by, std::optional<std::int64_t> at, const std::string& field,
    const std::vector<query::LayerView>* candidates = {});

// Like `bind_expression`, for a formula whose result is written into a layer with visibility
// `layer`. The formula may read only data that every user of the layer can see, so the result
// reveals no hidden data. `layers` are all layers of the model. The result contains the layers that
// the formula may read. Also returns an `invalid` error at `field` for data that `author` can see
// but some users of the layer cannot see.
struct BoundForLayer {
  query::BoundExpression expression;
  std::vector<query::LayerView> layers;
};
Result<BoundForLayer> bind_for_layer(const Expression& expression,
                                     const std::vector<query::LayerView>& layers,
                                     store::Store& store, Role author, Visibility layer,
                                     const std::string& field);

}  // namespace strata::room
