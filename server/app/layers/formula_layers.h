#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/layers/new_layers.h"
#include "app/services.h"
#include "core/ids.h"
#include "core/progress.h"
#include "expression/expression.h"
#include "room/room.h"

namespace strata::query {
struct Statistics;
}

namespace strata::app {

// Layers that are computed by an expression over other layers (Layer::formula). All functions
// block.

// Parses a numeric expression or a condition. Refuses a syntax error (422 at `expression`, with the
// position of the character).
Result<Expression> parse_formula(const std::string& text);

// Returns a palette for most of the values of a computed layer, which have quantiles. Returns
// nothing if the layer keeps its palette, or if all values are equal.
std::optional<Palette> palette_of_values(const Layer& layer, const query::Statistics& values);

// Finds the layers, the columns of their records and the properties of the surface that the text
// names on this model. `computed` is the computed layer, with its visibility and its resolution. It
// has no id if it does not exist yet. Users who can see the layer must also be allowed to see its
// inputs. The text can also name `planned` layers, which do not exist yet. They are no inputs of
// the returned formula. Refuses syntax errors, unknown names, and a radius, width or range that the
// job would refuse at this resolution (422 at `expression`, with the position of the character).
Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  const Layer& computed, const std::vector<Layer>& planned = {});

// Computes the content of the layer again, as one edit of the author, and notifies participants.
// Without `overwrites`, refuses a layer that users have edited (409). Returns the layer after the
// edit. First computes the normals, height, slope and curvature that the expression reads, which
// takes as long as creating the corresponding shape layers, and the functions along the surface.
// These may read an earlier state than the rest of the expression. If a layer was edited in
// between, the result is stale. Throws QuestionEnded if the current Question ends, and then changes
// nothing.
Result<Layer> compute_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites = false);

// Returns whether the expression reads the shape of the surface or has functions along the surface,
// which take a long time to compute.
bool reads_shape(const room::Room& room, const Expression& expression);

// Creates a layer with a formula and computes it. If the layer has no palette, fits a palette to
// the values. At first, only the author can see the layer. After an error, the caller must call
// `layers.take_back()`.
Result<Layer> add_formula_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                                NewLayers& layers, Layer layer, const Author& author,
                                bool has_palette, Progress& progress);

}  // namespace strata::app
