#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "mesh/load_formats.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kLargestCoordinate = 1e15;  // beyond it squares and cubes of lengths leave the range of float
constexpr double kSmallestExtent = 1e-12;

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

// Open addressing over indices into arrays that live elsewhere: 4 bytes a slot, at most 3/4 full.
class IndexTable {
 public:
  explicit IndexTable(std::size_t expected)
      : slots_(std::bit_ceil(std::max<std::size_t>(16, expected + expected / 3 + 1)), kNone) {}

  // The index that is `equal` to `index` and was put in earlier, or `index` itself, put in now.
  template <class Equal>
  std::uint32_t find_or_insert(std::uint64_t hash, std::uint32_t index, Equal equal) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kNone) return slots_[slot] = index;
      if (equal(slots_[slot])) return slots_[slot];
    }
  }

 private:
  std::vector<std::uint32_t> slots_;
};

std::vector<bool> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (std::uint32_t index : mesh.triangles) used[index] = true;
  return used;
}

Result<void> check_coordinates(const TriangleMesh& mesh, const std::vector<bool>& used) {
  std::uint64_t not_finite = 0, too_large = 0, first = kNone;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!used[i]) continue;
    const glm::dvec3& p = mesh.positions[i];
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    const bool large = finite && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargestCoordinate;
    if ((!finite || large) && first == kNone) first = i;
    not_finite += !finite;
    too_large += large;
  }
  if (not_finite > 0) {
    return refuse_file(
        std::to_string(not_finite) +
        " vertices that triangles use have a coordinate that is not a finite number (the first is vertex " +
        std::to_string(first) + ", counted from 0). Remove or repair them.");
  }
  if (too_large > 0) {
    return refuse_file(std::to_string(too_large) +
                       " vertices that triangles use have a coordinate beyond 1e15 (the first is vertex " +
                       std::to_string(first) + ", counted from 0). Check the unit of the file.");
  }
  return {};
}

// Points every corner at the first vertex with the same position. Returns the number of vertices that were merged.
std::uint64_t weld(TriangleMesh& mesh, const std::vector<bool>& used) {
  std::vector<std::uint32_t> representative(mesh.positions.size());
  const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  IndexTable table(count);
  std::uint64_t merged = 0;
  for (std::uint32_t i = 0; i < representative.size(); ++i) {
    if (!used[i]) continue;
    glm::dvec3& p = mesh.positions[i];
    p += 0.0;  // -0 is 0
    std::uint64_t hash = mix(0, std::bit_cast<std::uint64_t>(p.x));
    hash = mix(mix(hash, std::bit_cast<std::uint64_t>(p.y)), std::bit_cast<std::uint64_t>(p.z));
    hash ^= hash >> 32;
    representative[i] = table.find_or_insert(hash, i, [&](std::uint32_t other) { return mesh.positions[other] == p; });
    merged += representative[i] != i;
  }
  for (std::uint32_t& index : mesh.triangles) index = representative[index];
  return merged;
}

bool has_no_area(const TriangleMesh& mesh, const std::uint32_t* t) {
  const glm::dvec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  return glm::cross(b - a, c - a) == glm::dvec3(0);
}

std::array<std::uint32_t, 3> sorted_corners(const std::uint32_t* t) {
  std::array<std::uint32_t, 3> key{t[0], t[1], t[2]};
  if (key[0] > key[1]) std::swap(key[0], key[1]);
  if (key[1] > key[2]) std::swap(key[1], key[2]);
  if (key[0] > key[1]) std::swap(key[0], key[1]);
  return key;
}

// Keeps triangles that have area and are the first with their three corners, whichever way round.
void drop_triangles(LoadedMesh& loaded) {
  TriangleMesh& mesh = loaded.mesh;
  IndexTable table(mesh.triangle_count());
  std::uint64_t degenerate = 0, no_area = 0, duplicate = 0;
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const std::uint32_t t[3] = {mesh.triangles[3 * i], mesh.triangles[3 * i + 1], mesh.triangles[3 * i + 2]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++degenerate;
      continue;
    }
    if (has_no_area(mesh, t)) {
      ++no_area;
      continue;
    }
    const auto key = sorted_corners(t);
    std::uint64_t hash = mix(mix(mix(0, key[0]), key[1]), key[2]);
    hash ^= hash >> 32;
    // The slot that is written first is where the triangle goes if it stays, so that the table can compare with it.
    std::copy(t, t + 3, mesh.triangles.begin() + 3 * std::ptrdiff_t{kept});
    const std::uint32_t found = table.find_or_insert(hash, kept, [&](std::uint32_t other) {
      return sorted_corners(&mesh.triangles[3 * std::size_t{other}]) == key;
    });
    if (found != kept) {
      ++duplicate;
      continue;
    }
    if (!mesh.corner_uvs.empty()) {
      for (std::size_t k = 0; k < 3; ++k) mesh.corner_uvs[3 * std::size_t{kept} + k] = mesh.corner_uvs[3 * i + k];
    }
    ++kept;
  }
  mesh.triangles.resize(3 * std::size_t{kept});
  if (!mesh.corner_uvs.empty()) mesh.corner_uvs.resize(3 * std::size_t{kept});
  note(loaded.repairs, "dropped degenerate triangles", degenerate);
  note(loaded.repairs, "dropped triangles without area", no_area);
  note(loaded.repairs, "dropped duplicate triangles", duplicate);
}

// Moves the used vertices together, in their order.
void drop_unused(TriangleMesh& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  std::vector<std::uint32_t> moved(mesh.positions.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    mesh.positions[kept] = mesh.positions[i];
    if (!mesh.vertex_colors.empty()) mesh.vertex_colors[kept] = mesh.vertex_colors[i];
    moved[i] = kept++;
  }
  mesh.positions.resize(kept);
  if (!mesh.vertex_colors.empty()) mesh.vertex_colors.resize(kept);
  for (std::uint32_t& index : mesh.triangles) index = moved[index];
}

}  // namespace

Result<void> repair(LoadedMesh& loaded, Progress& progress) {
  TriangleMesh& mesh = loaded.mesh;
  const std::size_t vertices_of_file = mesh.positions.size();
  progress.report(kParsedShare, "Checking coordinates");
  std::uint64_t merged = 0;
  {
    const std::vector<bool> used = used_vertices(mesh);
    if (auto checked = check_coordinates(mesh, used); !checked) return checked;
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0.7, "Joining equal vertices");
    merged = weld(mesh, used);
  }
  note(loaded.repairs, "welded vertices at equal positions", merged);
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.8, "Dropping degenerate and duplicate triangles");
  drop_triangles(loaded);
  if (mesh.triangles.empty()) return refuse_file("No triangle of the file has an area.");
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.95, "Dropping unused vertices");
  drop_unused(mesh);
  note(loaded.repairs, "dropped unused vertices", vertices_of_file - merged - mesh.positions.size());

  glm::dvec3 low = mesh.positions[0], high = low;
  for (const glm::dvec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 extent = high - low;
  if (std::max({extent.x, extent.y, extent.z}) < kSmallestExtent) {
    return refuse_file("The whole mesh is smaller than 1e-12 units. Check the unit of the file.");
  }
  mesh.positions.shrink_to_fit();
  progress.report(1, "Read");
  return {};
}

}  // namespace strata::mesh
