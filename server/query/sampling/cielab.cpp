#include "query/sampling/cielab.h"

#include <array>

namespace strata::query {

float light_of_srgb(std::uint8_t code) {
  static const std::array<float, 256> light = [] {
    std::array<float, 256> of_code{};
    for (std::size_t i = 0; i < of_code.size(); ++i) {
      const double srgb = static_cast<double>(i) / 255;
      of_code[i] = static_cast<float>(srgb <= 0.04045 ? srgb / 12.92
                                                      : std::pow((srgb + 0.055) / 1.055, 2.4));
    }
    return of_code;
  }();
  return light[code];
}

}  // namespace strata::query
