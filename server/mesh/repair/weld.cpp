#include "mesh/repair/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/index_table.h"

namespace strata::mesh {
namespace {

// `find(i)` returns the vertex that replaces vertex i. This may be i itself.
template <class Find>
std::uint64_t redirect(TriangleMesh& mesh, const std::vector<bool>& used, Find&& find) {
  std::vector<std::uint32_t> representative(mesh.positions.size());
  std::uint64_t merged = 0;
  for (std::uint32_t i = 0; i < representative.size(); ++i) {
    if (!used[i]) continue;
    representative[i] = find(i);
    merged += representative[i] != i;
  }
  for (std::uint32_t& index : mesh.triangles) index = representative[index];
  return merged;
}

std::uint64_t hash_of(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return mix_hash(mix_hash(mix_hash(0, x), y), z);
}

std::size_t count_of(const std::vector<bool>& used) {
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

}  // namespace

std::uint64_t weld_equal(TriangleMesh& mesh, const std::vector<bool>& used) {
  IndexTable table(count_of(used));
  return redirect(mesh, used, [&](std::uint32_t i) {
    glm::dvec3& p = mesh.positions[i];
    p += 0.0;
    const auto hash = hash_of(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
                              std::bit_cast<std::uint64_t>(p.z));
    return table.find_or_insert(hash, i,
                                [&](std::uint32_t other) { return mesh.positions[other] == p; });
  });
}

std::uint64_t weld_near(TriangleMesh& mesh, const std::vector<bool>& used, double distance) {
  // The cells are as wide as the distance. Vertices within the distance are therefore in the same
  // cell or in one of the 26 surrounding cells.
  const auto cell_of = [&](double coordinate) { return std::floor(coordinate / distance); };
  const auto hash = [](const glm::dvec3& cell) {
    const glm::dvec3 plain = cell + 0.0;  // −0 becomes 0
    return hash_of(std::bit_cast<std::uint64_t>(plain.x), std::bit_cast<std::uint64_t>(plain.y),
                   std::bit_cast<std::uint64_t>(plain.z));
  };
  IndexTable table(count_of(used));
  return redirect(mesh, used, [&](std::uint32_t i) {
    const glm::dvec3& p = mesh.positions[i];
    const glm::dvec3 cell(cell_of(p.x), cell_of(p.y), cell_of(p.z));
    std::uint32_t nearest = i;
    double least = distance * distance;
    for (int n = 0; n < 27; ++n) {
      const glm::dvec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      table.for_each(hash(cell + step), [&](std::uint32_t other) {
        const glm::dvec3 way = mesh.positions[other] - p;
        const double square = glm::dot(way, way);
        if (square < least || (square == least && other < nearest)) {
          least = square;
          nearest = other;
        }
      });
    }
    if (nearest == i) table.insert(hash(cell), i);
    return nearest;
  });
}

}  // namespace strata::mesh
