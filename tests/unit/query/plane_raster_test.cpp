#include "query/maps/plane_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/surface/geometry.h"
#include "query/maps/geotiff.h"
#include "query/maps/map_tiff.h"

namespace strata::query {
namespace {

constexpr glm::dvec3 kOrigin{4'000'000.0, 500'000.0, 100.0};
constexpr int kResolution = 64;

// Two squares of 2 × 2 around the origin, parallel to x and y, at the heights 0 and 1. The lower
// one has the left half of the atlas, the upper one the right half and only the positive x.
std::shared_ptr<const mesh::Geometry> two_floors() {
  auto geometry = std::make_shared<mesh::Geometry>();
  geometry->origin = kOrigin;
  for (int floor = 0; floor < 2; ++floor)
    for (int i = 0; i < 4; ++i) {
      const float u = static_cast<float>(i & 1), v = static_cast<float>(i >> 1);
      mesh::Vertex vertex{};
      vertex.position = {floor == 0 ? 2 * u - 1 : u, 2 * v - 1, floor};
      vertex.uv = {(u + static_cast<float>(floor)) / 2, v};
      vertex.position_index = static_cast<std::uint32_t>(4 * floor + i);
      geometry->vertices.push_back(vertex);
      geometry->positions.push_back(glm::dvec3(vertex.position) + kOrigin);
    }
  geometry->indices = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6};
  geometry->box_min = {-1, -1, 0};
  geometry->box_max = {1, 1, 1};
  return geometry;
}

// The value of each texel is its column and row; texels of the row 0 are not painted.
LayerView painted(ValueType type) {
  LayerView view;
  view.layer.type = type;
  view.layer.resolution = kResolution;
  auto tile = std::make_shared<TileData>(type);
  for (int y = 1; y < kResolution; ++y)
    for (int x = 0; x < kResolution; ++x)
      tile->write(y * kTileSize + x, *encode_value(type, 100 * y + x));
  view.snapshot.tiles[{0, 0}] = tile;
  return view;
}

class PlaneRasters : public testing::Test {
 protected:
  std::shared_ptr<const mesh::Geometry> geometry_ = two_floors();
  mesh::SearchTree tree_{geometry_};

  PlaneView view(const OutlinePlane& plane, bool looks_up) const {
    return {tree_, kOrigin, plane, looks_up, kOrigin + glm::dvec3(-1, -1, 0), kOrigin + 1.0};
  }
  static PlaneGrid grid(int width, int height) {
    return {glm::dvec2(kOrigin) - 1.0, glm::dvec2(kOrigin) + 1.0, width, height};
  }
};

TEST_F(PlaneRasters, cells_have_the_values_of_the_surface_that_is_seen_first) {
  const LayerView layer = painted(ValueType::u16);
  for (const bool from_below : {false, true}) {
    const auto rasters =
        resample(view({}, from_below), std::span(&layer, 1), grid(2 * kResolution, kResolution));
    ASSERT_EQ(rasters.size(), 1u);
    const PlaneRaster& raster = rasters[0];
    for (int row = 0; row < raster.height; ++row)
      for (int column = 0; column < raster.width; ++column) {
        // By the definition of the two squares. The row 0 of the raster has the largest y.
        const double x = -1 + 2 * (column + 0.5) / raster.width,
                     y = 1 - 2 * (row + 0.5) / raster.height;
        const bool upper = !from_below && x > 0;
        const double u = upper ? (x + 1) / 2 : (x + 1) / 4, v = (y + 1) / 2;
        const int texel_x = static_cast<int>(u * kResolution), texel_y = int(v * kResolution);
        const auto cell = static_cast<std::size_t>(row * raster.width + column);
        ASSERT_EQ(raster.valid[cell] != 0, texel_y > 0) << x << " " << y;
        if (texel_y > 0) {
          ASSERT_EQ(raster.bits[cell], 100u * texel_y + texel_x) << x << " " << y;
        }
      }
  }
}

TEST_F(PlaneRasters, places_outside_the_model_or_the_area_are_empty) {
  const LayerView layer = painted(ValueType::u16);
  PlaneGrid outside = grid(8, 8);
  outside.low += 10.0;
  outside.high += 10.0;
  const auto none = resample(view({}, false), std::span(&layer, 1), outside);
  EXPECT_EQ(std::ranges::count(none[0].valid, 1), 0);
  PlaneGrid edge_on{{kOrigin.x - 1, kOrigin.z - 0.1}, {kOrigin.x + 1, kOrigin.z + 1.1}, 9, 7};
  const auto from_side = resample(view({0, 2, 1}, true), std::span(&layer, 1), edge_on);
  EXPECT_EQ(std::ranges::count(from_side[0].valid, 1), 0) << "the floors are seen edge-on";
  int inside = 0;
  const auto rasters = resample(view({}, false), std::span(&layer, 1), grid(16, 16),
                                [](const glm::dvec2& place) { return place.x < kOrigin.x; });
  for (int cell = 0; cell < 16 * 16; ++cell) {
    const bool is_valid = rasters[0].valid[static_cast<std::size_t>(cell)] != 0;
    inside += is_valid;
    EXPECT_FALSE(is_valid && cell % 16 >= 8);
  }
  EXPECT_GT(inside, 8 * 14);
}

// Reads the file as the server reads maps, which is tested with files of GDAL.
TEST_F(PlaneRasters, a_geotiff_comes_back) {
  for (const ValueType type : {ValueType::u16, ValueType::i32, ValueType::f16, ValueType::f32}) {
    const LayerView layer = painted(type);
    const auto raster = resample(view({}, false), std::span(&layer, 1), grid(300, 270))[0];
    GeoReference reference{{400'000.25, 5'000'010.5}, {0.25, 0.5}, 25833, "x and y", "A & B", "%"};
    const auto file = encode_geotiff(raster, reference);
    ASSERT_TRUE(file) << file.error().detail;
    const auto info = inspect_tiff(*file, 16'384);
    ASSERT_TRUE(info) << info.error().detail;
    EXPECT_EQ(info->crs, "EPSG:25833");
    EXPECT_EQ(info->type, type == ValueType::f16 ? ValueType::f32 : type);
    ASSERT_TRUE(info->world);
    EXPECT_DOUBLE_EQ(info->world->x, 400'000.375) << "the center of the first cell";
    EXPECT_DOUBLE_EQ(info->world->y, 5'000'010.25);
    EXPECT_DOUBLE_EQ(info->world->y_per_row, -0.5);
    const auto band = decode_tiff_band(*file, *info, 1);
    ASSERT_TRUE(band) << band.error().detail;
    ASSERT_EQ(band->bits.size(), raster.bits.size());
    for (std::size_t cell = 0; cell < raster.bits.size(); ++cell) {
      ASSERT_EQ(band->valid[cell], raster.valid[cell]) << cell;
      if (raster.valid[cell]) {
        ASSERT_EQ(decode_value(band->type, band->bits[cell]),
                  decode_value(raster.type, raster.bits[cell]));
      }
    }
  }
}

TEST(GeoTiff, empty_cells_have_a_number_that_no_cell_has) {
  PlaneRaster raster{257, 1, ValueType::u8, std::vector<std::uint32_t>(257),
                     std::vector<std::uint8_t>(257, 1)};
  raster.valid[256] = 0;
  for (std::uint32_t i = 0; i < 256; ++i) raster.bits[i] = i;
  const GeoReference local{{0, 1}, {1, 1}, 0, "Wall: x | z", "Keys", ""};
  const auto whole = encode_geotiff(raster, local);
  ASSERT_TRUE(whole);
  auto info = inspect_tiff(*whole, 1000);
  ASSERT_TRUE(info) << info.error().detail;
  EXPECT_EQ(info->type, ValueType::u16) << "all numbers of 8 bits occur";
  EXPECT_EQ(info->nodata, 65'535.0);
  EXPECT_EQ(info->crs, "");
  raster.bits[0] = 7;
  const auto partial = encode_geotiff(raster, local);
  ASSERT_TRUE(partial);
  info = inspect_tiff(*partial, 1000);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->type, ValueType::u8);
  EXPECT_EQ(info->nodata, 0.0);
}

}  // namespace
}  // namespace strata::query
