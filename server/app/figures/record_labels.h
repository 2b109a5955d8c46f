#pragma once

#include "app/figures/figures.h"
#include "figure/drawing.h"

namespace strata::app {

// Returns the labels of records in a drawing of this size, in millimeters from its top left. Omits
// labels that would overlap others. Without a request for labels, returns none. Blocks.
Result<std::vector<figure::Label>> record_labels(store::Store& store, const FigureRequest& request,
                                                 const figure::Drawing& drawing,
                                                 const glm::dvec2& drawing_mm);

}  // namespace strata::app
