#include "mesh/surface/geometry.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/surface/uv_islands.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::uint32_t kStoneGrey = 0xffcfd3d6u;
// The alpha of the file is not used, because this byte stores the openness
// (analysis/vertex_openness.h).
constexpr std::uint32_t kOpen = 0xff000000u;
constexpr double kRoundOriginAbove = 16;

// Spreads the low 21 bits of `value` with two zero bits between neighboring bits.
std::uint64_t spread_bits(std::uint64_t value) {
  value &= 0x1fffff;
  value = (value | value << 32) & 0x1f00000000ffffULL;
  value = (value | value << 16) & 0x1f0000ff0000ffULL;
  value = (value | value << 8) & 0x100f00f00f00f00fULL;
  value = (value | value << 4) & 0x10c30c30c30c30c3ULL;
  return (value | value << 2) & 0x1249249249249249ULL;
}

constexpr int kCurveBits = 21;  // of each coordinate
constexpr std::uint32_t kCurveEnd = (1u << kCurveBits) - 1;

// Returns the index of a cell on the Hilbert curve (Skilling 2004, "Programming the Hilbert
// curve").
std::uint64_t hilbert_code(std::array<std::uint32_t, 3> cell) {
  for (std::uint32_t bit = 1u << (kCurveBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (auto& coordinate : cell) {
      const std::uint32_t swapped = (coordinate & bit) != 0 ? 0 : (cell[0] ^ coordinate) & below;
      cell[0] ^= (coordinate & bit) != 0 ? below : swapped;
      coordinate ^= swapped;
    }
  }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  std::uint32_t turn = 0;
  for (std::uint32_t bit = 1u << (kCurveBits - 1); bit > 1; bit >>= 1)
    if ((cell[2] & bit) != 0) turn ^= bit - 1;
  return spread_bits(cell[0] ^ turn) << 2 | spread_bits(cell[1] ^ turn) << 1 |
         spread_bits(cell[2] ^ turn);
}

// Returns the triangle numbers part by part, in each part in the order of a Hilbert curve through
// the centroids. Neighbors on the surface are near each other. A run of triangles is compact,
// because the curve never jumps. This order is good for GPU caches, culling clusters, compression
// and the search tree.
std::vector<std::uint32_t> spatial_order(const TriangleMesh& mesh, const glm::dvec3& low,
                                         const glm::dvec3& extent) {
  struct Entry {
    std::uint64_t code;
    std::uint32_t triangle;
  };
  const double scale = double{kCurveEnd} / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::vector<Entry> entries(mesh.triangle_count());
  for (std::uint32_t t = 0; t < entries.size(); ++t) {
    const std::uint32_t* corners = &mesh.triangles[3 * std::size_t{t}];
    const glm::dvec3 centroid =
        (mesh.positions[corners[0]] + mesh.positions[corners[1]] + mesh.positions[corners[2]]) /
        3.0;
    const glm::uvec3 cell(glm::clamp((centroid - low) * scale, 0.0, double{kCurveEnd}));
    entries[t] = {hilbert_code({cell.x, cell.y, cell.z}), t};
  }
  const auto sort = [&](std::size_t begin, std::size_t end) {
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(begin),
              entries.begin() + static_cast<std::ptrdiff_t>(end),
              [](const Entry& a, const Entry& b) {
                return a.code != b.code ? a.code < b.code : a.triangle < b.triangle;
              });
  };
  std::size_t begin = 0;
  for (const std::size_t end : mesh.part_ends) sort(std::exchange(begin, end), end);
  sort(begin, entries.size());
  std::vector<std::uint32_t> order(entries.size());
  std::transform(entries.begin(), entries.end(), order.begin(),
                 [](const Entry& e) { return e.triangle; });
  return order;
}

std::uint32_t snorm10(float value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 511.0f)) & 0x3ffu;
}

std::uint32_t pack_normal(const glm::dvec3& sum) {
  const double length = glm::length(sum);
  const glm::vec3 normal = length > 0 ? glm::vec3(sum / length) : glm::vec3(0, 0, 1);
  return snorm10(normal.x) | snorm10(normal.y) << 10 | snorm10(normal.z) << 20;
}

// Returns the area-weighted normals of the mesh's positions. The length of the cross product is
// twice the area.
std::vector<std::uint32_t> position_normals(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const std::uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
    const glm::dvec3 cross =
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    sums[a] += cross;
    sums[b] += cross;
    sums[c] += cross;
  }
  std::vector<std::uint32_t> normals(sums.size());
  std::transform(sums.begin(), sums.end(), normals.begin(), pack_normal);
  return normals;
}

// Numbers vertices and positions by first use.
class VertexSplitter {
 public:
  VertexSplitter(const TriangleMesh& mesh, const Atlas& atlas, Geometry& geometry)
      : mesh_(mesh),
        atlas_(atlas),
        geometry_(geometry),
        normals_(position_normals(mesh)),
        welder_(mesh.positions.size()),
        position_of_(mesh.positions.size(), kNone) {
    geometry_.positions.reserve(mesh.positions.size());
    geometry_.vertices.reserve(mesh.positions.size() + mesh.positions.size() / 4);
  }

  std::uint32_t vertex_for(std::size_t corner) {
    const std::uint32_t source = mesh_.triangles[corner];
    const glm::vec2 uv =
        corner < atlas_.corner_uvs.size() ? atlas_.corner_uvs[corner] : glm::vec2(0);
    const auto [index, is_new] = welder_.number(source, uv);
    if (!is_new) return index;
    if (position_of_[source] == kNone) {
      position_of_[source] = static_cast<std::uint32_t>(geometry_.positions.size());
      geometry_.positions.push_back(mesh_.positions[source]);
    }
    geometry_.vertices.push_back(
        {glm::vec3(mesh_.positions[source] - geometry_.origin), normals_[source], uv,
         mesh_.vertex_colors.empty() ? kStoneGrey : mesh_.vertex_colors[source] | kOpen,
         position_of_[source]});
    return index;
  }

 private:
  const TriangleMesh& mesh_;
  const Atlas& atlas_;
  Geometry& geometry_;
  std::vector<std::uint32_t> normals_;
  CornerWelder welder_;
  std::vector<std::uint32_t> position_of_;  // new number of each mesh position
};

// Returns a component of a packed normal (GL_INT_2_10_10_10_REV).
float component(std::uint32_t packed, int axis) {
  const auto bits = static_cast<std::int32_t>(packed << (22 - 10 * axis));
  return static_cast<float>(bits >> 22);
}

}  // namespace

glm::vec3 normal_of(const Vertex& vertex) {
  const glm::vec3 normal(component(vertex.normal, 0), component(vertex.normal, 1),
                         component(vertex.normal, 2));
  const float length = glm::length(normal);
  return length > 0 ? normal / length : glm::vec3(0, 0, 1);
}

void find_boxes(Geometry& geometry) {
  geometry.clusters.clear();
  constexpr std::size_t kIndices = 3 * Geometry::kTrianglesPerCluster;
  for (std::size_t first = 0; first < geometry.indices.size(); first += kIndices) {
    const std::size_t end = std::min(first + kIndices, geometry.indices.size());
    ClusterBox box;
    box.min = box.max = geometry.vertices[geometry.indices[first]].position;
    for (std::size_t i = first; i < end; ++i) {
      const glm::vec3& position = geometry.vertices[geometry.indices[i]].position;
      box.min = glm::min(box.min, position);
      box.max = glm::max(box.max, position);
    }
    geometry.clusters.push_back(box);
  }
  if (geometry.clusters.empty()) return;
  geometry.box_min = geometry.clusters.front().min;
  geometry.box_max = geometry.clusters.front().max;
  for (const ClusterBox& box : geometry.clusters) {
    geometry.box_min = glm::min(geometry.box_min, box.min);
    geometry.box_max = glm::max(geometry.box_max, box.max);
  }
}

std::size_t Geometry::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(positions) + of(vertices) + of(indices) + of(clusters) + of(part_ends);
}

int Geometry::part_of(std::uint32_t triangle) const {
  return static_cast<int>(std::ranges::upper_bound(part_ends, triangle) - part_ends.begin());
}

std::vector<TriangleRange> visible_ranges(const Geometry& geometry, const PartSet& hidden_parts) {
  const auto all = static_cast<std::uint32_t>(geometry.triangle_count());
  if (geometry.part_ends.empty()) return {{0, all}};
  std::vector<TriangleRange> ranges;
  std::uint32_t begin = 0;
  for (std::size_t part = 0; part < geometry.part_ends.size(); ++part) {
    const std::uint32_t end = geometry.part_ends[part];
    if (!hidden_parts.test(part) && begin < end) {
      if (!ranges.empty() && ranges.back().end == begin)
        ranges.back().end = end;
      else
        ranges.push_back({begin, end});
    }
    begin = end;
  }
  return ranges;
}

std::vector<glm::dvec3> positions_without(const Geometry& geometry, const PartSet& hidden_parts) {
  std::vector<glm::dvec3> positions;
  // Positions are numbered by first use, so a range of parts has a range of them.
  for (const auto [begin, end] : visible_ranges(geometry, hidden_parts)) {
    std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
    for (std::size_t i = 3 * std::size_t{begin}; i < 3 * std::size_t{end}; ++i) {
      const std::uint32_t position = geometry.vertices[geometry.indices[i]].position_index;
      low = std::min(low, position);
      high = std::max(high, position);
    }
    if (low <= high)
      positions.insert(positions.end(), geometry.positions.begin() + low,
                       geometry.positions.begin() + high + 1);
  }
  return positions;
}

double surface_area(const Geometry& geometry) {
  const auto corner = [&](std::size_t i) -> const glm::dvec3& {
    return geometry.positions[geometry.vertices[geometry.indices[i]].position_index];
  };
  double sum = 0;
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3)
    sum += glm::length(glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i))) / 2;
  return sum;
}

Geometry build_geometry(const TriangleMesh& mesh, const Atlas& atlas) {
  Geometry geometry;
  if (mesh.triangles.empty()) return geometry;
  glm::dvec3 low = mesh.positions[mesh.triangles[0]], high = low;
  for (std::uint32_t index : mesh.triangles) {
    low = glm::min(low, mesh.positions[index]);
    high = glm::max(high, mesh.positions[index]);
  }
  const glm::dvec3 extent = high - low;
  geometry.origin = low + extent / 2.0;
  if (std::max({extent.x, extent.y, extent.z}) > kRoundOriginAbove)
    geometry.origin = glm::round(geometry.origin);

  const std::vector<std::uint32_t> order = spatial_order(mesh, low, extent);
  VertexSplitter splitter(mesh, atlas, geometry);
  geometry.indices.reserve(mesh.triangles.size());
  for (std::uint32_t triangle : order) {
    for (std::size_t k = 0; k < 3; ++k)
      geometry.indices.push_back(splitter.vertex_for(3 * std::size_t{triangle} + k));
  }
  geometry.part_ends = mesh.part_ends;
  find_boxes(geometry);
  return geometry;
}

}  // namespace strata::mesh
