#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
// In the layout of glMultiDrawElementsIndirect.
struct DrawCommand {
  uint count;
  uint instance_count;  // 0: hidden
  uint first_index;
  uint base_vertex;
  uint base_instance;
};
const uint kIndicesPerCluster = 3072u;
const float kClusterMarginPx = 1.0;       // rounding of the window's coordinates
const float kClusterMarginDepth = 4e-6;   // rounding of interpolated depth
STRATA_SHARED_END
