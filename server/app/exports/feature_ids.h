#pragma once

#include "app/layers/layer_features.h"
#include "core/error.h"
#include "core/progress.h"
#include "mesh/io/gltf/write_glb.h"

namespace strata::app {

// Converts the classes of a layer to features of a GLB file. The id of a feature is its index in
// `classes.table`. Each texel of the layer is one pixel of the ids, so lookups of the nearest pixel
// return the layer's values. Returns 422 (`features`) for a layer without values, and `cancelled`.
Result<mesh::GlbFeatures> glb_features(const LayerClasses& classes, Progress& progress);

}  // namespace strata::app
