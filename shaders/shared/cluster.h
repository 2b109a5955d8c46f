#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// The layout that glMultiDrawElementsIndirect requires.
struct DrawCommand {
  uint count;
  uint instance_count;  // 0: hidden
  uint first_index;
  uint base_vertex;
  uint base_instance;
};
const uint kIndicesPerCluster = 3072u;
const float kClusterMarginPx = 1.0;       // for the rounding of window coordinates
const float kClusterMarginDepth = 4e-6;   // for the rounding of interpolated depth
STRATA_SHARED_END
