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

// Names that a formula may have of the surface itself, where no layer has them: `x y z` (world,
// model units), `area` (of the texel, m²) everywhere; what needs the whole mesh (kShapeNames) only
// where it is given as a layer `surface.…`.
inline constexpr std::array kShapeNames{"nx", "ny", "nz", "height", "slope", "curvature"};
inline constexpr std::string_view kShapePrefix = "surface.";

// Of kShapeNames, those that the formula reads: it names them, and no layer has that name.
std::vector<std::string> shapes_read(const Expression& expression,
                                     const std::vector<query::LayerView>& layers);

// Those of the layers that the role sees: to it the others are not there.
std::vector<query::LayerView> layers_seen_by(const std::vector<query::LayerView>& layers,
                                             Role role);

// A formula over layers with what it needs of the records behind their keys, read from the
// database: as they are, or as they were when the model's edit `at` was made; of columns that
// `seen_by` sees. Blocks. Refused (invalid at `field`, with the character): a layer without
// records, a column that is not there or holds something else.
Result<query::BoundExpression> bind_expression(const Expression& expression,
                                               const std::vector<query::LayerView>& layers,
                                               store::Store& store, Role seen_by,
                                               std::optional<std::int64_t> at,
                                               const std::string& field);

// The same for what is written into a layer that is seen so: it may read only what everybody sees
// who sees that layer, so that nothing shows through. `layers` are all of the model's, those of the
// answer the ones that it may read. Refused besides (invalid at `field`): what only `author` and
// others like them see.
struct BoundForLayer {
  query::BoundExpression expression;
  std::vector<query::LayerView> layers;
};
Result<BoundForLayer> bind_for_layer(const Expression& expression,
                                     const std::vector<query::LayerView>& layers,
                                     store::Store& store, Role author, Visibility layer,
                                     const std::string& field);

}  // namespace strata::room
