#pragma once

#include "app/figures/sheet_view.h"

namespace strata::app {

// Makes a view of the unrolled surface with its rulers. Returns 422 if no surface fits.
Result<std::unique_ptr<SheetView>> make_rollout_view(const Services& services,
                                                     const FigureRequest& request);

}  // namespace strata::app
