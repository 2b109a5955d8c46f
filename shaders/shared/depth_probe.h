#pragma once
#include "shared/types.h"
STRATA_SHARED_BEGIN
const uint kDepthCell = 16u;  // pixels a side of one cell of the coarse depth grid
STRATA_SHARED_END
