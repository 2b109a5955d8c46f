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

// The looks that a view asks for. Refused (not_found, invalid) with the field's name: one that is
// not there or comes twice.
Result<std::vector<room::SurfaceImageView>> surface_image_views(
    const room::Room& room, const std::vector<protocol::LookShown>& asked);
// What a view shows; refused as those, with the fields of layers, looks and light.
Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& images,
    const std::optional<Light>& light);
Result<Background> background_of(const std::optional<protocol::Background>& asked);

// Of a layer of records, for `field`; the filter's columns are found when it is first drawn.
Result<room::Highlight> highlight_of(const protocol::Highlight& body, const Layer& layer,
                                     const std::string& field);

}  // namespace strata::net
