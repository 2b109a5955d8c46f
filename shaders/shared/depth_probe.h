#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kDepthCell = 16u;  // pixels along a side of a cell in the coarse depth grid
STRATA_SHARED_END
