#pragma once

#include "app/figures/figures.h"
#include "query/sampling/seen_layers.h"

namespace strata::app {

// Returns the legends of the layers in a drawing, topmost first. A legend contains only classes
// that the drawing shows. Leaves out layers that opaque layers cover completely, content outside
// the drawing, and areas smaller than a dot of the drawing. Blocks.
Result<std::vector<figure::Legend>> legends_of(store::Store& store, const FigureRequest& request,
                                               const figure::Drawing& drawing);

// Returns the palette and the opacity that the figure uses for the layer.
const Palette& palette_of(const FigureRequest& request, const Layer& layer);
double opacity_of(const FigureRequest& request, const Layer& layer);

// Returns what query::seen_layers needs to know about the layers of the figure.
std::vector<query::LayerCover> covers_of(const FigureRequest& request);
// Returns the legends of the layers that are visible. `seen` has one element for each layer.
Result<std::vector<figure::Legend>> legends_of(store::Store& store, const FigureRequest& request,
                                               const std::vector<query::SeenLayer>& seen);

}  // namespace strata::app
