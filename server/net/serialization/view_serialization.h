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

// Of how layers are shown, as it is kept (`layers` of a view): takes out what names a layer or
// column that is not there for the role. Blocks.
void leave_out_unseen(store::Store& store, Role role, const room::Room& room,
                      nlohmann::json& shown_layers);

// What was asked for, as it is kept: with ids, since slugs change. `settings`: what `view_settings`
// made of it.
nlohmann::json kept_layers(const std::vector<protocol::LayerOverride>& asked,
                           const room::ViewSettings& settings);

// A named view, for who asks: of what it names, what is there for them.
nlohmann::json to_json(const RouteContext& context, const Request& request,
                       const store::NamedPart& view, const room::Room& room);

// The same as what one would ask to keep: where from, and what is shown how.
Result<protocol::ViewCreate> as_asked(const RouteContext& context, const Request& request,
                                      const store::NamedPart& view, const room::Room& room);

// What the body of a request says is shown.
template <class Asked>
Result<room::ViewSettings> shown_settings(const room::Room& room, const Asked& asked) {
  return view_settings(room, asked.layers.value_or(std::vector<protocol::LayerOverride>{}),
                       asked.looks, asked.light);
}

}  // namespace strata::net
