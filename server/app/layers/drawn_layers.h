#pragma once

#include "app/services.h"
#include "core/memory_ledger.h"
#include "domain/people/role.h"
#include "media/picture.h"
#include "query/sampling/drawn_layer.h"
#include "query/sampling/values.h"
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

}  // namespace strata::app
