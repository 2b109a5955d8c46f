#pragma once

#include <memory>

#include "domain/people/role.h"
#include "net/api/route_help.h"
#include "net/serialization/view_settings_serialization.h"
#include "room/room.h"
#include "room/view_settings.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {

// Removes layers and columns that are deleted or invisible to the role from stored layer settings
// (`layers` of a view). Blocks.
void leave_out_unseen(store::Store& store, Role role, const room::Room& room,
                      nlohmann::json& shown_layers);

// Converts the requested overrides to their stored format, which contains ids because slugs can
// change. `settings` must be the result of `view_settings` for these overrides.
nlohmann::json stored_layers(const std::vector<protocol::LayerOverride>& overrides,
                             const room::ViewSettings& settings);

// Returns a saved view with only the entities that the caller can see.
nlohmann::json to_json(const RouteContext& context, const Request& request,
                       const store::NamedPart& view, const room::Room& room);

// Converts a saved view to a request that creates the same view, with the camera and the shown
// settings.
Result<protocol::ViewCreate> as_view_create(const RouteContext& context, const Request& request,
                                            const store::NamedPart& view, const room::Room& room);

// Returns the shown settings in the body of a request.
template <class ViewBody>
Result<room::ViewSettings> shown_settings(const room::Room& room, const ViewBody& body) {
  return view_settings(room, body.layers.value_or(std::vector<protocol::LayerOverride>{}),
                       body.looks, body.light);
}

}  // namespace strata::net
