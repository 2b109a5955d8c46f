#pragma once

#include "domain/layers/palette.h"

namespace strata {

// The background of an image: a gradient from the top row to the bottom row.
struct Background {
  Rgba top{242, 240, 236, 255};
  Rgba bottom{214, 211, 205, 255};
  bool operator==(const Background&) const = default;
};

}  // namespace strata
