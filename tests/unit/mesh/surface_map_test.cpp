#include "mesh/texels/surface_map.h"
#include "mesh/surface/geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "mesh/io/load.h"
#include "mesh/surface/uv_islands.h"
#include "mesh/texels/gutter_ring.h"
#include "mesh/texels/slot_bits.h"
#include "mesh/texels/tile_bounds.h"
#include "strata_dirs.h"
#include "support/meshes.h"
#include "support/scan_atlas.h"

namespace strata::mesh {
namespace {

constexpr int kResolution = 256;

// Computes one texel at a time by the definition in the header, without the code under test.
class Oracle {
 public:
  explicit Oracle(const Geometry& geometry)
      : geometry_(geometry), owner_(kResolution * kResolution, -1), covers_(owner_.size(), 0) {
    for (std::size_t t = 0; t < geometry.triangle_count(); ++t) cover(static_cast<int>(t));
    const auto by_coverage = owner_;
    std::vector<bool> has_texel(geometry.triangle_count(), false);
    for (std::size_t t = 0; t < geometry.triangle_count(); ++t) has_texel[t] = counted_[t] > 0;
    for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
      if (has_texel[t] || area(t) <= 0) continue;
      const glm::dvec2 centre = (uv(t, 0) + uv(t, 1) + uv(t, 2)) / 3.0;
      const int texel = std::min(int(centre.y), kResolution - 1) * kResolution +
                        std::min(int(centre.x), kResolution - 1);
      if (by_coverage[texel] >= 0) continue;
      take(texel, static_cast<int>(t));
    }
  }

  int owner(int x, int y) const { return inside(x, y) ? owner_[y * kResolution + x] : -1; }
  int owners(int x, int y) const { return covers_[y * kResolution + x]; }
  static bool inside(int x, int y) {
    return x >= 0 && y >= 0 && x < kResolution && y < kResolution;
  }

  // Returns the nearest surface texel at most 2 texels away in x and y, or (-1, -1).
  glm::ivec2 gutter_owner(int x, int y) const {
    glm::ivec2 best(-1);
    int least = 100;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (owner(x + dx, y + dy) >= 0 && dx * dx + dy * dy < least)
          least = dx * dx + dy * dy, best = {x + dx, y + dy};
    return best;
  }

  glm::dvec2 uv(std::size_t t, int k) const {
    return glm::dvec2(geometry_.vertices[geometry_.indices[3 * t + k]].uv) * double(kResolution);
  }
  glm::dvec3 corner(std::size_t t, int k) const {
    return glm::dvec3(geometry_.vertices[geometry_.indices[3 * t + k]].position);
  }
  double area(std::size_t t) const {
    const auto at = [&](int k) {
      return geometry_.positions[geometry_.vertices[geometry_.indices[3 * t + k]].position_index];
    };
    return glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
  }

  glm::dvec3 position(int t, double x, double y) const {
    const glm::dvec2 a = uv(t, 0), b = uv(t, 1), c = uv(t, 2), p(x, y);
    const auto cross = [](glm::dvec2 u, glm::dvec2 v) { return u.x * v.y - u.y * v.x; };
    const double whole = cross(b - a, c - a);
    glm::dvec3 weights(cross(b - p, c - p) / whole, cross(c - p, a - p) / whole,
                       cross(a - p, b - p) / whole);
    weights = glm::max(weights, glm::dvec3(0));
    weights /= weights.x + weights.y + weights.z;
    return weights.x * corner(t, 0) + weights.y * corner(t, 1) + weights.z * corner(t, 2);
  }
  bool is_line(int t) const {
    const glm::dvec2 e = uv(t, 1) - uv(t, 0), f = uv(t, 2) - uv(t, 0);
    return std::abs(e.x * f.y - e.y * f.x) < 1e-6;
  }

  // Returns the area of triangle t on the square of one texel, by clipping the triangle at the four
  // sides.
  double piece(std::size_t t, int x, int y) const {
    std::vector<glm::dvec2> polygon{uv(t, 0), uv(t, 1), uv(t, 2)};
    const auto size = [](const std::vector<glm::dvec2>& p) {
      double twice = 0;
      for (std::size_t i = 0; i < p.size(); ++i) {
        const auto a = p[i], b = p[(i + 1) % p.size()];
        twice += a.x * b.y - a.y * b.x;
      }
      return std::abs(twice) / 2;
    };
    const double whole = size(polygon);
    const auto clip = [&](auto&& depth) {
      std::vector<glm::dvec2> clipped;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = depth(a), db = depth(b);
        if (da >= 0) clipped.push_back(a);
        if ((da < 0) != (db < 0)) clipped.push_back(a + (b - a) * (da / (da - db)));
      }
      polygon = clipped;
    };
    clip([&](glm::dvec2 p) { return p.x - x; });
    clip([&](glm::dvec2 p) { return x + 1 - p.x; });
    clip([&](glm::dvec2 p) { return p.y - y; });
    clip([&](glm::dvec2 p) { return y + 1 - p.y; });
    return whole > 0 && polygon.size() > 2 ? size(polygon) / whole * area(t) : 0;
  }

 private:
  void take(int texel, int t) {
    auto& present = owner_[texel];
    if (present < 0 || float(area(t)) > float(area(present))) present = t;
  }
  void cover(int t) {
    std::array<glm::i64vec2, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = {std::lrint(uv(t, k).x * 256), std::lrint(uv(t, k).y * 256)};
    const auto cross = [](glm::i64vec2 a, glm::i64vec2 b, glm::i64vec2 q) {
      return (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
    };
    const auto twice = cross(p[0], p[1], p[2]);
    counted_.push_back(0);
    if (twice == 0) return;
    if (twice < 0) std::swap(p[1], p[2]);
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [bottom, top] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (int y = int(bottom / 256); y <= std::min<int>(int(top / 256), kResolution - 1); ++y)
      for (int x = int(left / 256); x <= std::min<int>(int(right / 256), kResolution - 1); ++x) {
        bool covered = true;
        for (int k = 0; k < 3 && covered; ++k) {
          const auto a = p[k], b = p[(k + 1) % 3];
          const auto side = cross(a, b, {x * 256 + 128, y * 256 + 128});
          covered = side > 0 || (side == 0 && (b.y < a.y || (b.y == a.y && b.x > a.x)));
        }
        if (!covered) continue;
        ++counted_[t];
        ++covers_[y * kResolution + x];
        take(y * kResolution + x, t);
      }
  }

  const Geometry& geometry_;
  std::vector<int> owner_, covers_, counted_;
};

SurfaceMap bake(const Geometry& geometry, int resolution = kResolution, int threads = 2) {
  Progress progress;
  auto map = bake_surface_map(geometry, resolution, progress, threads);
  EXPECT_TRUE(map.has_value());
  return std::move(*map);
}

struct Texel {
  std::uint32_t slot = kNoSlot;
  int index = 0;
};
Texel texel_at(const SurfaceMap& map, int x, int y) {
  return {map.slot_of_block[std::size_t(y / 8) * map.blocks_per_side + x / 8], y % 8 * 8 + x % 8};
}
bool is_surface(const SurfaceMap& map, int x, int y) {
  const auto [slot, index] = texel_at(map, x, y);
  return slot != kNoSlot && (map.surface_mask[slot] >> index & 1);
}
std::uint64_t packed_at(const SurfaceMap& map, int x, int y) {
  const auto [slot, index] = texel_at(map, x, y);
  return slot == kNoSlot ? kNoPosition : map.packed_position[std::size_t{slot} * 64 + index];
}
double area_sum(const SurfaceMap& map) {
  return std::accumulate(map.area.begin(), map.area.end(), 0.0);
}

struct Case {
  std::string name;
  Geometry geometry;
};
// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest looks for it
void PrintTo(const Case& instance, std::ostream* out) { *out << instance.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  Progress progress;
  for (auto& [name, mesh] : test::mesh_classes()) {
    const auto atlas = make_atlas(mesh, kResolution, progress);
    all.push_back({name, build_geometry(mesh, *atlas)});
    if (mesh.corner_uvs.empty()) continue;
    Atlas own;
    own.corner_uvs = mesh.corner_uvs;
    all.push_back({name + "_own_uvs", build_geometry(mesh, own)});
  }
  // The triangles are much smaller than the texels, so most of them cover no texel center.
  const auto dense = test::sphere(200, 0.01);
  all.push_back({"dense_sphere", build_geometry(dense, *make_atlas(dense, 128, progress))});
  return all;
}

class EveryGeometry : public testing::TestWithParam<Case> {
 protected:
  const Geometry& geometry() const { return GetParam().geometry; }
};
INSTANTIATE_TEST_SUITE_P(mesh_surface_map, EveryGeometry, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryGeometry,
       owns_exactly_the_texels_that_opengl_covers_and_those_of_triangles_between_centres) {
  const Oracle oracle(geometry());
  const SurfaceMap map = bake(geometry());
  std::uint64_t surface = 0, shared = 0;
  for (int y = 0; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x) {
      ASSERT_EQ(is_surface(map, x, y), oracle.owner(x, y) >= 0) << x << " " << y;
      surface += oracle.owner(x, y) >= 0;
      shared += oracle.owners(x, y) > 1;
    }
  EXPECT_EQ(map.surface_texels, surface);
  EXPECT_EQ(map.overlap_texels, shared);
}

TEST_P(EveryGeometry, places_surface_texels_on_their_triangle) {
  const Oracle oracle(geometry());
  const SurfaceMap map = bake(geometry());
  const float size = glm::length(geometry().box_max - geometry().box_min);
  for (int y = 0; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x) {
      const int t = oracle.owner(x, y);
      if (t < 0 || oracle.is_line(t)) continue;
      const auto [slot, index] = texel_at(map, x, y);
      const glm::dvec3 difference =
          glm::dvec3(map.position(slot, index)) - oracle.position(t, x + 0.5, y + 0.5);
      // If the gutter of another block uses the position of a texel, that position is on the grid
      // of the other block. The difference is at most 2^-20 of the model.
      ASSERT_LT(glm::length(difference), 2e-6 * size) << x << " " << y;
    }
}

TEST_P(EveryGeometry, gives_gutter_texels_the_position_of_the_nearest_surface_texel) {
  const Oracle oracle(geometry());
  const SurfaceMap map = bake(geometry());
  std::uint64_t gutter = 0;
  for (int y = 0; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x) {
      if (oracle.owner(x, y) >= 0) continue;
      const glm::ivec2 nearest = oracle.gutter_owner(x, y);
      if (nearest.x < 0) {
        ASSERT_EQ(packed_at(map, x, y), kNoPosition) << x << " " << y;
        continue;
      }
      ++gutter;
      const auto [slot, index] = texel_at(map, x, y);
      const auto [owner_slot, owner_index] = texel_at(map, nearest.x, nearest.y);
      // The positions must be identical to the last bit.
      ASSERT_EQ(map.position(slot, index), map.position(owner_slot, owner_index)) << x << " " << y;
      ASSERT_EQ(map.area[std::size_t{slot} * 64 + index], 0);
    }
  EXPECT_EQ(map.gutter_texels, gutter);
}

TEST_P(EveryGeometry, stores_only_blocks_that_hold_something) {
  const SurfaceMap map = bake(geometry());
  ASSERT_EQ(map.block_of_slot.size(), map.bounds_of_slot.size());
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    ASSERT_EQ(map.slot_of_block[map.block_of_slot[slot]], slot);
    const auto first = map.packed_position.begin() + std::ptrdiff_t{slot} * 64;
    ASSERT_TRUE(std::any_of(first, first + 64, [](std::uint64_t p) { return p != kNoPosition; }));
  }
}

TEST_P(EveryGeometry, sums_the_surface_texels_of_each_block) {
  const SurfaceMap map = bake(geometry());
  ASSERT_EQ(map.sums_of_slot.size(), map.block_of_slot.size());
  std::uint64_t texels = 0;
  double area = 0;
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    mesh::SurfaceMap::SlotSums plain;
    for (int i = 0; i < 64; ++i) {
      if (!(map.surface_mask[slot] >> i & 1)) continue;
      const double area_here = map.area[slot * 64 + i];
      const glm::vec3 position = map.position(slot, i);
      ++plain.texels;
      plain.area += area_here;
      plain.weighted_position += area_here * glm::dvec3(position);
      plain.lowest = glm::min(plain.lowest, position);
      plain.highest = glm::max(plain.highest, position);
    }
    ASSERT_EQ(map.sums_of_slot[slot], plain);
    texels += plain.texels;
    area += plain.area;
  }
  EXPECT_EQ(texels, map.surface_texels);
  EXPECT_NEAR(area, map.area_total, 1e-6 * map.area_total);
}

TEST_P(EveryGeometry, credits_the_area_of_the_whole_mesh) {
  double expected = 0;
  const Oracle oracle(geometry());
  for (std::size_t t = 0; t < geometry().triangle_count(); ++t) expected += oracle.area(t);
  for (const int resolution : {128, 256, 1024}) {
    const SurfaceMap map = bake(geometry(), resolution);
    EXPECT_NEAR(area_sum(map) / expected, 1, 1e-5) << resolution;
    EXPECT_NEAR(map.area_total / expected, 1, 1e-12);
    EXPECT_GE(*std::min_element(map.area.begin(), map.area.end()), 0);
  }
}

TEST_P(EveryGeometry, credits_each_piece_to_the_texel_it_lies_on_inside_an_island) {
  const Oracle oracle(geometry());
  const SurfaceMap map = bake(geometry());
  if (map.overlap_texels > 0) GTEST_SKIP() << "pieces of overlapping islands go elsewhere";
  // A texel whose 8 neighbors are surface gets no area from outside the rim of its island.
  std::vector<double> expected(kResolution * kResolution, 0);
  for (std::size_t t = 0; t < geometry().triangle_count(); ++t) {
    const auto [x0, x1] = std::minmax({oracle.uv(t, 0).x, oracle.uv(t, 1).x, oracle.uv(t, 2).x});
    const auto [y0, y1] = std::minmax({oracle.uv(t, 0).y, oracle.uv(t, 1).y, oracle.uv(t, 2).y});
    for (int y = int(y0); y <= std::min(int(y1), kResolution - 1); ++y)
      for (int x = int(x0); x <= std::min(int(x1), kResolution - 1); ++x)
        expected[y * kResolution + x] += oracle.piece(t, x, y);
  }
  const double mean = map.area_total / static_cast<double>(map.surface_texels);
  int compared = 0;
  for (int y = 2; y < kResolution - 2; ++y)
    for (int x = 2; x < kResolution - 2; ++x) {
      bool is_deep = true;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) is_deep &= oracle.owner(x + dx, y + dy) >= 0;
      if (!is_deep) continue;
      ++compared;
      const auto [slot, index] = texel_at(map, x, y);
      ASSERT_NEAR(map.area[std::size_t{slot} * 64 + index], expected[y * kResolution + x],
                  1e-4 * mean)
          << x << " " << y;
    }
  if (GetParam().name != "slivers" && GetParam().name != "separate_triangles") {
    EXPECT_GT(compared, 100);
  }
}

TEST_P(EveryGeometry, bakes_the_same_on_any_number_of_threads) {
  const SurfaceMap one = bake(geometry(), 512, 1);
  for (const int threads : {2, 5}) {
    const SurfaceMap many = bake(geometry(), 512, threads);
    EXPECT_EQ(one.slot_of_block, many.slot_of_block);
    EXPECT_EQ(one.packed_position, many.packed_position);
    EXPECT_EQ(one.surface_mask, many.surface_mask);
    EXPECT_EQ(one.area, many.area);
    EXPECT_EQ(one.sums_of_slot, many.sums_of_slot);
    EXPECT_EQ(one.overlap_texels, many.overlap_texels);
    ASSERT_EQ(one.tree.parts.size(), many.tree.parts.size());
    for (std::size_t i = 0; i < one.tree.parts.size(); ++i) {
      ASSERT_EQ(one.tree.parts[i].slot, many.tree.parts[i].slot);
      ASSERT_EQ(one.tree.levels[0][i].center, many.tree.levels[0][i].center);
    }
  }
}

bool holds(const BoundingSphere& bounds, const glm::vec3& position) {
  return glm::length(position - bounds.center) <= bounds.radius;
}

TEST_P(EveryGeometry, bounds_contain_the_positions_of_surface_and_gutter) {
  const SurfaceMap map = bake(geometry());
  std::vector<std::vector<std::uint32_t>> parts_of_slot(map.block_of_slot.size());
  for (std::uint32_t part = 0; part < map.tree.parts.size(); ++part) {
    const BlockTree::Part& in_tree = map.tree.parts[part];
    parts_of_slot[in_tree.slot].push_back(part);
  }
  ASSERT_EQ(map.tree.levels.back().size(), 1u);
  const auto bounds_without_map = bound_tiles(geometry(), kResolution);
  ASSERT_EQ(bounds_without_map.size(), map.bounds_of_tile.size());
  std::set<std::size_t> full_tiles;
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    const std::size_t bx = map.block_of_slot[slot] % map.blocks_per_side,
                      by = map.block_of_slot[slot] / map.blocks_per_side;
    const std::size_t tile = by / 16 * (kResolution / 128) + bx / 16;
    full_tiles.insert(tile);
    for (const auto part : parts_of_slot[slot]) {
      ASSERT_EQ(map.tree.parts[part].tile, tile);
      ASSERT_EQ(map.tree.parts[part].place, by % 16 * 16 + bx % 16);
      ASSERT_EQ(map.tree.parts[part].shares_block, parts_of_slot[slot].size() > 1);
    }
    for (int i = 0; i < 64; ++i) {
      if (map.packed_position[std::size_t{slot} * 64 + i] == kNoPosition) continue;
      const glm::vec3 position = map.position(slot, i);
      ASSERT_TRUE(holds(map.bounds_of_slot[slot], position));
      ASSERT_TRUE(holds(map.bounds_of_tile[tile], position));
      ASSERT_TRUE(holds(bounds_without_map[tile], position));
      const auto part = std::ranges::find_if(parts_of_slot[slot], [&](std::uint32_t p) {
        return holds(map.tree.levels[0][p], position);
      });
      ASSERT_NE(part, parts_of_slot[slot].end());
      std::size_t node = *part;
      for (const auto& level : map.tree.levels) {
        ASSERT_TRUE(holds(level[node], position));
        node /= BlockTree::kChildren;
      }
    }
  }
  for (std::size_t i = 0; i < map.bounds_of_tile.size(); ++i)
    EXPECT_EQ(map.bounds_of_tile[i].radius < 0, !full_tiles.contains(i));
}

TEST_P(EveryGeometry, tiles_show_what_the_slots_hold) {
  const SurfaceMap map = bake(geometry());
  for (int y = 0; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x) {
      const TileAddress tile{static_cast<std::uint16_t>(x / 128),
                             static_cast<std::uint16_t>(y / 128)};
      const int texel = y % 128 * 128 + x % 128;
      static thread_local TileMask owned, surface;
      if (texel % 128 == 0) owned = map.owned_in_tile(tile), surface = map.surface_in_tile(tile);
      ASSERT_EQ(owned.test(texel), packed_at(map, x, y) != kNoPosition);
      ASSERT_EQ(surface.test(texel), is_surface(map, x, y));
      const auto [slot, index] = texel_at(map, x, y);
      ASSERT_EQ(map.area_of(tile, texel),
                slot == kNoSlot ? 0 : map.area[std::size_t{slot} * 64 + index]);
    }
}

TEST_P(EveryGeometry, gutter_texels_get_the_bits_of_the_surface_texels_that_they_follow) {
  const SurfaceMap map = bake(geometry());
  std::vector<std::uint64_t> given, bits;
  std::uint64_t seed = 88172645463325252u;
  for (std::size_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    given.push_back(seed);
  }
  bits = given;
  spread_to_gutter(map, bits);
  for (int y = 0; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x) {
      const auto [slot, index] = texel_at(map, x, y);
      if (slot == kNoSlot) continue;
      bool expected = false;
      if (is_surface(map, x, y)) {
        expected = (given[slot] >> index) & 1u;
      } else if (packed_at(map, x, y) != kNoPosition) {
        // The bake may resolve ties in any way. Each of the nearest texels has the position of the
        // gutter texel.
        const auto position = map.position(slot, index);
        for (const TexelOffset o : kGutterRingOffsets) {
          const int ox = x + o.x, oy = y + o.y;
          if (!Oracle::inside(ox, oy) || !is_surface(map, ox, oy)) continue;
          const auto [owner_slot, owner] = texel_at(map, ox, oy);
          if (map.position(owner_slot, owner) != position) continue;
          expected = (given[owner_slot] >> owner) & 1u;
          break;
        }
      }
      ASSERT_EQ((bits[slot] >> index) & 1u, expected) << x << "," << y;
    }
}

// Returns two parallel squares of different sizes that cover the same texels.
Geometry overlapping_squares() {
  TriangleMesh mesh;
  Atlas atlas;
  for (const double size : {1.0, 2.0}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& p : {glm::dvec3(0, 0, size), glm::dvec3(size, 0, size),
                          glm::dvec3(size, size, size), glm::dvec3(0, size, size)})
      mesh.positions.push_back(p);
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
      mesh.triangles.push_back(first + k);
      atlas.corner_uvs.push_back(glm::vec2(0.25f) +
                                 0.5f * glm::vec2(mesh.positions[first + k]) / float(size));
    }
  }
  return build_geometry(mesh, atlas);
}

TEST(mesh_surface_map, gives_a_texel_with_several_owners_to_the_largest_face) {
  const Geometry geometry = overlapping_squares();
  const SurfaceMap map = bake(geometry);
  EXPECT_EQ(map.overlap_texels, 128u * 128u);
  EXPECT_EQ(map.surface_texels, 128u * 128u);
  const auto [slot, index] = texel_at(map, 100, 140);
  EXPECT_NEAR(map.position(slot, index).z + geometry.origin.z, 2, 1e-5);
  EXPECT_NEAR(area_sum(map), 5, 1e-4);
}

TEST(mesh_surface_map, of_a_flat_mesh_has_positions_in_its_plane) {
  const auto mesh = test::open_grid(8, 0);
  Atlas atlas;
  atlas.corner_uvs = mesh.corner_uvs;
  const SurfaceMap map = bake(build_geometry(mesh, atlas));
  const auto [slot, index] = texel_at(map, 128, 128);
  EXPECT_EQ(map.position(slot, index).z, 0);
}

TEST(mesh_surface_map, stops_when_cancelled) {
  Progress progress;
  progress.cancel();
  const auto map = bake_surface_map(overlapping_squares(), kResolution, progress);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::cancelled);
}

TEST(mesh_surface_map, refuses_resolutions_that_are_no_whole_tiles) {
  Progress progress;
  for (const int resolution : {0, 64, 200, 32768})
    EXPECT_FALSE(bake_surface_map(overlapping_squares(), resolution, progress)) << resolution;
}

TEST(mesh_surface_map, of_real_scans_credits_their_whole_area_at_every_resolution) {
  const std::filesystem::path data = STRATA_TEST_DATA;
  int found = 0;
  for (const char* name :
       {"statue_nefertiti_70k.ply", "mask_bali/mask.obj", "vessel_jug_seavase_35k.ply"}) {
    if (!std::filesystem::exists(data / name)) continue;
    ++found;
    Progress progress;
    const auto scan = load_mesh(data / name, name, progress);
    ASSERT_TRUE(scan) << scan.error().detail;
    const auto own_atlas = keep_uvs(scan->mesh, 2048, progress);
    const bool is_made = !own_atlas;
    const auto* const made = is_made ? &test::scan_with_made_atlas(name) : nullptr;
    ASSERT_TRUE(!is_made || made->has_value()) << made->error().detail;
    const Geometry geometry =
        build_geometry(scan->mesh, is_made ? made->value().atlas : *own_atlas);
    for (const int resolution : {2048, 4096}) {
      const SurfaceMap map = bake(geometry, resolution);
      EXPECT_NEAR(area_sum(map) / surface_area(scan->mesh), 1, 1e-5) << name;
      if (is_made) {
        EXPECT_EQ(map.overlap_texels, 0u) << name;
      }
    }
  }
  if (found == 0) GTEST_SKIP() << "no scans at " << data;
}

}  // namespace
}  // namespace strata::mesh
