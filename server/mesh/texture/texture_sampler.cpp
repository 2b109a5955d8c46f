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

// Returns an image whose pixels are the mean light of `across` × `down` pixels, each 1 or 2.
Picture reduced(const Picture& picture, int across, int down) {
  const ColorTables& tables = color_tables();
  Picture small{std::max(picture.width / across, 1), std::max(picture.height / down, 1), {}};
  small.rgba.resize(std::size_t(small.width) * small.height * 4);
  std::uint8_t* out = small.rgba.data();
  const int count = across * down;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x, out += 4) {
      const std::uint8_t* pixels[4];
      std::uint32_t alpha = 0;
      for (int k = 0; k < count; ++k) {
        const int from_x = std::min(across * x + k % across, picture.width - 1),
                  from_y = std::min(down * y + k / across, picture.height - 1);
        pixels[k] = &picture.rgba[(std::size_t(from_y) * picture.width + from_x) * 4];
        alpha += pixels[k][3];
      }
      // Invisible pixels have equal weights. Filters of larger images can show their color.
      const std::uint32_t weights = alpha > 0 ? alpha : static_cast<std::uint32_t>(count);
      for (int c = 0; c < 3; ++c) {
        std::uint32_t light = weights / 2;
        for (int k = 0; k < count; ++k)
          light += (alpha > 0 ? pixels[k][3] : 1u) * tables.linear[pixels[k][c]];
        out[c] = tables.srgb[light / weights];
      }
      out[3] = static_cast<std::uint8_t>((alpha + static_cast<std::uint32_t>(count) / 2) /
                                         static_cast<std::uint32_t>(count));
    }
  return small;
}

}  // namespace

Picture halve(const Picture& picture) { return reduced(picture, 2, 2); }

bool halve_toward(Picture& picture, int side) {
  const int across = picture.width >= 2 * side ? 2 : 1, down = picture.height >= 2 * side ? 2 : 1;
  if (across == 1 && down == 1) return false;
  picture = reduced(picture, across, down);
  return true;
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
