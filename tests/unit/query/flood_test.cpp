// Connectivity across the surface, including the seams of the atlas.
#include "query/conditions/flood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "mesh/atlas/atlas.h"
#include "mesh/demo/demo_pot.h"
#include "mesh/surface/connectivity.h"
#include "mesh/surface/face_neighbours.h"
#include "mesh/surface/uv_islands.h"
#include "mesh/texels/texel_owners.h"
#include "query/conditions/tile_table.h"
#include "query/statistics/pieces.h"
#include "query/statistics/quantities.h"
#include "query/statistics/statistics.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::query {
namespace {

using test::for_each_surface_texel;
using test::layer_of;
using test::Surface;
using test::surface_of;

constexpr int kResolution = 512;

std::uint64_t count(const TexelSelection& selection) {
  std::uint64_t texels = 0;
  for (const std::uint64_t word : selection) texels += std::popcount(word);
  return texels;
}

bool is_in(const TexelSelection& selection, std::uint32_t texel) {
  return (selection[texel / 64] >> (texel % 64)) & 1u;
}

// Returns the piece of the mesh for each triangle. Triangles that share an edge or an island of the
// atlas belong to the same piece.
std::vector<std::uint32_t> pieces_of_triangles(const mesh::Geometry& geometry) {
  std::vector<std::uint32_t> parent(geometry.triangle_count());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  const auto neighbours = mesh::face_neighbours(mesh::surface_connectivity(geometry));
  for (std::size_t c = 0; c < neighbours.size(); ++c)
    if (neighbours[c] != mesh::kNoTriangle)
      parent[root(static_cast<std::uint32_t>(c / 3))] = root(neighbours[c]);
  const auto islands = mesh::find_islands(geometry.indices, geometry.vertices.size());
  std::map<std::uint32_t, std::uint32_t> first;
  for (std::uint32_t t = 0; t < parent.size(); ++t) {
    const auto [found, fresh] = first.try_emplace(islands.of_triangle[t], t);
    if (!fresh) parent[root(t)] = root(found->second);
  }
  std::vector<std::uint32_t> pieces;
  for (std::uint32_t t = 0; t < parent.size(); ++t) pieces.push_back(root(t));
  return pieces;
}

TEST(Flood, the_pieces_of_the_texels_are_the_pieces_of_the_mesh) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const Surface surface = surface_of(name, mesh, kResolution);
    Progress progress;
    const auto owners = mesh::bake_texel_owners(surface.geometry, kResolution, progress);
    const auto pieces = pieces_of_triangles(surface.geometry);
    std::map<std::uint32_t, std::uint64_t> texels;       // per piece of the mesh
    std::map<std::uint32_t, std::uint32_t> first_texel;  // first texel of each piece
    for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      const std::uint32_t piece = pieces[owners->triangle[texel]];
      ++texels[piece];
      first_texel.try_emplace(piece, texel);
    });
    std::uint64_t wrong = 0;
    int floods = 0;
    for (const auto& [piece, start] : first_texel) {
      if (++floods > 40) break;  // some meshes have only separate triangles
      const auto selection = select_piece(surface.map, surface.graph, start);
      for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
        wrong += is_in(selection, texel) != (pieces[owners->triangle[texel]] == piece);
      });
    }
    EXPECT_EQ(wrong, 0u);
  }
}

TEST(Flood, neighbours_are_mutual) {
  const Surface surface = surface_of("torus", test::torus(24), kResolution);
  ASSERT_FALSE(surface.graph.links.empty());
  for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    mesh::for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t neighbour) {
      bool back = false;
      mesh::for_each_neighbour(surface.map, surface.graph, neighbour,
                               [&](std::uint32_t each) { back = back || each == texel; });
      ASSERT_TRUE(back) << texel << " " << neighbour;
    });
  });
}

TEST(Flood, neighbours_are_near_each_other_on_the_surface) {
  // The width of the triangles at the poles ranges from a few texels to less than one texel.
  for (const int segments : {24, 48, 96, 160}) {
    SCOPED_TRACE(segments);
    const Surface surface = surface_of("sphere", test::sphere(segments), kResolution);
    float farthest = 0;
    const auto place = [&](std::uint32_t texel) {
      return surface.map.position(texel / 64, static_cast<int>(texel % 64));
    };
    for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      mesh::for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t neighbour) {
        farthest = std::max(farthest, glm::distance(place(texel), place(neighbour)));
      });
    });
    const double texel_size =
        std::sqrt(surface.map.area_total / static_cast<double>(surface.map.surface_texels));
    EXPECT_LT(farthest, 5 * texel_size);
  }
}

void expect_connected(const Surface& surface, const std::function<int(glm::vec3)>& value_at,
                      const std::function<bool(glm::vec3)>& expected) {
  SCOPED_TRACE(surface.name);
  const mesh::SurfaceMap& map = surface.map;
  const TileMap tiles = layer_of(map, value_at);
  const auto islands =
      mesh::find_islands(surface.geometry.indices, surface.geometry.vertices.size());
  Progress progress;
  const auto owners = mesh::bake_texel_owners(surface.geometry, map.resolution, progress);
  std::set<std::uint32_t> crossed;
  std::optional<std::uint32_t> start;
  std::uint64_t texels_expected = 0;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    if (!expected(map.position(texel / 64, static_cast<int>(texel % 64)))) return;
    if (texels_expected++ % 997 == 500) start = texel;
    crossed.insert(islands.of_triangle[owners->triangle[texel]]);
  });
  ASSERT_TRUE(start);
  ASSERT_GT(crossed.size(), 1u) << "the region crosses no seam";
  const auto selection = select_connected(map, surface.graph, tiles, *start);
  std::uint64_t outside = 0, inside = 0;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    if (!is_in(selection, texel)) return;
    ++(expected(map.position(texel / 64, static_cast<int>(texel % 64))) ? inside : outside);
  });
  EXPECT_EQ(outside, 0u);
  // A texel at the region's border may be connected only at a corner.
  EXPECT_GE(inside, texels_expected - texels_expected / 1000);
}

TEST(Flood, the_same_value_is_followed_across_seams_and_not_across_other_values) {
  const auto caps = [](glm::vec3 p) { return p.z > 0.4f || p.z < -0.4f ? 7 : 3; };
  const Surface sphere = surface_of("sphere", test::sphere(64), 1024);
  expect_connected(sphere, caps, [](glm::vec3 p) { return p.z > 0.4f; });
  expect_connected(sphere, caps, [](glm::vec3 p) { return std::abs(p.z) <= 0.4f; });
}

TEST(Flood, from_where_nothing_is_what_holds_nothing_is_connected) {
  const Surface torus = surface_of("torus", test::torus(40), 1024);
  // Two rings of the torus are painted at x = 0. They divide the remaining unpainted area into two
  // parts.
  const auto rings = [](glm::vec3 p) { return std::abs(p.x) < 0.06f ? 1 : 0; };
  expect_connected(torus, rings, [](glm::vec3 p) { return p.x >= 0.06f; });
}

TEST(Flood, the_pieces_that_are_counted_are_those_that_a_flood_finds) {
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const Surface surface = surface_of(name, mesh, kResolution);
    const mesh::SurfaceMap& map = surface.map;
    const glm::vec3 size = surface.geometry.box_max - surface.geometry.box_min;
    const float cell = std::max({size.x, size.y, size.z}) / 3;
    // The cells have three values, and one in four cells is unpainted.
    LayerView view;
    view.layer.type = ValueType::u8;
    view.layer.resolution = map.resolution;
    view.snapshot.tiles = layer_of(map, [&](glm::vec3 p) {
      const glm::ivec3 at(glm::floor((p - surface.geometry.box_min) / cell));
      return (at.x + 2 * at.y + 3 * at.z) & 3;
    });
    const TileTable table(view.snapshot.tiles, map.resolution);
    std::map<std::uint32_t, std::uint64_t> expected;
    TexelSelection seen(map.block_of_slot.size(), 0);
    std::uint64_t floods = 0;
    for_each_surface_texel(map, [&](std::uint32_t texel) {
      if (is_in(seen, texel) || floods > 300) return;
      const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
                 i = static_cast<int>(texel % 64);
      const int x = block % map.blocks_per_side * 8 + i % 8,
                y = block / map.blocks_per_side * 8 + i / 8;
      const TileData* tile = table.of_texel(x, y);
      const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
      if (tile == nullptr || !tile->valid.test(in_tile)) return;
      ++floods;
      ++expected[tile->bits(in_tile)];
      const auto piece = select_connected(map, surface.graph, view.snapshot.tiles, texel);
      for (std::size_t slot = 0; slot < seen.size(); ++slot) seen[slot] |= piece[slot];
    });
    if (floods > 300) continue;  // some meshes have only separate triangles
    const PieceCounts counts = count_pieces(view, map, surface.graph, nullptr, {.each = true});
    EXPECT_EQ(counts.of_class, expected);
    EXPECT_EQ(counts.all, floods);
    const auto statistics =
        query::statistics(view, map, glm::dvec3(0), 1, {.pieces = true, .graph = &surface.graph});
    EXPECT_EQ(statistics.pieces, floods);
    for (const auto& [bits, pieces] : expected) EXPECT_EQ(statistics.keys.at(bits).pieces, pieces);
  }
}

// The classes of the legend are single values or ranges. The expected areas are plain sums over
// texels. The expected pieces come from floods on a layer of the class numbers.
TEST(Quantities, are_those_of_a_sum_over_every_texel_and_of_floods) {
  const Surface surface = surface_of("torus", test::torus(40), kResolution);
  const mesh::SurfaceMap& map = surface.map;
  const double metres = 0.01;
  for (const auto mode : {PaletteMode::categorical, PaletteMode::step, PaletteMode::linear})
    for (const auto type : {ValueType::i8, ValueType::u16, ValueType::f16, ValueType::f32}) {
      SCOPED_TRACE(std::string(name(type)) + " " + std::to_string(static_cast<int>(mode)));
      LayerView view, classes;
      view.layer.type = type;
      view.layer.palette.mode = mode;
      view.layer.palette.points = {{2, {}, {}}, {4, {}, {}}, {6, {}, {}}};
      classes.layer.type = ValueType::u8;
      view.layer.resolution = classes.layer.resolution = kResolution;
      const double step = is_float(type) && mode != PaletteMode::categorical ? 0.5 : 1;
      std::map<int, Quantity> expected;
      double total = 0;
      std::map<TileAddress, std::shared_ptr<TileData>> values, numbers;
      for_each_surface_texel(map, [&](std::uint32_t texel) {
        const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
                   i = static_cast<int>(texel % 64);
        const int x = block % map.blocks_per_side * 8 + i % 8,
                  y = block / map.blocks_per_side * 8 + i / 8;
        total += map.area[texel];
        const glm::ivec3 cell(glm::floor(map.position(texel / 64, i) * 3.0f));
        const int number = ((cell.x * 5 + cell.y * 3 + cell.z * 7) % 9 + 9) % 9;
        if (number == 8) return;
        const double value = number * step;
        int of = number;
        if (mode == PaletteMode::step) of = value < 2 ? 0 : value < 4 ? 1 : value < 6 ? 2 : 3;
        if (mode == PaletteMode::linear) of = value < 2 ? 0 : value < 4 ? 1 : value <= 6 ? 2 : 3;
        const TileAddress address{static_cast<std::uint16_t>(x / kTileSize),
                                  static_cast<std::uint16_t>(y / kTileSize)};
        const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
        for (auto* tiles : {&values, &numbers}) {
          auto& tile = (*tiles)[address];
          if (!tile) tile = std::make_shared<TileData>(tiles == &values ? type : ValueType::u8);
          tile->write(in_tile, *encode_value(tiles == &values ? type : ValueType::u8,
                                             tiles == &values ? value : of));
        }
        ++expected[of].texels;
        expected[of].area_m2 += map.area[texel] * metres * metres;
      });
      view.snapshot.tiles.insert(values.begin(), values.end());
      classes.snapshot.tiles.insert(numbers.begin(), numbers.end());
      TexelSelection seen(map.block_of_slot.size(), 0);
      const TileTable table(classes.snapshot.tiles, kResolution);
      for_each_surface_texel(map, [&](std::uint32_t texel) {
        if (is_in(seen, texel)) return;
        const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
                   i = static_cast<int>(texel % 64);
        const int x = block % map.blocks_per_side * 8 + i % 8,
                  y = block / map.blocks_per_side * 8 + i / 8;
        const TileData* tile = table.of_texel(x, y);
        const int in_tile = y % kTileSize * kTileSize + x % kTileSize;
        if (tile == nullptr || !tile->valid.test(in_tile)) return;
        ++expected[static_cast<int>(tile->bits(in_tile))].pieces;
        const auto piece = select_connected(map, surface.graph, classes.snapshot.tiles, texel);
        for (std::size_t slot = 0; slot < seen.size(); ++slot) seen[slot] |= piece[slot];
      });

      const auto got = quantities(view, map, surface.graph, classes_of(view.layer), metres);
      ASSERT_TRUE(got);
      ASSERT_EQ(got->classes.size(), expected.size());
      EXPECT_NEAR(got->surface_m2, total * metres * metres, 1e-6 * got->surface_m2);
      Quantity sum;
      auto entry = got->classes.begin();
      for (const auto& [of, quantity] : expected) {
        EXPECT_EQ(entry->texels, quantity.texels) << of;
        EXPECT_NEAR(entry->area_m2, quantity.area_m2, 1e-9 * quantity.area_m2) << of;
        EXPECT_EQ(entry->pieces, quantity.pieces) << of;
        if (mode == PaletteMode::categorical) {
          EXPECT_EQ(entry->value, of);
        } else {
          EXPECT_EQ(entry->value, std::nullopt);
          EXPECT_EQ(entry->from, of == 0 ? std::nullopt : std::optional(2.0 * of));
          EXPECT_EQ(entry->to, of == 3 ? std::nullopt : std::optional(2.0 * of + 2));
        }
        sum.texels += quantity.texels;
        sum.pieces += quantity.pieces;
        ++entry;
      }
      EXPECT_EQ(got->sum.texels, sum.texels);
      EXPECT_EQ(got->sum.pieces, sum.pieces);
    }
}

TEST(Flood, a_pot_is_one_piece_though_its_atlas_has_many) {
  const Surface pot = surface_of("pot", mesh::make_demo_pot(0.5), 2048);
  std::uint32_t start = 0;
  for_each_surface_texel(pot.map, [&](std::uint32_t texel) { start = texel; });
  EXPECT_EQ(count(select_piece(pot.map, pot.graph, start)), pot.map.surface_texels);
  // The graph must use much less memory than the map.
  EXPECT_LT(pot.graph.bytes(), pot.map.bytes() / 8);
}

TEST(Flood, is_the_same_on_any_number_of_threads_and_stops_when_cancelled) {
  const Surface surface = surface_of("sphere", test::sphere(32), kResolution);
  Progress progress;
  const auto again = mesh::build_texel_graph(surface.geometry, surface.map, progress, 5);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->links, surface.graph.links);
  EXPECT_EQ(again->to_right, surface.graph.to_right);
  EXPECT_EQ(again->to_upper, surface.graph.to_upper);
  progress.cancel();
  EXPECT_EQ(mesh::build_texel_graph(surface.geometry, surface.map, progress).error().code,
            ErrorCode::cancelled);
}

TEST(Flood, a_texture_coordinate_finds_its_texel_also_from_the_gutter) {
  const Surface surface = surface_of("sphere", test::sphere(32), kResolution);
  const mesh::SurfaceMap& map = surface.map;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
               i = static_cast<int>(texel % 64);
    const glm::vec2 centre(block % map.blocks_per_side * 8 + i % 8 + 0.5f,
                           block / map.blocks_per_side * 8 + i / 8 + 0.5f);
    ASSERT_EQ(mesh::surface_texel_at(map, centre / float(map.resolution)), texel);
  });
  for (const auto& vertex : surface.geometry.vertices)
    EXPECT_TRUE(mesh::surface_texel_at(map, vertex.uv));
  const auto empty = std::find(map.slot_of_block.begin(), map.slot_of_block.end(), mesh::kNoSlot);
  ASSERT_NE(empty, map.slot_of_block.end());
  const auto block = static_cast<int>(empty - map.slot_of_block.begin());
  const glm::vec2 middle(block % map.blocks_per_side * 8 + 4, block / map.blocks_per_side * 8 + 4);
  EXPECT_FALSE(mesh::surface_texel_at(map, middle / float(map.resolution)));
}

}  // namespace
}  // namespace strata::query
