#pragma once

#include "app/figures/figures.h"
#include "app/services.h"

namespace strata::app {

// Draws the figure of a rollout, with its rulers, and writes it to a file in `folder`. The request
// must contain a rollout. Returns 422 for a model that cannot be unrolled (see plan_rollout), with
// a field of the figure's request, and 503 if too many figures are being created. Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_rollout_figure(
    const Services& services, ByteBudget& budget, const FigureRequest& request,
    const std::filesystem::path& folder, Progress& progress);

}  // namespace strata::app
