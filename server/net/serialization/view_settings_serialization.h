#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "protocol/parse.h"
#include "room/view_settings.h"

namespace strata::room {
class Room;
}

namespace strata::net {

// Returns the surface images that a view requests. Refuses (not_found, invalid) a missing or
// repeated image, with the name of the field.
Result<std::vector<room::SurfaceImageView>> surface_image_views(
    const room::Room& room, const std::vector<protocol::LookShown>& requested);
// Returns the settings of a view. Refuses invalid layers, looks and light in the same way, with the
// names of their fields.
Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& images,
    const std::optional<Light>& light);
Result<Background> background_of(const std::optional<protocol::Background>& requested);

// Converts the highlight for a layer of records. Errors name `field`. The columns of the filter are
// looked up when the view is first drawn.
Result<room::Highlight> highlight_of(const protocol::Highlight& body, const Layer& layer,
                                     const std::string& field);

}  // namespace strata::net
