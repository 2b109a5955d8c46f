#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "mesh/texture/vertex_color.h"

namespace strata::mesh {

// Conversion tables between stored color values and linear light in 0…65535.
struct ColorTables {
  std::array<std::uint16_t, 256> linear;
  std::array<std::uint8_t, 65536> srgb;
};

inline const ColorTables& color_tables() {
  static const ColorTables made = [] {
    ColorTables tables;
    for (int i = 0; i < 256; ++i)
      tables.linear[i] = static_cast<std::uint16_t>(std::lround(65535 * linear_of_srgb(i / 255.0)));
    for (int i = 0; i < 65536; ++i)
      tables.srgb[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_of_linear(i / 65535.0)));
    return tables;
  }();
  return made;
}

}  // namespace strata::mesh
