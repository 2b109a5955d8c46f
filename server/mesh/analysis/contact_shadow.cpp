#include "mesh/analysis/contact_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "domain/scene/up.h"

namespace strata::mesh {
namespace {

constexpr int kSize = ContactShadow::kSize;
constexpr int kMargin = 20;  // texels around the model, for the soft border
constexpr int kModel = kSize - 2 * kMargin;
constexpr int kFade = 4;  // texels at the border of the map over which the shadow fades out

// The sum of three shadows: of the parts on the floor, of the parts just above it, and of the
// model. Heights are shares of the model's extent on the floor.
struct Part {
  double height;  // parts of the model above this height have no effect
  double spread;  // standard deviation of the blur, in texels
  float share;
};
constexpr std::array<Part, 3> kParts{{{0.03, 1.2, 0.4f}, {0.15, 4.0, 0.35f}, {0.6, 8.0, 0.25f}}};

using Heights = std::vector<float>;  // lowest surface above each texel; infinite: no surface
using Map = std::vector<float>;

std::size_t index(int x, int y) {
  return static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x);
}

void lower(Heights& heights, glm::dvec3 point) {
  const int x = std::clamp(static_cast<int>(point.x), 0, kSize - 1);
  const int y = std::clamp(static_cast<int>(point.y), 0, kSize - 1);
  float& height = heights[index(x, y)];
  height = std::min(height, static_cast<float>(point.z));
}

// Draws a triangle. `corners`: x and y in texels, z above the floor. Also draws the edges, because
// an upright or small triangle may contain no center of a texel.
void draw(Heights& heights, const std::array<glm::dvec3, 3>& corners) {
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 from = corners[i], to = corners[(i + 1) % 3];
    const int steps =
        1 + static_cast<int>(std::max(std::abs(to.x - from.x), std::abs(to.y - from.y)));
    for (int step = 0; step < steps; ++step)
      lower(heights, glm::mix(from, to, static_cast<double>(step) / steps));
  }
  const glm::dvec2 a(corners[0]), b(corners[1]), c(corners[2]);
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  for (int y = static_cast<int>(std::ceil(low.y - 0.5)); y + 0.5 <= high.y; ++y) {
    for (int x = static_cast<int>(std::ceil(low.x - 0.5)); x + 0.5 <= high.x; ++x) {
      const glm::dvec2 p(x + 0.5, y + 0.5);
      const double v = ((p.x - a.x) * (c.y - a.y) - (p.y - a.y) * (c.x - a.x)) / area;
      const double w = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / area;
      if (v < 0 || w < 0 || v + w > 1) continue;
      lower(heights, {p, corners[0].z + v * (corners[1].z - corners[0].z) +
                             w * (corners[2].z - corners[0].z)});
    }
  }
}

// Blurs the rows of a map and swaps its axes, so that two calls blur both axes.
Map blurred_rows(const Map& map, const std::vector<float>& kernel) {
  const int reach = static_cast<int>(kernel.size()) - 1;
  Map result(map.size());
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      float sum = 0;
      for (int i = -reach; i <= reach; ++i)
        if (x + i >= 0 && x + i < kSize)
          sum += kernel[static_cast<std::size_t>(std::abs(i))] * map[index(x + i, y)];
      result[index(y, x)] = sum;
    }
  }
  return result;
}

Map blurred(const Map& map, double spread) {
  std::vector<float> kernel(static_cast<std::size_t>(std::ceil(3 * spread)) + 1);
  double sum = 0;
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double x = static_cast<double>(i) / spread;
    kernel[i] = static_cast<float>(std::exp(-0.5 * x * x));
    sum += (i == 0 ? 1 : 2) * kernel[i];
  }
  for (float& weight : kernel) weight = static_cast<float>(weight / sum);
  return blurred_rows(blurred_rows(map, kernel), kernel);
}

float border_fade(int x, int y) {
  const int inside = std::min({x, y, kSize - 1 - x, kSize - 1 - y});
  return std::min(1.0f, static_cast<float>(inside) / kFade);
}

}  // namespace

std::shared_ptr<const ContactShadow> contact_shadow(const Geometry& geometry, std::string_view up) {
  const UpFrame frame = up_frame(up);
  const glm::dmat3 to_floor = glm::transpose(glm::dmat3(frame.right, frame.into, frame.up));
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  for (const Vertex& vertex : geometry.vertices) {
    const glm::dvec3 point = to_floor * glm::dvec3(vertex.position);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  if (geometry.indices.empty() || !(extent > 0) || !std::isfinite(extent)) return nullptr;
  const double texel = extent / kModel;
  const glm::dvec3 center((low.x + high.x) / 2, (low.y + high.y) / 2, low.z);
  const glm::dvec3 corner = center - glm::dvec3(texel * kSize / 2, texel * kSize / 2, 0);

  Heights heights(std::size_t{kSize} * kSize, std::numeric_limits<float>::infinity());
  const auto on_floor = [&](std::uint32_t vertex) {
    const glm::dvec3 point = to_floor * glm::dvec3(geometry.vertices[vertex].position) - corner;
    return glm::dvec3(point.x / texel, point.y / texel, point.z / extent);
  };
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3)
    draw(heights, {on_floor(geometry.indices[i]), on_floor(geometry.indices[i + 1]),
                   on_floor(geometry.indices[i + 2])});

  Map sum(heights.size(), 0.0f);
  for (const Part& part : kParts) {
    Map near(heights.size());
    std::ranges::transform(heights, near.begin(), [&](float height) {
      return std::max(0.0f, 1 - height / static_cast<float>(part.height));
    });
    const Map soft = blurred(near, part.spread);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.share * soft[i];
  }

  auto shadow = std::make_shared<ContactShadow>();
  const glm::dmat3 from_floor(frame.right, frame.into, frame.up);
  shadow->corner = glm::vec3(from_floor * corner);
  shadow->along_row = glm::vec3(frame.right * (texel * kSize));
  shadow->along_column = glm::vec3(frame.into * (texel * kSize));
  shadow->up = glm::vec3(frame.up);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      shadow->cover[index(x, y)] = static_cast<std::uint8_t>(
          std::lround(255 * std::clamp(sum[index(x, y)] * border_fade(x, y), 0.0f, 1.0f)));
  return shadow;
}

}  // namespace strata::mesh
