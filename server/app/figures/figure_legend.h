#pragma once

#include "app/figures/figures.h"
#include "figure/drawing.h"
#include "query/sampling/seen_layers.h"

namespace strata::app {

// Returns the visible layers in a drawing, with one element for each layer of the request. Leaves
// out layers that opaque layers cover completely, content outside the drawing, and areas smaller
// than a dot of the drawing. Blocks.
Result<std::vector<query::SeenLayer>> layers_in(store::Store& store, const FigureRequest& request,
                                                const figure::Drawing& drawing);

// Returns the palette and the opacity that the figure uses for the layer.
const Palette& palette_of(const FigureRequest& request, const Layer& layer);
double opacity_of(const FigureRequest& request, const Layer& layer);

// Returns what query::seen_layers needs to know about the layers of the figure.
std::vector<query::LayerCover> covers_of(const FigureRequest& request);

// The visible layers of a view. `seen` has one element for each layer of the request.
struct SeenView {
  const FigureRequest* request = nullptr;
  std::vector<query::SeenLayer> seen;
};
// Returns one legend for each visible layer, the topmost layer of the first view first. It contains
// the classes that any of the views shows. A layer with different palettes in different views has a
// legend for each palette.
std::vector<figure::Legend> legends_of(store::Store& store, const std::vector<SeenView>& views);

}  // namespace strata::app
