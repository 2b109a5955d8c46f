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

// Layers computed by an expression over other layers (Layer::formula). All functions block.

// Parses a number or a condition. Refuses a syntax error (422 at `expression`, with the character).
Result<Expression> parse_formula(const std::string& text);

// Resolves the names in the text on this model: layers, columns of their records, the surface.
// `self`: the computed layer, if it exists; `visibility`: of that layer; everybody who sees it must
// also see its inputs. Refuses (422 at `expression`, with the character) syntax errors and unknown
// names.
Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  Visibility visibility, std::optional<LayerId> self = {});

// Computes the layer's content again, as one edit of the author, and notifies participants.
// `overwrites`: also if people have edited it (409 otherwise). Returns the layer afterwards.
// Computes the normals, height, slope and curvature that the expression reads first, which takes as
// long as making these shape layers.
Result<Layer> compute_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites = false);

// Whether the expression reads the shape of the surface, which takes long to compute.
bool reads_shape(const room::Room& room, const Expression& expression);

// Makes a layer with a formula and computes it. Without a palette, fits one to the values. At first
// only the author sees the layer. After an error the caller calls `layers.take_back()`.
Result<Layer> add_formula_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                                NewLayers& layers, Layer layer, const Author& author,
                                bool has_palette, Progress& progress);

}  // namespace strata::app
