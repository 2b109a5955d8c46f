#include "mesh/surface_samples.h"

#include <algorithm>
#include <cmath>

namespace strata::mesh {
namespace {

constexpr int kCellsPerRadius = 5;
constexpr double kMostPieces = 2e7;
// Cells of a group have 20 bits an axis.
constexpr double kMostCells = 1 << 20;

struct Piece {
  std::uint64_t group;  // fine cell and the way it faces
  glm::vec3 position, normal;
  float area;
};

// Which of the six axis directions a normal is nearest to.
std::uint64_t facing(const glm::vec3& n) {
  const glm::vec3 size = glm::abs(n);
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

}  // namespace

double SurfaceSamples::least_radius(double area, const glm::dvec3& extent) {
  const double by_pieces = kCellsPerRadius * std::sqrt(2 * area / kMostPieces);
  const double by_cells = kCellsPerRadius * std::max({extent.x, extent.y, extent.z}) / kMostCells;
  return std::max(by_pieces, by_cells);
}

SurfaceSamples::SurfaceSamples(const Geometry& geometry, float radius) : radius_(radius), low_(geometry.box_min) {
  const float cell = radius / kCellsPerRadius;
  std::vector<Piece> pieces;
  pieces.reserve(geometry.triangle_count());
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    const auto at = [&](std::size_t k) { return geometry.vertices[geometry.indices[3 * t + k]].position; };
    const glm::vec3 a = at(0), ab = at(1) - a, ac = at(2) - a;
    const glm::vec3 cross = glm::cross(ab, ac);
    const float length = glm::length(cross);
    if (!(length > 0)) continue;
    const glm::vec3 normal = cross / length;
    const float longest = std::sqrt(std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(ac - ab, ac - ab)}));
    const int cuts = std::max(1, static_cast<int>(std::ceil(longest / cell)));
    const float area = length / 2 / static_cast<float>(cuts * cuts);
    const auto add = [&](float i, float j) {
      const glm::vec3 position = a + (i * ab + j * ac) / static_cast<float>(cuts);
      const glm::ivec3 fine(glm::floor((position - low_) / cell));
      const std::uint64_t group = (std::uint64_t(std::uint32_t(fine.x) & 0xfffff) << 3) |
                                  (std::uint64_t(std::uint32_t(fine.y) & 0xfffff) << 23) |
                                  (std::uint64_t(std::uint32_t(fine.z) & 0xfffff) << 43) | facing(normal);
      pieces.push_back({group, position, normal, area});
    };
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j) {
        add(static_cast<float>(i) + 1.0f / 3, static_cast<float>(j) + 1.0f / 3);
        if (i + j + 1 < cuts) add(static_cast<float>(i) + 2.0f / 3, static_cast<float>(j) + 2.0f / 3);
      }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& p, const Piece& q) { return p.group < q.group; });

  struct Keyed {
    std::uint64_t cell;
    Sample sample;
  };
  std::vector<Keyed> keyed;
  for (std::size_t i = 0; i < pieces.size();) {
    glm::dvec3 position(0), normal(0);
    double area = 0;
    const auto group = pieces[i].group;
    for (; i < pieces.size() && pieces[i].group == group; ++i) {
      area += pieces[i].area;
      position += double{pieces[i].area} * glm::dvec3(pieces[i].position);
      normal += double{pieces[i].area} * glm::dvec3(pieces[i].normal);
    }
    const Sample sample{glm::vec3(position / area), glm::vec3(glm::normalize(normal)), static_cast<float>(area)};
    keyed.push_back({key_of(cell_of(sample.position)), sample});
  }
  std::stable_sort(keyed.begin(), keyed.end(), [](const Keyed& p, const Keyed& q) { return p.cell < q.cell; });
  samples_.reserve(keyed.size());
  for (const Keyed& k : keyed) {
    auto& range = cells_.try_emplace(k.cell, Range{static_cast<std::uint32_t>(samples_.size()), 0}).first->second;
    ++range.count;
    samples_.push_back(k.sample);
  }
}

std::span<const SurfaceSamples::Sample> SurfaceSamples::in_cell(const glm::ivec3& cell) const {
  const auto found = cells_.find(key_of(cell));
  if (found == cells_.end()) return {};
  return {samples_.data() + found->second.first, found->second.count};
}

}  // namespace strata::mesh
