#pragma once

#include <cstdint>

#include "app/layers/layer_features.h"
#include "core/error.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "mesh/io/gltf/write_glb.h"

namespace strata::app {

// The channels of a picture that distinguish the ids of `count` features, 1 to 3.
struct IdChannels {
  int channels = 1;
  std::uint32_t none = 0;  // the id for texels without a feature: the largest number
};
IdChannels id_channels(std::uint32_t count);

// Returns an upper limit of the memory in bytes for the picture of the ids, while it is written.
std::uint64_t bytes_to_write_ids(const Layer& layer);

// Returns about the memory in bytes that the features need until the file is written.
std::uint64_t bytes_of(const mesh::GlbFeatures& features);

// Converts the classes of a layer to features of a GLB file. The id of a feature is its index in
// `classes.table`. Each texel of the layer is one pixel of the ids, so lookups of the nearest pixel
// return the layer's values. Returns 422 (`features`) for a layer without values, and `cancelled`.
Result<mesh::GlbFeatures> glb_features(const LayerClasses& classes, Progress& progress);

}  // namespace strata::app
