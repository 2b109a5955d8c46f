#include "mesh/texture/texture_sampler.h"

#include <algorithm>
#include <cmath>

#include "mesh/texture/color_math.h"

namespace strata::mesh {
namespace {

// Returns the pixel at position `at` of an endless row.
int wrapped(std::int64_t at, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<std::int64_t>(at, 0, size - 1));
  const std::int64_t period = wrap == Wrap::mirror ? 2 * std::int64_t{size} : size;
  const std::int64_t in_period = ((at % period) + period) % period;
  return static_cast<int>(in_period < size ? in_period : period - 1 - in_period);
}

}  // namespace

Picture halve(const Picture& picture) {
  const ColorTables& tables = color_tables();
  Picture half{std::max(picture.width / 2, 1), std::max(picture.height / 2, 1), {}};
  half.rgba.resize(std::size_t(half.width) * half.height * 4);
  std::uint8_t* out = half.rgba.data();
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x, out += 4) {
      std::uint32_t light[3] = {2, 2, 2}, alpha = 2;
      for (int k = 0; k < 4; ++k) {
        const int sx = std::min(2 * x + k % 2, picture.width - 1),
                  sy = std::min(2 * y + k / 2, picture.height - 1);
        const std::uint8_t* p = &picture.rgba[(std::size_t(sy) * picture.width + sx) * 4];
        for (int c = 0; c < 3; ++c) light[c] += tables.linear[p[c]];
        alpha += p[3];
      }
      for (int c = 0; c < 3; ++c) out[c] = tables.srgb[light[c] / 4];
      out[3] = static_cast<std::uint8_t>(alpha / 4);
    }
  return half;
}

glm::vec4 TextureSampler::sample_with_alpha(glm::dvec2 uv, Wrap wrap_u, Wrap wrap_v) const {
  // Coordinates far away keep double precision in their fraction. NaN is replaced by the origin.
  const auto finite = [](double value) { return std::abs(value) < 1e9 ? value : 0.0; };
  const double x = finite(uv.x) * picture_.width - 0.5,
               y = (1 - finite(uv.y)) * picture_.height - 0.5;
  const double x_floor = std::floor(x), y_floor = std::floor(y);
  const auto x_share = static_cast<float>(x - x_floor), y_share = static_cast<float>(y - y_floor);
  const auto left = static_cast<std::int64_t>(x_floor), top = static_cast<std::int64_t>(y_floor);
  const int x0 = wrapped(left, picture_.width, wrap_u),
            x1 = wrapped(left + 1, picture_.width, wrap_u);
  const int y0 = wrapped(top, picture_.height, wrap_v),
            y1 = wrapped(top + 1, picture_.height, wrap_v);
  return glm::mix(glm::mix(pixel(x0, y0), pixel(x1, y0), x_share),
                  glm::mix(pixel(x0, y1), pixel(x1, y1), x_share), y_share);
}

}  // namespace strata::mesh
