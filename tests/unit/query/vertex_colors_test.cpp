#include "query/sampling/vertex_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "query/sampling/vertex_ply.h"

namespace strata::query {
namespace {

// Returns four vertices at the corners of the unit square of texture coordinates, all with one scan
// color. Vertex 4 has the position of vertex 3.
std::shared_ptr<const mesh::Geometry> square() {
  auto geometry = std::make_shared<mesh::Geometry>();
  for (int i = 0; i < 5; ++i) {
    const float u = static_cast<float>(i & 1), v = static_cast<float>(i >> 1 & 1);
    mesh::Vertex vertex{};
    vertex.uv = i == 4 ? glm::vec2(0.5f, 0.5f) : glm::vec2(u, v);
    vertex.position_index = static_cast<std::uint32_t>(std::min(i, 3));
    vertex.color = 0xff204060u;  // red 0x60, green 0x40, blue 0x20
    geometry->vertices.push_back(vertex);
    if (i < 4) geometry->positions.emplace_back(u, v, 0);
  }
  geometry->indices = {0, 1, 3, 0, 3, 2};
  return geometry;
}

TileMap tiles_with(ValueType type, int x, int y, double value) {
  auto tile = std::make_shared<TileData>(type);
  tile->write(y % kTileSize * kTileSize + x % kTileSize, *encode_value(type, value));
  TileMap tiles;
  tiles[{static_cast<std::uint16_t>(x / kTileSize), static_cast<std::uint16_t>(y / kTileSize)}] =
      tile;
  return tiles;
}

DrawnLayer layer_at_origin(double value, Palette palette, double opacity = 1) {
  return {tiles_with(ValueType::u8, 0, 0, value), 256, ValueType::u8,
          std::make_shared<const Palette>(std::move(palette)), opacity};
}

Palette one_class(Rgba color, Pattern pattern = Pattern::solid) {
  Palette palette{PaletteMode::categorical, 0, 9, {{7, color}}, {}};
  palette.points.front().pattern = pattern;
  return palette;
}

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kScan{0x60, 0x40, 0x20};

Rgb at(const VertexColors& colors, std::vector<std::uint32_t> vertices) {
  return colors.at(vertices);
}

// A second implementation of the compositing of images: each color covers the content below it by
// opacity times alpha.
Rgb composed(glm::dvec3 below, const std::vector<std::pair<Rgba, double>>& inks) {
  for (const auto& [ink, opacity] : inks) {
    const double cover = opacity * ink[3] / 255;
    for (int i = 0; i < 3; ++i) below[i] += (ink[i] - below[i]) * cover;
  }
  const auto rounded = [](double v) { return static_cast<std::uint8_t>(std::lround(v)); };
  return {rounded(below.x), rounded(below.y), rounded(below.z)};
}

TEST(VertexColors, without_photos_and_layers_they_are_those_of_the_scan) {
  EXPECT_EQ(at(VertexColors(square()), {0}), kScan);
  EXPECT_EQ(at(VertexColors(square()), {}), (Rgb{0, 0, 0}));
}

TEST(VertexColors, layers_cover_each_other_by_opacity_and_alpha_from_bottom_to_top) {
  const Rgba red{255, 0, 0, 128}, blue{0, 0, 255, 255};
  VertexColors colors(square());
  colors.add_layer(layer_at_origin(7, one_class(red)));
  colors.add_layer(layer_at_origin(7, one_class(blue), 0.25));
  EXPECT_EQ(at(colors, {0}), composed({0x60, 0x40, 0x20}, {{red, 1}, {blue, 0.25}}));
  EXPECT_EQ(at(colors, {1}), kScan) << "nothing is painted there";
  VertexColors turned(square());
  turned.add_layer(layer_at_origin(7, one_class(blue), 0.25));
  turned.add_layer(layer_at_origin(7, one_class(red)));
  EXPECT_EQ(at(turned, {0}), composed({0x60, 0x40, 0x20}, {{blue, 0.25}, {red, 1}}));
}

TEST(VertexColors, layers_filter_or_lighten_what_is_below) {
  for (const auto& [blend, expected] : {std::pair{LayerBlend::multiply, Rgb{0x60, 0x20, 0x10}},
                                        std::pair{LayerBlend::screen, Rgb{0xff, 0x90, 0x60}}}) {
    VertexColors colors(square());
    auto layer = layer_at_origin(7, one_class({255, 0, 0, 255}));
    layer.palette = std::make_shared<const Palette>(one_class(
        blend == LayerBlend::multiply ? Rgba{255, 0x80, 0x80, 255} : Rgba{255, 0x6b, 0x49, 255}));
    layer.blend = blend;
    colors.add_layer(std::move(layer));
    const Rgb got = at(colors, {0});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 1) << int(c);
  }
}

TEST(VertexColors, values_have_the_colours_of_every_kind_of_palette) {
  Palette linear{PaletteMode::linear, 0, 10, {{0, {0, 0, 0, 255}}, {10, {200, 100, 50, 255}}}, {}};
  VertexColors ramp(square());
  ramp.add_layer(layer_at_origin(5, linear));
  EXPECT_EQ(at(ramp, {0}), (Rgb{100, 50, 25}));
  VertexColors unlisted(square());
  unlisted.add_layer(layer_at_origin(3, one_class({1, 2, 3, 255})));
  const Rgba made = generated_color(3);
  EXPECT_EQ(at(unlisted, {0}), (Rgb{made[0], made[1], made[2]}));
}

TEST(VertexColors, hatch_is_the_full_colour_of_its_class_and_an_outline_colours_nothing) {
  for (const Pattern pattern : {Pattern::hatch, Pattern::dots}) {
    VertexColors colors(square());
    colors.add_layer(layer_at_origin(7, one_class({9, 8, 7, 255}, pattern)));
    EXPECT_EQ(at(colors, {0}), (Rgb{9, 8, 7}));
  }
  VertexColors outlined(square());
  outlined.add_layer(layer_at_origin(7, one_class({9, 8, 7, 255}, Pattern::outline)));
  EXPECT_EQ(at(outlined, {0}), kScan);
}

TEST(VertexColors, a_place_on_a_seam_has_the_first_valid_texel_of_its_vertices) {
  VertexColors colors(square());
  colors.add_layer({tiles_with(ValueType::u8, 128, 128, 7), 256, ValueType::u8,
                    std::make_shared<const Palette>(one_class({10, 20, 30, 255})), 1});
  EXPECT_EQ(at(colors, {3}), kScan);
  EXPECT_EQ(at(colors, {3, 4}), (Rgb{10, 20, 30}));
}

TEST(VertexColors, photos_lie_below_the_layers_by_their_opacity_and_alpha) {
  // An image of 2 × 2 pixels. The lower left pixel belongs to vertex 0, the upper right one to
  // vertex 3.
  const Picture photo{2, 2, {0, 0, 0, 255, 200, 100, 0, 255, 255, 255, 255, 255, 0, 0, 0, 0}};
  VertexColors colors(square());
  colors.add_photo(photo, 0.5);
  EXPECT_EQ(at(colors, {0}), composed({0x60, 0x40, 0x20}, {{{255, 255, 255, 255}, 0.5}}));
  EXPECT_EQ(at(colors, {1}), kScan) << "clear there";
  EXPECT_EQ(at(colors, {3}), composed({0x60, 0x40, 0x20}, {{{200, 100, 0, 255}, 0.5}}));
  colors.add_layer(layer_at_origin(7, one_class({0, 0, 0, 255})));
  EXPECT_EQ(at(colors, {0}), (Rgb{0, 0, 0}));
}

TEST(VertexPly, colours_of_layers_take_the_place_of_the_scans) {
  VertexColors colors(square());
  colors.add_layer(layer_at_origin(7, one_class({10, 20, 30, 255})));
  const VertexPly plain(square(), {}), colored(square(), {}, std::move(colors));
  EXPECT_EQ(colored.bytes() - plain.bytes(),
            4 * 3 + std::strlen("property uchar red\nproperty uchar green\nproperty uchar blue\n"));
  std::string file;
  ASSERT_TRUE(colored.write([&](std::span<const std::uint8_t> piece) {
    file.append(piece.begin(), piece.end());
    return true;
  }));
  ASSERT_EQ(file.size(), colored.bytes());
  const std::size_t first =
      file.find("end_header\n") + std::strlen("end_header\n") + 3 * sizeof(float);
  EXPECT_EQ(file.substr(first, 3), "\x0a\x14\x1e");
  EXPECT_EQ(file.substr(first + 3 * sizeof(float) + 3, 3), "\x60\x40\x20");
}

}  // namespace
}  // namespace strata::query
