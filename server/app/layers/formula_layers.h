#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/layers/new_layers.h"
#include "app/services.h"
#include "core/ids.h"
#include "core/progress.h"
#include "expression/expression.h"
#include "room/room.h"

namespace strata::app {

// Layers that are computed by an expression over others (Layer::formula). All of it blocks.

// A number or a condition. Refused (422 at `expression`, with the character): what cannot be read.
Result<Expression> parse_formula(const std::string& text);

// What the text reads on this model: names of layers, columns of their records, the surface.
// `self`: the layer that it is for, where there is one; `visibility`: of that layer, whoever sees
// which must see all that it reads. Refused (422 at `expression`, with the character): what cannot
// be read, or names nothing.
Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  Visibility visibility, std::optional<LayerId> self = {});

// Computes the layer's content anew, as one edit of the author, and tells who looks. `overwrites`:
// also where it was edited by hand since (409 without). Returns it as it is then. The normals, the
// height, the slope and the curvature that an expression reads are worked out first, which takes as
// long as their layers do.
Result<Layer> compute_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites = false);

// Whether the expression reads the shape of the surface, which takes long to compute.
bool reads_shape(const room::Room& room, const Expression& expression);

// Makes a layer with a formula and computes it. Without a palette of its own its colours run over
// the values it has. Only the author sees it at first. After an error the caller takes `layers`
// back.
Result<Layer> add_formula_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                                NewLayers& layers, Layer layer, const Author& author,
                                bool has_palette, Progress& progress);

}  // namespace strata::app
