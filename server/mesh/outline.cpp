#include "mesh/outline.h"

#include <cmath>
#include <limits>

#include "mesh/adjacency.h"
#include "mesh/flatten.h"

namespace strata::mesh {
namespace {

constexpr int kAngles = 32;

// Turns the outline so that its box has the least area.
void turn(Outline& outline) {
  float least = std::numeric_limits<float>::max();
  Outline best;
  for (int step = 0; step < kAngles; ++step) {
    const float angle = glm::radians(90.f) * static_cast<float>(step) / kAngles;
    Outline turned;
    turned.cosine = std::cos(angle), turned.sine = std::sin(angle);
    glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const auto& p : outline.segments) {
      const glm::vec2 q = turned.from_chart(p);
      low = glm::min(low, q), high = glm::max(high, q);
    }
    turned.low = low, turned.size = high - low;
    if (const float area = turned.size.x * turned.size.y; area < least) least = area, best = turned;
  }
  for (auto& p : outline.segments) p = best.from_chart(p);
  best.segments = std::move(outline.segments);
  outline = std::move(best);
}

}  // namespace

std::vector<Outline> make_outlines(const ChartSurface& surface, std::span<const Chart> charts,
                                   std::span<const glm::vec2> plane) {
  const auto chart_of_face = chart_of_faces(charts, surface.mesh.triangle_count());
  std::vector<Outline> outlines(charts.size());
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (const auto face : charts[c].faces)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = surface.neighbours[3 * std::size_t{face} + k];
        if (next != kNoTriangle && chart_of_face[next] == c) continue;
        outlines[c].segments.push_back(plane[3 * std::size_t{face} + k]);
        outlines[c].segments.push_back(plane[3 * std::size_t{face} + (k + 1) % 3]);
      }
    turn(outlines[c]);
  }
  return outlines;
}

}  // namespace strata::mesh
