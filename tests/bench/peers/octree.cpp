#include "bench/peers/octree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <mutex>
#include <string>

#include "mesh/parallel.h"

namespace strata::bench {
namespace {

constexpr int kDeepest = 15;
constexpr std::size_t kTrianglesPerBatch = 16384;
constexpr int kBucketLevels = 3;  // cells are sorted in 8³ parts of the cube
constexpr std::size_t kBuckets = std::size_t{1} << (3 * kBucketLevels);

// Spreads the bits of a coordinate, so the three coordinates can be interleaved.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

std::uint64_t morton(const glm::ivec3& cell) {
  return spread(static_cast<std::uint64_t>(cell.x)) |
         spread(static_cast<std::uint64_t>(cell.y)) << 1 |
         spread(static_cast<std::uint64_t>(cell.z)) << 2;
}

using Triangle = std::array<glm::vec3, 3>;  // in units of cells

// Tests the separating axes of a triangle and the cell (Akenine-Möller 2001). The caller tests the
// axes of the box.
bool crosses(const Triangle& triangle, const glm::vec3& normal, const glm::ivec3& cell) {
  const glm::vec3 center = glm::vec3(cell) + 0.5f;
  const glm::vec3 a = triangle[0] - center, b = triangle[1] - center, c = triangle[2] - center;
  const glm::vec3 reach = glm::abs(normal) * 0.5f;
  if (std::abs(glm::dot(normal, a)) > reach.x + reach.y + reach.z) return false;
  for (const glm::vec3& edge : {b - a, c - b, a - c}) {
    const glm::vec3 axes[] = {{0, -edge.z, edge.y}, {edge.z, 0, -edge.x}, {-edge.y, edge.x, 0}};
    for (const glm::vec3& axis : axes) {
      const float pa = glm::dot(axis, a), pb = glm::dot(axis, b), pc = glm::dot(axis, c);
      const float radius = 0.5f * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
      if (std::min({pa, pb, pc}) > radius || std::max({pa, pb, pc}) < -radius) return false;
    }
  }
  return true;
}

// Calls `found` with the cells that the triangle crosses. Searches columns along the axis that the
// triangle faces most, so each column has few such cells.
template <class Found>
void for_each_cell(const Triangle& triangle, int cells, Found&& found) {
  const glm::vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const glm::vec3 facing = glm::abs(normal);
  const int w = facing.x >= facing.y && facing.x >= facing.z ? 0 : facing.y >= facing.z ? 1 : 2;
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  const glm::vec3 low = glm::min(triangle[0], glm::min(triangle[1], triangle[2]));
  const glm::vec3 high = glm::max(triangle[0], glm::max(triangle[1], triangle[2]));
  const auto cell_of = [&](float x) {
    return std::clamp(static_cast<int>(std::floor(x)), 0, cells - 1);
  };
  const bool flat = facing[w] <= 0;  // the triangle has no area
  const float du = flat ? 0 : -normal[u] / normal[w], dv = flat ? 0 : -normal[v] / normal[w];
  const float reach = 0.5f * (std::abs(du) + std::abs(dv)) + 1e-3f;
  for (int i = cell_of(low[u]); i <= cell_of(high[u]); ++i) {
    for (int k = cell_of(low[v]); k <= cell_of(high[v]); ++k) {
      float from = low[w], to = high[w];
      if (!flat) {
        const float middle = triangle[0][w] + du * (static_cast<float>(i) + 0.5f - triangle[0][u]) +
                             dv * (static_cast<float>(k) + 0.5f - triangle[0][v]);
        from = std::max(from, middle - reach);
        to = std::min(to, middle + reach);
        if (from > to) continue;
      }
      for (int m = cell_of(from); m <= cell_of(to); ++m) {
        glm::ivec3 cell;
        cell[u] = i, cell[v] = k, cell[w] = m;
        if (crosses(triangle, normal, cell)) found(cell);
      }
    }
  }
}

void sort_unique(std::vector<std::uint64_t>& codes) {
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

std::uint64_t available_bytes() {
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    std::uint64_t kib = 0;
    if (word == "MemAvailable:" && info >> kib) return kib * 1024;
  }
  return ~std::uint64_t{0};
}

// The surface crosses about three times as many cells as its area would fill. Sorting needs memory
// for about three copies of each code.
Result<void> check_memory(double area, double cell_side, int depth) {
  const double needed = 3 * area / (cell_side * cell_side) * 24;
  const double available = 0.8 * static_cast<double>(available_bytes());
  if (needed <= available) return {};
  const auto gib = [](double bytes) {
    return std::to_string(static_cast<int>(std::ceil(bytes / (1u << 30))));
  };
  return fail(ErrorCode::unavailable, "Octree too large",
              "An octree of depth " + std::to_string(depth) + " of this model takes about " +
                  gib(needed) + " GiB to build and " + gib(available) +
                  " GiB can be had: run it on a larger machine.");
}

std::vector<std::vector<std::uint64_t>> crossed_cells(const mesh::Geometry& geometry,
                                                      const glm::vec3& low, float cell_side,
                                                      int depth, int threads) {
  std::vector<std::vector<std::uint64_t>> buckets(kBuckets);
  std::vector<std::mutex> mutexes(kBuckets);
  const int shift = std::max(0, 3 * (depth - kBucketLevels));
  const std::size_t batches =
      (geometry.triangle_count() + kTrianglesPerBatch - 1) / kTrianglesPerBatch;
  mesh::parallel_for(threads, static_cast<int>(batches), [&](int batch) {
    std::vector<std::uint64_t> codes;
    const std::size_t first = static_cast<std::size_t>(batch) * kTrianglesPerBatch;
    const std::size_t last = std::min(first + kTrianglesPerBatch, geometry.triangle_count());
    for (std::size_t t = first; t < last; ++t) {
      Triangle triangle;
      for (std::size_t corner = 0; corner < 3; ++corner)
        triangle[corner] =
            (geometry.vertices[geometry.indices[3 * t + corner]].position - low) / cell_side;
      for_each_cell(triangle, 1 << depth,
                    [&](const glm::ivec3& cell) { codes.push_back(morton(cell)); });
    }
    sort_unique(codes);
    for (auto begin = codes.begin(); begin != codes.end();) {
      const std::size_t bucket = *begin >> shift;
      const auto end =
          std::upper_bound(begin, codes.end(), bucket,
                           [&](std::size_t b, std::uint64_t code) { return b < code >> shift; });
      std::lock_guard lock(mutexes[bucket]);
      buckets[bucket].insert(buckets[bucket].end(), begin, end);
      begin = end;
    }
  });
  mesh::parallel_for(threads, static_cast<int>(kBuckets),
                     [&](int bucket) { sort_unique(buckets[static_cast<std::size_t>(bucket)]); });
  return buckets;
}

}  // namespace

Result<Octree> Octree::build(const mesh::Geometry& geometry, int depth, int threads) {
  if (depth < 1 || depth > kDeepest)
    return fail(ErrorCode::invalid, "Depth out of range", "An octree has 1 to 15 levels.", "depth");
  Octree tree;
  const glm::vec3 extent = geometry.box_max - geometry.box_min;
  // Slightly larger than the model, so no vertex is on the far faces.
  tree.side_ = std::max({extent.x, extent.y, extent.z}) * 1.0001f;
  tree.low_ = (geometry.box_min + geometry.box_max - tree.side_) * 0.5f;
  const float cell_side = tree.side_ / static_cast<float>(1u << depth);
  double area = 0;
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    const auto corner = [&](std::size_t i) {
      return geometry.vertices[geometry.indices[3 * t + i]].position;
    };
    area += 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
  }
  if (auto enough = check_memory(area, cell_side, depth); !enough)
    return tl::unexpected(enough.error());

  std::vector<std::uint64_t> codes;
  {
    auto buckets = crossed_cells(geometry, tree.low_, cell_side, depth, threads);
    std::size_t count = 0;
    for (const auto& bucket : buckets) count += bucket.size();
    codes.reserve(count);
    for (auto& bucket : buckets) {
      codes.insert(codes.end(), bucket.begin(), bucket.end());
      std::vector<std::uint64_t>().swap(bucket);
    }
  }
  tree.leaf_count_ = codes.size();
  tree.levels_.resize(static_cast<std::size_t>(depth));
  for (int level = depth - 1; level >= 0; --level) {
    auto& nodes = tree.levels_[static_cast<std::size_t>(level)];
    std::size_t parents = 0;
    for (std::size_t i = 0; i < codes.size();) {
      const std::uint64_t parent = codes[i] >> 3;
      Node node{static_cast<std::uint32_t>(i), 0};
      for (; i < codes.size() && codes[i] >> 3 == parent; ++i) node.mask |= 1u << (codes[i] & 7);
      nodes.push_back(node);
      codes[parents++] = parent;  // this element is already read
    }
    codes.resize(parents);
    nodes.shrink_to_fit();
  }
  return tree;
}

std::size_t Octree::bytes() const {
  std::size_t bytes = 0;
  for (const auto& level : levels_) bytes += level.size() * sizeof(Node);
  return bytes;
}

std::vector<glm::uvec3> Octree::leaf_cells() const {
  std::vector<glm::uvec3> cells{glm::uvec3(0)};
  for (const auto& level : levels_) {
    std::vector<glm::uvec3> children;
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (std::uint32_t child = 0; child < 8; ++child)
        if (level[i].mask >> child & 1)
          children.push_back(cells[i] * 2u + glm::uvec3(child & 1, child >> 1 & 1, child >> 2));
    }
    cells = std::move(children);
  }
  return cells;
}

}  // namespace strata::bench
