#include "jobs/demo_rules.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "mesh/demo/demo_pot_noise.h"

namespace strata::jobs {
namespace {

constexpr int kCrazeCells = 110;
constexpr std::size_t kCandidates = 4000;

// Widths as shares of the radius, which is about 50 mm.
constexpr double kOpenWidth = 0.020, kCrackWidth = 0.013, kHairlineWidth = 0.0065;

// Chooses each new seed as the candidate that is farthest from all earlier seeds, so the cells get
// similar sizes.
std::vector<glm::dvec3> spread_seeds(const std::vector<glm::dvec3>& candidates, int count,
                                     std::size_t first) {
  std::vector<glm::dvec3> seeds;
  std::vector<double> distance(candidates.size(), std::numeric_limits<double>::infinity());
  std::size_t next = first % candidates.size();
  for (int i = 0; i < count; ++i) {
    seeds.push_back(candidates[next]);
    for (std::size_t k = 0; k < candidates.size(); ++k)
      distance[k] = std::min(distance[k], glm::distance(candidates[k], seeds.back()));
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }
  return seeds;
}

// The nearest and the second nearest seed of a point, and the point's distance to the border
// between them.
struct Cell {
  int nearest = 0, second = 0;
  double to_border = 0;
};

Cell cell_of(const std::vector<glm::dvec3>& seeds, const glm::dvec3& p) {
  Cell cell;
  double first = std::numeric_limits<double>::infinity(), second = first;
  for (int i = 0; i < static_cast<int>(seeds.size()); ++i) {
    const double d = glm::dot(seeds[i] - p, seeds[i] - p);
    if (d < first) {
      second = std::exchange(first, d);
      cell.second = std::exchange(cell.nearest, i);
    } else if (d < second) {
      second = d;
      cell.second = i;
    }
  }
  cell.to_border = (second - first) / (2 * glm::distance(seeds[cell.nearest], seeds[cell.second]));
  return cell;
}

// Returns a number from 0 to 1 for the border of two cells. The order of the cells has no effect.
double chance_of(const Cell& cell) {
  const auto [low, high] = std::minmax(cell.nearest, cell.second);
  return mesh::lattice_noise(low, high, 7) * 0.5 + 0.5;
}

glm::dvec3 warp(const glm::dvec3& p, double scale, double amount, int octaves) {
  return p + amount * glm::dvec3(mesh::fractal_noise(p * scale, octaves),
                                 mesh::fractal_noise(p * scale + 31.7, octaves),
                                 mesh::fractal_noise(p * scale + 67.3, octaves));
}

}  // namespace

DemoRules::DemoRules(std::span<const glm::vec3> surface) {
  glm::dvec3 low(surface.front()), high(surface.front());
  for (const auto& p : surface) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  center_ = (low + high) / 2.0;
  const glm::dvec3 extent = high - low;
  radius_ = std::max({extent.x, extent.y, extent.z}) / 2;
  // The points are sorted by height, and duplicates are removed. So the demo does not depend on the
  // order and the number of copies of points, which the cuts of an atlas change.
  std::vector<glm::vec3> sorted(surface.begin(), surface.end());
  std::ranges::sort(sorted, [](const glm::vec3& a, const glm::vec3& b) {
    return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x);
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<glm::dvec3> candidates;
  const std::size_t step = std::max<std::size_t>(1, sorted.size() / kCandidates);
  for (std::size_t i = 0; i < sorted.size(); i += step) candidates.push_back(towards(sorted[i]));
  sherd_seeds_ = spread_seeds(candidates, kSherds, candidates.size() / 3);
  craze_seeds_ = spread_seeds(candidates, kCrazeCells, candidates.size() / 2);
}

// Projects a point to the unit sphere around the center, so both faces of the wall get the same
// position.
glm::dvec3 DemoRules::towards(const glm::vec3& position) const {
  const glm::dvec3 from_center = (glm::dvec3(position) - center_) / radius_;
  const double length = glm::length(from_center);
  return length > 1e-9 ? from_center / length : glm::dvec3(0, 0, -1);
}

DemoRules::Marks DemoRules::at(const glm::vec3& position) const {
  const glm::dvec3 p = towards(position);
  // Coarse noise bends the breaks, fine noise makes them ragged.
  const Cell sherd = cell_of(sherd_seeds_, warp(warp(p, 2.6, 0.30, 2), 16.0, 0.035, 3));
  Marks marks{static_cast<std::uint8_t>(sherd.nearest + 1), none};

  const double width = 0.75 + 0.6 * mesh::fractal_noise(p * 9.0 + 11.0, 2);
  const double chance = chance_of(sherd);
  if (chance < 0.40 && sherd.to_border < kOpenWidth * width) {
    marks.crack = open_crack;
  } else if (chance < 0.80 && sherd.to_border < kCrackWidth * width) {
    marks.crack = crack;
  } else {
    const Cell craze = cell_of(craze_seeds_, warp(warp(p, 4.0, 0.16, 2), 22.0, 0.03, 2));
    const double tapered =
        kHairlineWidth * std::clamp(0.75 + 1.6 * mesh::fractal_noise(p * 4.5 + 3.0, 2), 0.0, 1.3);
    if (chance_of(craze) < 0.30 && craze.to_border < tapered) marks.crack = hairline;
  }
  return marks;
}

}  // namespace strata::jobs
