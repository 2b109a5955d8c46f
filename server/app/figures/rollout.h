#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/services.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "media/picture.h"
#include "mesh/rollout/trace_rollout.h"
#include "room/at.h"
#include "room/room.h"
#include "room/view_settings.h"

namespace strata::app {

// The settings of a rollout. The caller has checked the user's request.
struct RolloutRequest {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Role role = Role::viewer;
  mesh::FitRequest fit;
  std::optional<double> cut;  // in radians
  room::ViewSettings shown;   // layers and surface images; the light has no effect
  std::vector<Layer> layers;  // visible layers, from bottom to top
  room::At at;                // the state of the layers
  bool relief = true;         // shade the surface where it deviates from the fitted surface
};

// Fits the surface and lays out the sheet. Errors: see mesh::fit_sheet. Blocks.
Result<mesh::FittedSheet> plan_rollout(const RolloutRequest& request);

// Draws a window of the sheet. Pixels without a surface are transparent. Returns 422 for a palette
// that uses a column invisible to the role, 503 if there is too little memory, and `cancelled`.
// Blocks.
Result<Picture> draw_rollout(const Services& services, const RolloutRequest& request,
                             const mesh::FittedSheet& plan, const mesh::RolloutWindow& window,
                             Progress& progress);
// As above, but passes each row to `take` as RGBA8. Calls it on several threads.
using TakeRolloutRow = std::function<void(int row, std::span<const std::uint8_t> rgba)>;
Result<void> draw_rollout(const Services& services, const RolloutRequest& request,
                          const mesh::FittedSheet& plan, const mesh::RolloutWindow& window,
                          const TakeRolloutRow& take, Progress& progress);

}  // namespace strata::app
