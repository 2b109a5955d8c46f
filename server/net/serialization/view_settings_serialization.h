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
// repeated image, with the field's name.
Result<std::vector<room::SurfaceImageView>> surface_image_views(
    const room::Room& room, const std::vector<protocol::LookShown>& requested);
// Returns the settings of a view; refuses likewise, with the fields of layers, looks and light.
Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& images,
    const std::optional<Light>& light);
Result<Background> background_of(const std::optional<protocol::Background>& requested);

// For a layer of records, at `field`; the first drawing looks up the filter's columns.
Result<room::Highlight> highlight_of(const protocol::Highlight& body, const Layer& layer,
                                     const std::string& field);

}  // namespace strata::net
