#include "mesh/surface/uv_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata::mesh {
namespace {

constexpr int kMaxCells = 4096;     // per side
constexpr double kRounding = 1e-6;  // margin of a triangle's box, in texture coordinates

struct Nearest {
  double distance2;
  glm::dvec3 weights;
};

// Returns the point of a triangle that is nearest to `p`.
Nearest nearest_in(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (twice != 0) {
    const double wb = ((p.x - a.x) * (c.y - a.y) - (p.y - a.y) * (c.x - a.x)) / twice;
    const double wc = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / twice;
    if (wb >= 0 && wc >= 0 && wb + wc <= 1) return {0, {1 - wb - wc, wb, wc}};
  }
  Nearest best{std::numeric_limits<double>::infinity(), {1, 0, 0}};
  const glm::dvec2 corners[] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    const glm::dvec2 from = corners[k], along = corners[(k + 1) % 3] - from;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) : 0;
    const glm::dvec2 apart = from + t * along - p;
    if (const double distance2 = glm::dot(apart, apart); distance2 < best.distance2) {
      best = {distance2, glm::dvec3(0)};
      best.weights[k] = 1 - t;
      best.weights[(k + 1) % 3] = t;
    }
  }
  return best;
}

}  // namespace

UvLookup::UvLookup(const Geometry& geometry)
    : geometry_(geometry),
      side_(std::clamp(static_cast<int>(std::sqrt(static_cast<double>(geometry.triangle_count()))),
                       1, kMaxCells)) {
  first_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
  const std::size_t count = geometry.triangle_count();
  for (std::size_t i = 0; i < count; ++i)
    for_each_cell(i, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  triangles_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < count; ++i)
    for_each_cell(
        i, [&](std::size_t cell) { triangles_[next[cell]++] = static_cast<std::uint32_t>(i); });
}

int UvLookup::cell_of(double coordinate) const {
  const double at = coordinate * side_;
  return at >= 0 ? static_cast<int>(std::min(at, side_ - 1.0)) : 0;
}

template <class Visit>
void UvLookup::for_each_cell(std::size_t triangle, Visit&& visit) const {
  glm::dvec2 low(std::numeric_limits<double>::infinity()),
      high(-std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec2 uv(geometry_.vertices[geometry_.indices[3 * triangle + k]].uv);
    low = glm::min(low, uv);
    high = glm::max(high, uv);
  }
  for (int y = cell_of(low.y - kRounding); y <= cell_of(high.y + kRounding); ++y)
    for (int x = cell_of(low.x - kRounding); x <= cell_of(high.x + kRounding); ++x)
      visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) +
            static_cast<std::size_t>(x));
}

std::optional<glm::dvec3> UvLookup::place_at(glm::dvec2 uv) const {
  const std::size_t cell =
      static_cast<std::size_t>(cell_of(uv.y)) * static_cast<std::size_t>(side_) +
      static_cast<std::size_t>(cell_of(uv.x));
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<glm::dvec3> place;
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const std::uint32_t* corner = &geometry_.indices[std::size_t{3} * triangles_[i]];
    const Vertex &a = geometry_.vertices[corner[0]], &b = geometry_.vertices[corner[1]],
                 &c = geometry_.vertices[corner[2]];
    const Nearest found = nearest_in(uv, a.uv, b.uv, c.uv);
    if (found.distance2 >= nearest) continue;
    nearest = found.distance2;
    place = found.weights[0] * geometry_.positions[a.position_index] +
            found.weights[1] * geometry_.positions[b.position_index] +
            found.weights[2] * geometry_.positions[c.position_index] - geometry_.origin;
    if (nearest == 0) break;
  }
  return place;
}

}  // namespace strata::mesh
