#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace strata::query {

// Colors in CIELAB of 1976, with the white point D65. A distance of 2 is hardly visible; the
// distance from black to white is 100.

// Returns the light of an sRGB code, 0…1 (IEC 61966-2-1).
float light_of_srgb(std::uint8_t code);

// Returns L*, a* and b* of linear red, green and blue, 0…1.
inline glm::vec3 lab_of_light(const glm::vec3& light) {
  const float r = light.x, g = light.y, b = light.z;
  const auto root = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.0f / 116; };
  const float x = root((0.4124f * r + 0.3576f * g + 0.1805f * b) / 0.9505f);
  const float y = root(0.2126f * r + 0.7152f * g + 0.0722f * b);
  const float z = root((0.0193f * r + 0.1192f * g + 0.9505f * b) / 1.0890f);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// Returns L* of an sRGB color with red in the low byte, 0…100.
inline float lightness(std::uint32_t color) {
  const auto light = [&](int shift) {
    return light_of_srgb(static_cast<std::uint8_t>(color >> shift));
  };
  return lab_of_light({light(0), light(8), light(16)}).x;
}

}  // namespace strata::query
