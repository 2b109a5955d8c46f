#include "query/statistics/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <utility>

#include "mesh/texels/packed_position.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "query/statistics/surface_keys.h"

namespace strata::query {
namespace {

constexpr glm::dvec3 kOrigin{4'000'000.0, 500'000.0, 100.0};

// Returns an artificial map in which a share of the blocks exist. The blocks have surface, gutter
// and empty texels, with random areas and positions.
mesh::SurfaceMap make_map(int resolution, double share, unsigned seed) {
  std::mt19937 random(seed);
  mesh::SurfaceMap map;
  map.resolution = resolution;
  map.blocks_per_side = resolution / kBlockSize;
  const auto blocks = static_cast<std::uint32_t>(map.blocks_per_side * map.blocks_per_side);
  map.slot_of_block.assign(blocks, mesh::kNoSlot);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    if (random() % 1000 >= share * 1000) continue;
    map.slot_of_block[block] = static_cast<std::uint32_t>(map.block_of_slot.size());
    map.block_of_slot.push_back(block);
    std::uint64_t surface = 0;
    for (int i = 0; i < 64; ++i) {
      const auto kind = random() % 8;  // 0: neither, 1: gutter, otherwise surface
      if (kind >= 2) surface |= std::uint64_t{1} << i;
      const std::uint64_t q =
          (std::uint64_t{random()} << 32 | random()) & ~(std::uint64_t{1} << 63);
      map.packed_position.push_back(kind == 0 ? mesh::kNoPosition : q);
      map.area.push_back(kind >= 2 ? 0.5f + static_cast<float>(random() % 1000) / 1000.0f : 0.0f);
    }
    map.surface_mask.push_back(surface);
    map.packed_box.push_back(mesh::packed_box_of({-1, -2, -3}, {1, 2, 3}));
    map.sums_of_slot.push_back(map.sum_slot(map.slot_of_block[block]));
  }
  return map;
}

LayerView make_layer(ValueType type, const mesh::SurfaceMap& map, int distinct, unsigned seed,
                     bool everywhere = false) {
  std::mt19937 random(seed);
  LayerView view;
  view.layer.slug = "salt";
  view.layer.type = type;
  view.layer.resolution = map.resolution;
  for (int y = 0; y < map.resolution / kTileSize; ++y)
    for (int x = 0; x < map.resolution / kTileSize; ++x) {
      if (!everywhere && random() % 4 == 0) continue;
      auto tile = std::make_shared<TileData>(type);
      for (int i = 0; i < kTexelsPerTile; ++i) {
        if (!everywhere && random() % 3 == 0) continue;
        double value =
            double(random() % unsigned(distinct)) - (lowest_value(type) < 0 ? distinct / 2 : 0);
        if (is_float(type)) value /= 8;
        tile->write(i, *encode_value(type, value));
      }
      view.snapshot.tiles[{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}] = tile;
    }
  return view;
}

// Each block has one value, and its neighbors have other values. With `with_gaps`, some blocks are
// not finite, and some are only partly finite. Floats only.
LayerView make_layer_of_blocks(ValueType type, LayerKind kind, const mesh::SurfaceMap& map,
                               bool with_gaps = false) {
  LayerView view = make_layer(type, map, 1, 1, true);
  view.layer.kind = kind;
  const std::uint32_t not_a_number = std::bit_cast<std::uint32_t>(std::nanf(""));
  for (const auto& [address, tile] : view.snapshot.tiles) {
    auto changed = std::make_shared<TileData>(*tile);
    for (int i = 0; i < kTexelsPerTile; ++i) {
      const int bx = i % kTileSize / kBlockSize, by = i / kTileSize / kBlockSize;
      const int value = 1 + (bx + 3 * by) % 7;
      const bool gap = with_gaps && (value == 3 || (value == 5 && i % 3 == 0));
      changed->write(i, gap ? not_a_number : *encode_value(type, value));
    }
    view.snapshot.tiles[address] = changed;
  }
  return view;
}

struct Sample {
  double value, area;
  glm::dvec3 position;
};

// The oracle: reads every texel separately, through the accessors of the map and the tiles.
std::vector<Sample> samples(const LayerView& view, const mesh::SurfaceMap& map) {
  std::vector<Sample> all;
  for (const auto& [address, tile] : view.snapshot.tiles) {
    const TileMask surface = map.surface_in_tile(address);
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (!surface.test(i) || !tile->valid.test(i)) continue;
      const int bx = (address.x * kTileSize + i % kTileSize) / kBlockSize,
                by = (address.y * kTileSize + i / kTileSize) / kBlockSize;
      const auto slot = map.slot_of_block[std::size_t(by) * map.blocks_per_side + bx];
      const int in_block = i / kTileSize % kBlockSize * kBlockSize + i % kTileSize % kBlockSize;
      all.push_back({decode_value(view.layer.type, tile->bits(i)), map.area_of(address, i),
                     glm::dvec3(map.position(slot, in_block)) + kOrigin});
    }
  }
  return all;
}

void expect_keys_of_plain_sums(const LayerView& layer, const mesh::SurfaceMap& map) {
  const bool apart = tells_keys_apart(layer.layer);
  for (const auto& [address, tile] : layer.snapshot.tiles) {
    LayerView one = layer;
    one.snapshot.tiles = {{address, tile}};
    std::map<double, std::vector<Sample>> expected;
    for (const Sample& sample : samples(one, map))
      if (std::isfinite(sample.value)) expected[apart ? sample.value : 0].push_back(sample);
    const auto keys = surface_keys(*tile, address, layer.layer, map);
    ASSERT_EQ(keys.size(), expected.size());
    std::size_t i = 0;
    for (const auto& [value, texels] : expected) {
      const auto& key = keys[i++];
      if (apart) {
        EXPECT_EQ(key.bits, *encode_value(layer.layer.type, value));
      }
      EXPECT_EQ(key.texels, texels.size());
      double area = 0;
      glm::dvec3 weighted(0), low(1e300), high(-1e300);
      for (const Sample& sample : texels) {
        const glm::dvec3 position = sample.position - kOrigin;
        area += sample.area;
        weighted += sample.area * position;
        low = glm::min(low, position);
        high = glm::max(high, position);
      }
      EXPECT_NEAR(key.area.value(), area, 1e-9);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(key.weighted_position[axis], weighted[axis], 1e-5);
        EXPECT_NEAR(key.lowest[axis], low[axis], 1e-9);
        EXPECT_NEAR(key.highest[axis], high[axis], 1e-9);
      }
    }
  }
}

TEST(QueryStatistics, keys_of_a_tile_agree_with_a_plain_sum_over_every_texel) {
  const mesh::SurfaceMap map = make_map(256, 0.6, 5);
  // Few and many keys, the bit pattern 0, and layers whose values are not distinguished.
  for (const auto& [type, distinct, everywhere] : {std::tuple{ValueType::u8, 1, false},
                                                   {ValueType::u8, 1, true},
                                                   {ValueType::u8, 3, false},
                                                   {ValueType::u8, 200, true},
                                                   {ValueType::u16, 1, true},
                                                   {ValueType::f32, 1, true},
                                                   {ValueType::f32, 9, false}}) {
    SCOPED_TRACE(std::string(name(type)) + " with " + std::to_string(distinct) + " values" +
                 (everywhere ? " everywhere" : ""));
    const LayerView layer = make_layer(type, map, distinct, 12, everywhere);
    EXPECT_EQ(tells_keys_apart(layer.layer), type == ValueType::u8);
    expect_keys_of_plain_sums(layer, map);
  }
}

TEST(QueryStatistics, keys_of_blocks_with_one_value_agree_with_a_plain_sum) {
  const mesh::SurfaceMap map = make_map(256, 0.6, 6);
  for (const auto& [type, kind, with_gaps] : {std::tuple{ValueType::u8, LayerKind::numeric, false},
                                              {ValueType::i8, LayerKind::numeric, false},
                                              {ValueType::u16, LayerKind::database, false},
                                              {ValueType::u32, LayerKind::database, false},
                                              {ValueType::f32, LayerKind::numeric, false},
                                              {ValueType::f32, LayerKind::numeric, true}}) {
    SCOPED_TRACE(std::string(name(type)) + (with_gaps ? " with gaps" : ""));
    expect_keys_of_plain_sums(make_layer_of_blocks(type, kind, map, with_gaps), map);
  }
}

TEST(QueryStatistics, they_agree_with_a_plain_sum_over_every_texel) {
  const mesh::SurfaceMap map = make_map(512, 0.6, 3);
  for (const auto type : {ValueType::u8, ValueType::i8, ValueType::u16, ValueType::i16,
                          ValueType::u32, ValueType::i32, ValueType::f16, ValueType::f32}) {
    SCOPED_TRACE(name(type));
    const LayerView view = make_layer(type, map, 100, 11);
    const Statistics got = statistics(view, map, kOrigin, 0.01);
    const auto all = samples(view, map);
    double area = 0, mean = 0, squares = 0, low = 1e300, high = -1e300;
    for (const auto& s : all) {
      area += s.area;
      mean += s.area * s.value;
      low = std::min(low, s.value);
      high = std::max(high, s.value);
    }
    mean /= area;
    for (const auto& s : all) squares += s.area * (s.value - mean) * (s.value - mean);
    EXPECT_EQ(got.texels, all.size());
    EXPECT_NEAR(got.area_m2, area * 1e-4, area * 1e-13);
    EXPECT_EQ(got.min, low);
    EXPECT_EQ(got.max, high);
    EXPECT_NEAR(got.mean, mean, 1e-9);
    EXPECT_NEAR(got.std, std::sqrt(squares / area), 1e-9);
    double raw_squares = 0;
    for (const auto& s : all) raw_squares += s.area * s.value * s.value;
    EXPECT_NEAR(got.root_mean_square, std::sqrt(raw_squares / area), 1e-9);

    ASSERT_EQ(got.histogram.size(), 64u);
    EXPECT_EQ(got.histogram.front().from, low);
    EXPECT_EQ(got.histogram.back().to, high);
    double bin_area = 0;
    std::uint64_t bin_texels = 0;
    for (const auto& bin : got.histogram) {
      bin_area += bin.area_m2;
      bin_texels += bin.texels;
    }
    EXPECT_NEAR(bin_area, got.area_m2, 1e-9 * got.area_m2);
    EXPECT_EQ(bin_texels, got.texels);
    std::uint64_t first_bin = 0;
    for (const auto& s : all) first_bin += s.value < low + (high - low) / 64;
    EXPECT_EQ(got.histogram.front().texels, first_bin);

    if (is_float(type)) {
      EXPECT_TRUE(got.keys.empty());
      continue;
    }
    std::map<double, KeyStatistics> keys;
    for (const auto& s : all) {
      auto [it, fresh] = keys.try_emplace(s.value);
      auto& key = it->second;
      key.bounds_min = fresh ? s.position : glm::min(key.bounds_min, s.position);
      key.bounds_max = fresh ? s.position : glm::max(key.bounds_max, s.position);
      ++key.texels;
      key.area_m2 += s.area * 1e-4;
      key.centroid += s.area * 1e-4 * (s.position - kOrigin);
    }
    ASSERT_EQ(got.keys.size(), keys.size());
    for (const auto& [value, key] : keys) {
      ASSERT_TRUE(got.keys.contains(value));
      const auto& mine = got.keys.at(value);
      EXPECT_EQ(mine.texels, key.texels);
      EXPECT_NEAR(mine.area_m2, key.area_m2, 1e-9 * key.area_m2);
      EXPECT_LT(glm::distance(mine.centroid, key.centroid / key.area_m2 + kOrigin), 1e-6);
      EXPECT_LT(glm::distance(mine.bounds_min, key.bounds_min), 1e-9);
      EXPECT_LT(glm::distance(mine.bounds_max, key.bounds_max), 1e-9);
    }
  }
}

// Returns the expected quantiles of these samples, weighted by area, after sorting by value.
Quantiles quantiles_of(std::vector<Sample> all) {
  std::ranges::sort(all, {}, &Sample::value);
  double area = 0, sum = 0;
  for (const auto& s : all) area += s.area;
  Quantiles found{};
  std::size_t next = 0;
  for (const auto& s : all) {
    sum += s.area;
    while (next < found.size() && sum >= kQuantiles[next] * area) found[next++] = s.value;
  }
  return found;
}

TEST(QueryStatistics, the_mean_of_values_of_mixed_size_is_right_to_the_last_digit) {
  const mesh::SurfaceMap map = make_map(1024, 1.0, 3);
  std::mt19937 random(5);
  LayerView view = make_layer(ValueType::f32, map, 2, 1, true);
  for (auto& [address, tile] : view.snapshot.tiles) {
    auto mixed = std::make_shared<TileData>(ValueType::f32);
    for (int i = 0; i < kTexelsPerTile; ++i) {
      const float size = std::pow(10.0f, static_cast<float>(random() % 17) - 8);
      mixed->write(i, std::bit_cast<std::uint32_t>(random() % 2 ? size : -size));
    }
    tile = mixed;
  }
  // The products of these values and areas are integer multiples of 2^-76.
  __extension__ using Wide = __int128;
  Wide weighted = 0;
  double area = 0;
  for (const auto& sample : samples(view, map)) {
    weighted += static_cast<Wide>(std::ldexp(sample.value * sample.area, 76));
    area += sample.area;
  }
  const double mean = std::ldexp(static_cast<double>(weighted), -76) / area;
  EXPECT_DOUBLE_EQ(statistics(view, map, kOrigin, 1).mean, mean);
}

TEST(QueryStatistics, cells_of_a_layer_with_one_value_have_that_value_as_their_mean) {
  const auto map = std::make_shared<const mesh::SurfaceMap>(make_map(256, 1.0, 3));
  for (const double value : {66.0, 0.1, -1e-30, 3e38}) {
    LayerView view = make_layer(ValueType::f32, *map, 2, 1, true);
    auto tile = std::make_shared<TileData>(ValueType::f32);
    for (int i = 0; i < kTexelsPerTile; ++i)
      tile->write(i, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    for (auto& [address, each] : view.snapshot.tiles) each = tile;
    const auto cells = samples_by_cell({view, map, {}, kOrigin, 0.001}, 0.25);
    ASSERT_TRUE(cells.has_value());
    ASSERT_GT(cells->size(), 100u);
    for (const TexelSample& cell : *cells) ASSERT_EQ(cell.value, double{static_cast<float>(value)});
  }
}

TEST(QueryStatistics, quantiles_are_those_of_all_texels_in_order) {
  const mesh::SurfaceMap map = make_map(512, 0.6, 5);
  for (const auto type : {ValueType::u8, ValueType::i8, ValueType::u16, ValueType::i16,
                          ValueType::u32, ValueType::i32, ValueType::f16, ValueType::f32}) {
    for (const int distinct : {1, 2, 100, 60000}) {
      if (distinct > highest_value(type)) continue;
      SCOPED_TRACE(std::string(name(type)) + " of " + std::to_string(distinct));
      const LayerView view = make_layer(type, map, distinct, 12);
      const auto got = statistics(view, map, kOrigin, 0.01, {.quantiles = true});
      ASSERT_TRUE(got.quantiles);
      const Quantiles expected = quantiles_of(samples(view, map));
      // The terms are added in another order, so the next larger or smaller value is correct, too.
      const double step = is_float(type) ? 0.125 : 1.0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR((*got.quantiles)[i], expected[i], distinct > 1000 ? step : 0) << kQuantiles[i];
    }
  }
  LayerView empty;
  empty.layer.resolution = 512;
  EXPECT_FALSE(statistics(empty, map, kOrigin, 1, {.quantiles = true}).quantiles);
}

TEST(QueryStatistics, within_a_selection_only_its_texels_count) {
  const mesh::SurfaceMap map = make_map(512, 0.6, 7);
  const LayerView view = make_layer(ValueType::u8, map, 20, 3);
  std::mt19937_64 random(1);
  TexelSelection within;
  mesh::SurfaceMap smaller = map;  // for the oracle, unselected texels become gutter
  for (auto& surface : smaller.surface_mask) {
    within.push_back(random() & random());
    surface &= within.back();
  }
  TileSumsCache cache;
  statistics(view, map, kOrigin, 1, {.cache = &cache});
  const auto got =
      statistics(view, map, kOrigin, 1, {.within = &within, .quantiles = true, .cache = &cache});
  const auto expected = statistics(view, smaller, kOrigin, 1, {.quantiles = true});
  EXPECT_GT(got.texels, 1000u);
  EXPECT_EQ(got.texels, expected.texels);
  EXPECT_EQ(got.area_m2, expected.area_m2);
  EXPECT_EQ(got.mean, expected.mean);
  EXPECT_EQ(got.quantiles, expected.quantiles);
  EXPECT_EQ(got.keys.size(), expected.keys.size());
}

void expect_same(const Statistics& a, const Statistics& b) {
  EXPECT_EQ(a.texels, b.texels);
  EXPECT_EQ(a.area_m2, b.area_m2);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.std, b.std);
  ASSERT_EQ(a.histogram.size(), b.histogram.size());
  for (std::size_t i = 0; i < a.histogram.size(); ++i) {
    EXPECT_EQ(a.histogram[i].texels, b.histogram[i].texels);
    EXPECT_EQ(a.histogram[i].area_m2, b.histogram[i].area_m2);
  }
  ASSERT_EQ(a.keys.size(), b.keys.size());
  for (const auto& [value, key] : a.keys) {
    EXPECT_EQ(key.texels, b.keys.at(value).texels);
    EXPECT_EQ(key.area_m2, b.keys.at(value).area_m2);
    EXPECT_EQ(key.centroid, b.keys.at(value).centroid);
  }
}

TEST(QueryStatistics, tiles_that_stay_are_not_counted_again_and_the_sums_are_the_same) {
  const mesh::SurfaceMap map = make_map(512, 0.6, 9);
  for (const auto type : {ValueType::u8, ValueType::u16, ValueType::f32}) {
    for (const int distinct : {30, 60000}) {
      if (distinct > highest_value(type)) continue;
      TileSumsCache cache;
      LayerView view = make_layer(type, map, distinct, 13);
      std::mt19937 random(3);
      for (int stroke = 0; stroke < 6; ++stroke) {
        SCOPED_TRACE(std::string(name(type)) + ", stroke " + std::to_string(stroke));
        expect_same(statistics(view, map, kOrigin, 0.01, {.cache = &cache, .threads = 3}),
                    statistics(view, map, kOrigin, 0.01));
        auto tile = std::next(view.snapshot.tiles.begin(),
                              static_cast<long>(random() % view.snapshot.tiles.size()));
        auto changed = std::make_shared<TileData>(*tile->second);
        for (int i = 0; i < 500; ++i)
          changed->write(static_cast<int>(random() % kTexelsPerTile), random() & 0x3fu);
        tile->second = changed;
        if (stroke == 3) view.snapshot.tiles.erase(view.snapshot.tiles.begin());
      }
    }
  }
}

TEST(QueryStatistics, values_that_are_not_finite_do_not_count) {
  const mesh::SurfaceMap map = make_map(256, 1.0, 3);
  LayerView view = make_layer(ValueType::f32, map, 10, 1, true);
  const auto before = statistics(view, map, kOrigin, 1);
  auto& tile = view.snapshot.tiles.begin()->second;
  auto changed = std::make_shared<TileData>(*tile);
  for (int i = 0; i < kTexelsPerTile; ++i)
    changed->write(i, std::bit_cast<std::uint32_t>(INFINITY));
  tile = changed;
  const auto after = statistics(view, map, kOrigin, 1, {.quantiles = true});
  EXPECT_LT(after.texels, before.texels);
  EXPECT_TRUE(std::isfinite(after.mean));
}

TEST(CrossTable, agrees_with_a_count_of_every_texel) {
  const mesh::SurfaceMap map = make_map(512, 0.6, 21);
  LayerView units = make_layer(ValueType::u16, map, 7, 5),
            states = make_layer(ValueType::i8, map, 4, 6);
  std::mt19937_64 random(2);
  TexelSelection half;
  for (std::size_t slot = 0; slot < map.surface_mask.size(); ++slot) half.push_back(random());
  for (const TexelSelection* within :
       {static_cast<const TexelSelection*>(nullptr), &std::as_const(half)}) {
    const auto table = cross_tabulate(units, states, map, within, 0.01);
    ASSERT_TRUE(table);
    std::map<std::pair<CrossTable::Key, CrossTable::Key>, std::pair<std::uint64_t, double>>
        expected;
    double neither = 0;
    for (int y = 0; y < map.resolution; ++y)
      for (int x = 0; x < map.resolution; ++x) {
        const TileAddress address{static_cast<std::uint16_t>(x / kTileSize),
                                  static_cast<std::uint16_t>(y / kTileSize)};
        const auto slot = map.slot_of_block[std::size_t(y / 8) * std::size_t(map.blocks_per_side) +
                                            std::size_t(x / 8)];
        const int i = y % 8 * 8 + x % 8;
        if (slot == mesh::kNoSlot || !((map.surface_mask[slot] >> i) & 1)) continue;
        if (within && !(((*within)[slot] >> i) & 1)) continue;
        const auto key = [&](const LayerView& view) -> CrossTable::Key {
          const auto tile = view.snapshot.tiles.find(address);
          const int texel = y % kTileSize * kTileSize + x % kTileSize;
          if (tile == view.snapshot.tiles.end() || !tile->second->valid.test(texel))
            return std::nullopt;
          return decode_value(view.layer.type, tile->second->bits(texel));
        };
        const std::pair pair{key(units), key(states)};
        const double texel_area = double{map.area[std::size_t{slot} * 64 + std::size_t(i)]} * 1e-4;
        if (!pair.first && !pair.second) {
          neither += texel_area;
          continue;
        }
        auto& [texels, area] = expected[pair];
        ++texels;
        area += texel_area;
      }
    EXPECT_GT(neither, 0);
    EXPECT_NEAR(table->neither_m2, neither, 1e-9 * neither);
    EXPECT_EQ(table->rows.size(), 8u);
    EXPECT_EQ(table->columns.size(), 5u);
    EXPECT_EQ(table->rows.back(), std::nullopt);
    EXPECT_TRUE(std::is_sorted(table->columns.begin(), table->columns.end() - 1));
    std::size_t met = 0;
    for (std::size_t row = 0; row < table->rows.size(); ++row)
      for (std::size_t column = 0; column < table->columns.size(); ++column) {
        const auto [texels, area] = expected[{table->rows[row], table->columns[column]}];
        EXPECT_EQ(table->texels[row][column], texels);
        EXPECT_NEAR(table->area_m2[row][column], area, 1e-9 * area);
        met += texels > 0;
      }
    EXPECT_EQ(met, 39u) << "all pairs but that of nothing and nothing";
  }
}

TEST(CrossTable, takes_layers_of_other_resolutions_by_the_texel_at_the_place) {
  const mesh::SurfaceMap map = make_map(512, 1.0, 22);
  mesh::SurfaceMap coarse_map = map;
  coarse_map.resolution = 256;
  const LayerView fine = make_layer(ValueType::u8, map, 1, 5, true);
  LayerView coarse = make_layer(ValueType::u8, coarse_map, 2, 6, true);
  const auto table = cross_tabulate(fine, coarse, map, nullptr, 1);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows.size(), 1u);
  EXPECT_EQ(table->columns.size(), 2u);
  EXPECT_NEAR(table->area_m2[0][0] + table->area_m2[0][1],
              statistics(fine, map, kOrigin, 1).area_m2, 1e-6);
}

TEST(CrossTable, refuses_fractions_and_too_many_values) {
  const mesh::SurfaceMap map = make_map(256, 1.0, 3);
  const LayerView keys = make_layer(ValueType::u8, map, 3, 1),
                  fractions = make_layer(ValueType::f32, map, 3, 1),
                  many = make_layer(ValueType::u16, map, 60000, 1);
  EXPECT_EQ(cross_tabulate(keys, fractions, map, nullptr, 1).error().field, "columns");
  EXPECT_EQ(cross_tabulate(fractions, keys, map, nullptr, 1).error().field, "rows");
  EXPECT_EQ(cross_tabulate(many, keys, map, nullptr, 1).error().field, "rows");
}

TEST(QueryStatistics, gutter_texels_do_not_count) {
  mesh::SurfaceMap map = make_map(256, 1.0, 3);
  const LayerView view = make_layer(ValueType::u8, map, 3, 1, true);
  const auto before = statistics(view, map, kOrigin, 1);
  // The other seven rows of each block become gutter.
  for (auto& mask : map.surface_mask) mask &= 0xff;
  const auto after = statistics(view, map, kOrigin, 1);
  EXPECT_LT(after.texels, before.texels / 7);
  EXPECT_GT(after.texels, 0u);
}

TEST(QueryStatistics, an_empty_layer_has_none) {
  const mesh::SurfaceMap map = make_map(256, 1.0, 3);
  LayerView view;
  view.layer.resolution = 256;
  const auto got = statistics(view, map, kOrigin, 1);
  EXPECT_EQ(got.texels, 0u);
  EXPECT_EQ(got.area_m2, 0);
  EXPECT_TRUE(got.histogram.empty());
  EXPECT_TRUE(got.keys.empty());
}

TEST(QueryStatistics, a_constant_layer_has_one_bin_and_no_spread) {
  const mesh::SurfaceMap map = make_map(256, 1.0, 3);
  LayerView view = make_layer(ValueType::f32, map, 1, 1, true);
  for (auto& [address, tile] : view.snapshot.tiles) {
    auto same = std::make_shared<TileData>(ValueType::f32);
    for (int i = 0; i < kTexelsPerTile; ++i) same->write(i, *encode_value(ValueType::f32, 0.1));
    tile = same;
  }
  const auto got = statistics(view, map, kOrigin, 1);
  EXPECT_EQ(got.min, got.max);
  EXPECT_EQ(got.mean, got.min);
  EXPECT_EQ(got.std, 0);
  ASSERT_EQ(got.histogram.size(), 1u);
  EXPECT_DOUBLE_EQ(got.histogram[0].area_m2, got.area_m2);
}

TEST(QueryStatistics, a_layer_of_very_many_values_lists_no_keys) {
  const mesh::SurfaceMap map = make_map(512, 1.0, 3);
  for (const auto type : {ValueType::u16, ValueType::u32}) {
    EXPECT_EQ(statistics(make_layer(type, map, 4000, 2, true), map, kOrigin, 1).keys.size(), 4000u);
    EXPECT_TRUE(statistics(make_layer(type, map, 60000, 2, true), map, kOrigin, 1).keys.empty());
  }
}

TEST(QueryStatistics, areas_of_keys_are_those_of_the_statistics_however_many_keys_there_are) {
  const auto map = make_map(512, 0.8, 41);
  for (const auto type : {ValueType::u8, ValueType::u16, ValueType::u32}) {
    const auto few = make_layer(type, map, 200, 42);
    const auto expected = statistics(few, map, kOrigin, 0.1);
    const auto areas = key_areas(few, map, kOrigin, 0.1);
    ASSERT_EQ(areas.size(), expected.keys.size());
    for (const auto& [key, of_key] : expected.keys) {
      const auto& area = areas.at(static_cast<std::int64_t>(key));
      EXPECT_EQ(area.texels, of_key.texels);
      EXPECT_NEAR(area.area_m2, of_key.area_m2, 1e-9 * of_key.area_m2);
    }
  }
  const auto many = make_layer(ValueType::u32, map, 50'000, 43);
  const auto areas = key_areas(many, map, kOrigin, 0.1);
  EXPECT_GT(areas.size(), kMaxStatisticsKeys);
  std::uint64_t texels = 0;
  for (const auto& [key, area] : areas) texels += area.texels;
  EXPECT_EQ(texels, statistics(many, map, kOrigin, 0.1).texels);
}

TEST(QueryStatistics, a_map_of_another_resolution_is_a_mistake_of_the_program) {
  const mesh::SurfaceMap map = make_map(256, 1.0, 3);
  LayerView view;
  view.layer.resolution = 512;
  EXPECT_THROW(statistics(view, map, kOrigin, 1), std::invalid_argument);
}

TEST(QueryStatistics, a_full_layer_of_4096_is_counted_whole) {
  const mesh::SurfaceMap map = make_map(4096, 1.0, 3);
  const LayerView view = make_layer(ValueType::u8, map, 30, 1, true);
  EXPECT_GT(statistics(view, map, kOrigin, 1).texels, 12'000'000u);
}

}  // namespace
}  // namespace strata::query
