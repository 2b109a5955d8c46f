#pragma once

#include <optional>
#include <vector>

#include "app/services.h"
#include "core/memory_ledger.h"
#include "domain/people/role.h"
#include "media/picture.h"
#include "query/sampling/drawn_layer.h"
#include "query/sampling/surface_colors.h"
#include "query/sampling/values.h"
#include "room/at.h"
#include "room/room.h"
#include "room/view_settings.h"

namespace strata::app {

// Surface images and layers for drawings on the CPU.

// A decoded surface image. `memory` is reserved as long as it exists.
struct DecodedPhoto {
  Picture picture;
  MemoryLedger::Share memory;
};
// Returns an error (503) for an image that exceeds the memory limit. Blocks.
Result<DecodedPhoto> decode_photo(const Services& services, const room::SurfaceImageView& image);

// Returns a layer with the settings of a view. Refuses (422) a palette or highlight that uses a
// column invisible to the role. Blocks.
Result<query::DrawnLayer> drawn_layer(const Services& services, Role role,
                                      const query::LayerView& view,
                                      const room::LayerView& settings = {});

// The colors of a model's surface. `memory` is reserved for the photos as long as they exist.
struct ComposedSurface {
  query::SurfaceColors colors;
  std::vector<MemoryLedger::Share> memory;
};
// Composes the surface images of the view settings, or the images that are visible by default, and
// over them the layers. With `pixels`, images that have at least twice as many pixels on a side are
// averaged, for a drawing with about this many pixels over the whole atlas. Returns the errors of
// the functions above. Blocks.
Result<ComposedSurface> compose_surface(const Services& services, room::Room& room, Role role,
                                        const std::vector<Layer>& bottom_to_top,
                                        const room::ViewSettings& shown, room::At at,
                                        std::optional<int> pixels = {});

}  // namespace strata::app
