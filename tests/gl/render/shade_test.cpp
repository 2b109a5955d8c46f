#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "support/color_difference.h"
#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kSize = 256;

// A flat square that fills the frame, so pixel (x, y) shows texels 0.05 … 0.95 of the atlas. The
// tests use one renderer and layers of a single value, so every pixel is a sample of the palette.
class Shade : public testing::Test {
 protected:
  Shade()
      : scene_(make_scene(flat_square(), 256)),
        model_(renderer_.add(scene_)),
        view_(renderer_.add_view(model_)) {
    request_.view = view_;
    request_.camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize, 0.5);
    request_.width = request_.height = kSize;
  }
  render::LayerHandle filled_layer(ValueType type, std::uint32_t bits) {
    const auto layer = renderer_.add_layer(model_, type, 256);
    auto tile = std::make_shared<TileData>(type);
    for (int i = 0; i < kTexelsPerTile; ++i) tile->write(i, bits);
    std::vector<render::TileUpload> tiles;
    for (std::uint16_t y = 0; y < 2; ++y)
      for (std::uint16_t x = 0; x < 2; ++x) tiles.push_back({{x, y}, tile});
    renderer_.write(layer, tiles);
    return layer;
  }
  static std::array<double, 3> pixel(const render::Frame& frame, int x, int y) {
    const auto* p = &frame.pixels[4 * static_cast<std::size_t>(y * frame.width + x)];
    return {double(p[0]), double(p[1]), double(p[2])};
  }
  // Measures the light on the square with a white layer.
  double light() {
    auto white = std::make_shared<Palette>(
        Palette{PaletteMode::step, 0, 1, {{0, {255, 255, 255, 255}, {}}}, {}});
    request_.style.layers = {{filled_layer(ValueType::u8, 1), white, 1}};
    return pixel(renderer_.draw(request_), 128, 128)[0] / 255;
  }
  void expect_color(const std::vector<render::LayerStyle>& layers,
                    const std::array<double, 3>& unlit, double lit) {
    request_.style.layers = layers;
    const auto got = pixel(renderer_.draw(request_), 100, 90);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], unlit[i] * lit, 2.0) << "channel " << i;
  }
  // A completely visible bumpy sphere with an empty layer.
  struct Sphere {
    render::LayerHandle layer;
    std::shared_ptr<const Palette> palette;
    render::FrameRequest request;  // without layers
  };
  Sphere add_sphere(int width, int height) {
    const auto model = renderer_.add(make_scene(bumpy_sphere(30), 512));
    Sphere sphere{renderer_.add_layer(model, ValueType::u8, 512),
                  std::make_shared<const Palette>(default_palette(ValueType::u8, false)),
                  {}};
    sphere.request.view = renderer_.add_view(model);
    sphere.request.camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, width, height);
    sphere.request.width = width, sphere.request.height = height;
    return sphere;
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
  render::ViewHandle view_;
  render::FrameRequest request_;
};

std::array<double, 3> rgb(const Rgba& c) { return {double(c[0]), double(c[1]), double(c[2])}; }

TEST_F(Shade, every_type_is_coloured_as_the_palette_says) {
  const double lit = light();
  EXPECT_GT(lit, 0.5);
  const Palette linear{
      PaletteMode::linear,
      -100,
      100,
      {{-100, {255, 0, 0, 255}, {}}, {0, {0, 255, 0, 255}, {}}, {100, {0, 0, 255, 255}, {}}},
      {}};
  Palette step = linear;
  step.mode = PaletteMode::step;
  Palette keys = linear;
  keys.mode = PaletteMode::categorical;
  for (const auto type : {ValueType::u8, ValueType::u16, ValueType::u32, ValueType::i8,
                          ValueType::i16, ValueType::i32, ValueType::f16, ValueType::f32}) {
    for (const double value : {-120.0, -100.0, -30.0, 0.0, 30.0, 99.0, 100.0, 120.0}) {
      const auto bits = encode_value(type, value);
      if (!bits) continue;
      const auto layer = filled_layer(type, *bits);
      for (const Palette& palette : {linear, step, keys}) {
        SCOPED_TRACE(std::string(name(type)) + " " + std::to_string(value) + " mode " +
                     std::to_string(int(palette.mode)));
        expect_color({{layer, std::make_shared<Palette>(palette), 1}},
                     rgb(color_of(palette, value)), lit);
      }
      renderer_->remove_layer(layer);
    }
  }
}

TEST(ColorDifference, is_that_of_the_published_examples) {
  EXPECT_NEAR(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(ciede2000({50, 2.5, 0}, {50, 0, -2.5}), 4.3065, 1e-4);
  EXPECT_NEAR(ciede2000({50, 2.5, 0}, {58, 24, 15}), 19.4535, 1e-4);
  EXPECT_NEAR(ciede2000({90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}), 1.4441, 1e-4);
  EXPECT_NEAR(ciede2000({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}), 0.9082, 1e-4);
  EXPECT_NEAR(color_difference({255, 255, 255}, {0, 0, 0}), 100, 0.01);
}

TEST_F(Shade, a_class_has_the_colour_of_its_legend_in_museum_light_and_without_light) {
  for (const Rgba color : {Rgba{255, 255, 255, 255},
                           {119, 119, 119, 255},
                           {20, 20, 20, 255},
                           {200, 30, 40, 255},
                           {0, 114, 178, 255},
                           {230, 159, 0, 255},
                           {0, 158, 115, 255},
                           {204, 121, 167, 255}}) {
    const auto palette =
        std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, color, {}}}, {}});
    request_.style.layers = {{filled_layer(ValueType::u8, 1), palette, 1}};
    SCOPED_TRACE(std::to_string(color[0]) + " " + std::to_string(color[1]));
    for (const double ev : {-3.0, 0.0, 3.0}) {
      request_.style.light = {LightMode::museum, {0, 0, 1}, ev};
      EXPECT_LE(color_difference(pixel(renderer_.draw(request_), 128, 128), rgb(color)), 3)
          << "whatever the exposure";
      request_.style.light = {LightMode::unlit, {0, 0, 1}, ev};
      EXPECT_EQ(pixel(renderer_.draw(request_), 128, 128), rgb(color));
    }
  }
}

TEST_F(Shade, layers_are_weaker_in_raking_light_if_the_light_says_so) {
  const auto red =
      std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, {250, 0, 0, 255}, {}}}, {}});
  const auto layer = filled_layer(ValueType::u8, 1);
  const auto at = [&](LightMode mode, double opacity, bool with_layer) {
    request_.style.light = {mode, {-1, 0, 0.5}, 0, 0, opacity};
    request_.style.layers.clear();
    if (with_layer) request_.style.layers = {{layer, red, 1}};
    return pixel(renderer_.draw(request_), 128, 128);
  };
  const auto bare = at(LightMode::raking, 1, false), full = at(LightMode::raking, 1, true),
             weak = at(LightMode::raking, 0.3, true);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(weak[i], bare[i] + 0.3 * (full[i] - bare[i]), 1.5) << "channel " << i;
  EXPECT_EQ(at(LightMode::museum, 0.3, true), at(LightMode::museum, 1, true));
}

TEST_F(Shade, a_step_changes_colour_exactly_at_its_point) {
  const double lit = light();
  const Palette step{
      PaletteMode::step,
      0,
      255,
      {{0, {250, 0, 0, 255}, {}}, {3, {0, 250, 0, 255}, {}}, {255, {0, 0, 250, 255}, {}}},
      {}};
  for (const std::uint32_t value : {0u, 2u, 3u, 4u, 254u, 255u}) {
    SCOPED_TRACE(value);
    expect_color({{filled_layer(ValueType::u8, value), std::make_shared<Palette>(step), 1}},
                 rgb(color_of(step, value)), lit);
  }
}

TEST_F(Shade, keys_that_are_not_listed_get_the_generated_colour) {
  const double lit = light();
  const Palette keys{PaletteMode::categorical, 0, 1, {{70000, {10, 200, 30, 255}, {}}}, {}};
  for (const std::uint32_t key : {1u, 2u, 69999u, 70000u, 4000000000u}) {
    SCOPED_TRACE(key);
    expect_color({{filled_layer(ValueType::u32, key), std::make_shared<Palette>(keys), 1}},
                 rgb(color_of(keys, key)), lit);
  }
}

TEST_F(Shade, keys_that_are_not_listed_get_the_colour_of_the_others_where_there_is_one) {
  const double lit = light();
  Palette keys{PaletteMode::categorical, 0, 1, {{3, {10, 200, 30, 255}}}, {}};
  keys.others = Rgba{120, 130, 140, 255};
  for (const std::uint32_t key : {2u, 3u, 70000u}) {
    SCOPED_TRACE(key);
    expect_color({{filled_layer(ValueType::u32, key), std::make_shared<Palette>(keys), 1}},
                 rgb(color_of(keys, key)), lit);
  }
}

TEST_F(Shade, a_palette_lists_as_many_keys_as_a_table_has_records) {
  const double lit = light();
  Palette keys{PaletteMode::categorical, 0, 1, {}, {}};
  for (int key = 0; key < 300'000; ++key) {
    keys.points.push_back(
        {double(key),
         {static_cast<std::uint8_t>(key / 2000), static_cast<std::uint8_t>(key % 251), 90, 255}});
  }
  const auto palette = std::make_shared<Palette>(keys);
  for (const std::uint32_t key : {0u, 4095u, 4096u, 70'000u, 299'999u}) {
    SCOPED_TRACE(key);
    expect_color({{filled_layer(ValueType::u32, key), palette, 1}}, rgb(color_of(keys, key)), lit);
  }
}

// Returns the share of a pixel that the hatch or dots of shaders/shade_pass.frag cover, in plain
// C++. `from` is the pixel's offset from the pattern's origin, with y up. A tint fills the space
// between lines and dots, unless the layer is bare.
double pattern_cover(Pattern pattern, double angle_deg, double spacing_px, glm::dvec2 from,
                     bool bare) {
  const double angle = angle_deg / 180 * 3.14159265358979;
  const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
  const glm::dvec2 place(glm::dot(from, along) / spacing_px, glm::dot(from, across) / spacing_px);
  const glm::dvec2 middle = (place - glm::floor(place) - 0.5) * spacing_px;
  const double inside = pattern == Pattern::dots ? 0.32 * spacing_px - glm::length(middle)
                                                 : 0.4 / 2 * spacing_px - std::abs(middle.y);
  const double ground = bare ? 0 : 0.3;
  return ground + (1 - ground) * std::clamp(inside + 0.5, 0.0, 1.0);
}

TEST_F(Shade, patterns_let_what_is_below_be_seen_between_their_lines_and_dots) {
  const double lit = light();
  const auto lower = filled_layer(ValueType::u8, 1), upper = filled_layer(ValueType::u16, 7);
  const auto red =
      std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, {255, 0, 0, 255}}}, {}});
  // The square is 1 m wide, and each of its 256 pixels is 1000 / 256 mm wide. The camera is aimed
  // at its center, at pixel 128.
  const double mm_per_pixel = 1000.0 / kSize;
  struct Case {
    Pattern pattern;
    double angle, spacing_mm, spacing_px;
    bool bare = false;
  };
  for (const Case& c :
       {Case{Pattern::hatch, 0, 0, 7}, Case{Pattern::hatch, 135, 0, 7, true},
        Case{Pattern::hatch, 45, 40, 40 / mm_per_pixel},
        Case{Pattern::hatch, 90, 10, 4 * 10 / mm_per_pixel}, Case{Pattern::dots, 30, 0, 7},
        Case{Pattern::dots, 120, 60, 60 / mm_per_pixel}}) {
    for (const PaletteMode mode : {PaletteMode::step, PaletteMode::categorical}) {
      SCOPED_TRACE(std::to_string(int(c.pattern)) + " " + std::to_string(c.angle) + " " +
                   std::to_string(c.spacing_mm));
      Palette::Point point{7, {0, 0, 255, 255}};
      point.pattern = c.pattern, point.angle = c.angle, point.spacing_mm = c.spacing_mm;
      auto inked = std::make_shared<Palette>(Palette{mode, 0, 10, {point}, {}});
      request_.style.layers = {{lower, red, 1},
                               {.layer = upper, .palette = inked, .opacity = 1, .bare = c.bare}};
      const auto frame = renderer_.draw(request_);
      double worst = 0;
      std::size_t covered = 0;
      for (int y = 20; y < 236; ++y) {
        for (int x = 20; x < 236; ++x) {
          const glm::dvec2 from(x + 0.5 - kSize / 2.0, kSize - y - 0.5 - kSize / 2.0);
          const double cover = pattern_cover(c.pattern, c.angle, c.spacing_px, from, c.bare);
          const auto got = pixel(frame, x, y);
          worst = std::max({worst, std::abs(got[0] - 255 * lit * (1 - cover)),
                            std::abs(got[2] - 255 * lit * cover)});
          covered += cover > 0.5;
        }
      }
      EXPECT_LT(worst, 12) << "of 255: angles and spacings are rounded on their way";
      EXPECT_GT(covered, 216u * 216 / 5);
      EXPECT_LT(covered, 216u * 216 / 2);
    }
  }
}

TEST_F(Shade, hatched_paint_is_seen_at_every_zoom_by_its_tint_and_its_border) {
  // One of the four tiles, a quarter of the square, has the value. From the largest distance, this
  // tile covers only a few pixels. From the smallest distance, lines with a spacing of 40 mm are
  // far apart.
  const auto layer = renderer_.add_layer(model_, ValueType::u8, 256);
  auto tile = std::make_shared<TileData>(ValueType::u8);
  for (int i = 0; i < kTexelsPerTile; ++i) tile->write(i, 7u);
  renderer_.write(layer, {{{0, 0}, tile}});
  for (const double spacing_mm : {0.0, 40.0, 500.0})
    for (const double half_height : {8.0, 2.0, 0.5, 0.05})
      for (const int scale : {1, 3}) {
        SCOPED_TRACE(std::to_string(spacing_mm) + " " + std::to_string(half_height) + " " +
                     std::to_string(scale));
        Palette::Point point{7, {0, 0, 255, 255}};
        point.pattern = Pattern::hatch, point.spacing_mm = spacing_mm;
        render::FrameRequest request = request_;
        request.camera =
            orthographic_camera({-0.25, -0.25, 2}, {-0.25, -0.25, 0}, kSize, kSize, half_height);
        request.width = request.height = scale * kSize;
        request.style.layers = {};
        const auto bare = renderer_.draw(request);
        request.style.layers = {
            {layer,
             std::make_shared<Palette>(Palette{PaletteMode::categorical, 0, 10, {point}, {}}), 1}};
        const auto frame = renderer_.draw(request);
        // The blue is drawn over the other content: the tint everywhere, and a stronger blue along
        // the border.
        std::size_t tinted = 0, full = 0;
        for (int y = 0; y < frame.height; ++y)
          for (int x = 0; x < frame.width; ++x) {
            const auto got = pixel(frame, x, y), was = pixel(bare, x, y);
            if (got == was) continue;
            const double share = 1 - double(got[0]) / std::max(1, int(was[0]));
            ASSERT_GT(share, 0.25) << x << " " << y;
            ++(share > 0.9 ? full : tinted);
          }
        const double side_px = std::min(1.0 * kSize, 0.5 / half_height / 2 * kSize) * scale;
        EXPECT_GT(static_cast<double>(tinted + full), 0.7 * side_px * side_px);
        if (half_height > 1) {
          EXPECT_GT(static_cast<double>(full), 0.3 * side_px * side_px)
              << "the border of a small one";
        } else if (spacing_mm < 100) {
          EXPECT_GT(tinted, full / 2);
        }
      }
}

TEST_F(Shade, an_outline_is_drawn_where_the_value_ends_and_not_inside) {
  // One of the four tiles has the value 7, and the next one has 8. They are texels 0…127 and
  // 128…255 of the square.
  const auto layer = renderer_.add_layer(model_, ValueType::u8, 256);
  std::vector<render::TileUpload> tiles;
  for (std::uint16_t x = 0; x < 2; ++x) {
    auto tile = std::make_shared<TileData>(ValueType::u8);
    for (int i = 0; i < kTexelsPerTile; ++i) tile->write(i, 7u + x);
    tiles.push_back({{x, 0}, tile});
  }
  renderer_.write(layer, tiles);
  Palette::Point outlined{7, {0, 0, 255, 255}};
  outlined.pattern = Pattern::outline;
  const auto palette = std::make_shared<Palette>(
      Palette{PaletteMode::categorical, 0, 10, {outlined, {8, {0, 255, 0, 255}}}, {}});
  request_.style.layers = {{layer, palette, 1}};
  const auto frame = renderer_.draw(request_);
  request_.style.layers = {};
  const auto bare = renderer_.draw(request_);
  int outline = 0, inside = 0;
  for (int y = 10; y < 246; ++y) {
    for (int x = 10; x < 246; ++x) {
      const auto got = pixel(frame, x, y);
      if (got[2] > got[0] + 60 && got[2] > got[1] + 60) {
        ++outline;
        // The outline follows the edge to the other value (x = 128) or to unpainted texels (y =
        // 128, because a row of tiles is half of the square).
        EXPECT_TRUE(std::abs(x + 0.5 - 128) < 3 || std::abs(y + 0.5 - 128) < 3) << x << " " << y;
      } else if (got == pixel(bare, x, y)) {
        ++inside;
      }
    }
  }
  EXPECT_GT(outline, 2 * 100) << "some pixels along two edges of a hundred";
  EXPECT_GT(inside, 118 * 118 / 2) << "nothing is drawn within";
}

TEST_F(Shade, layers_cover_each_other_bottom_to_top_by_opacity_and_palette_alpha) {
  const double lit = light();
  const auto plain = [](Rgba color) {
    return std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, color, {}}}, {}});
  };
  const auto lower = filled_layer(ValueType::u8, 1), upper = filled_layer(ValueType::u16, 1);
  const auto red = plain({255, 0, 0, 255}), green = plain({0, 255, 0, 128});
  expect_color({{lower, red, 1}, {upper, green, 1}}, {255 * (1 - 128 / 255.0), 128, 0}, lit);
  expect_color({{upper, green, 1}, {lower, red, 1}}, {255, 0, 0}, lit);
  expect_color({{lower, red, 1}, {upper, green, 0.5f}}, {255 * (1 - 64 / 255.0), 64, 0}, lit);
}

TEST_F(Shade, many_layers_of_every_width_are_drawn_in_their_order) {
  const double lit = light();
  std::vector<render::LayerStyle> layers;
  std::array<double, 3> expected{0, 0, 0};
  for (int i = 0; i < 24; ++i) {
    const auto type = static_cast<ValueType>(i % 8);
    const Rgba color{static_cast<std::uint8_t>(40 * (i % 6)),
                     static_cast<std::uint8_t>(60 * (i % 4)),
                     static_cast<std::uint8_t>(255 - 10 * i), 255};
    auto palette =
        std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, color, {}}}, {}});
    layers.push_back({filled_layer(type, 1), palette, i == 0 ? 1.0f : 0.3f});
    for (std::size_t c = 0; c < 3; ++c)
      expected[c] = i == 0 ? color[c] : expected[c] * 0.7 + color[c] * 0.3;
  }
  expect_color(layers, expected, lit);
}

// Blends one channel of a layer with the content below it, in plain C++. All numbers are 0 to 1.
// `ink` is the color without light.
double blended(LayerBlend blend, double below, double ink, double lit, double cover) {
  const double over = blend == LayerBlend::multiply ? below * ink
                      : blend == LayerBlend::screen ? 1 - (1 - below) * (1 - ink * lit)
                                                    : ink * lit;
  return below * (1 - cover) + over * cover;
}

TEST_F(Shade, layers_filter_and_lighten_what_is_below_in_one_draw_and_in_several) {
  const double lit = light();
  constexpr std::array kBlends{LayerBlend::normal, LayerBlend::multiply, LayerBlend::screen};
  // Two layers share one draw. The chunks of 24 layers of several types do not fit into one draw.
  for (const int count : {2, 3, 24}) {
    for (int turn = 0; turn < 9; ++turn) {
      SCOPED_TRACE(std::to_string(count) + " " + std::to_string(turn));
      std::vector<render::LayerStyle> layers;
      std::array<double, 3> expected{};
      for (int i = 0; i < count; ++i) {
        const Rgba color{static_cast<std::uint8_t>(255 - 37 * (i % 6)),
                         static_cast<std::uint8_t>(70 + 60 * ((i + turn) % 4)),
                         static_cast<std::uint8_t>(10 * i + 5 * turn), 255};
        const auto blend = i == 0   ? LayerBlend::normal
                           : i == 1 ? kBlends[turn % 3]
                                    : kBlends[(i + turn / 3) % 3];
        const float opacity = i == 0 ? 1.0f : 0.3f + 0.05f * static_cast<float>(turn);
        auto palette =
            std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, color, {}}}, {}});
        layers.push_back({filled_layer(static_cast<ValueType>(i % 8), 1), palette, opacity, blend});
        for (std::size_t c = 0; c < 3; ++c)
          expected[c] = blended(blend, expected[c], color[c] / 255.0, lit, opacity);
      }
      expect_color(layers, {255 * expected[0], 255 * expected[1], 255 * expected[2]}, 1);
    }
  }
}

TEST_F(Shade, more_layers_than_one_draw_takes_are_all_shown) {
  const double lit = light();
  const auto plain = [](Rgba color) {
    return std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, color, {}}}, {}});
  };
  const auto layer = filled_layer(ValueType::u8, 1);
  std::vector<render::LayerStyle> layers(150, {layer, plain({255, 255, 255, 255}), 0});
  layers[3] = {layer, plain({255, 0, 0, 255}), 1};
  layers[70] = {layer, plain({0, 255, 0, 255}), 0.5f};
  layers[140] = {layer, plain({0, 0, 255, 255}), 0.5f};
  expect_color(layers, {64, 64, 128}, lit);
}

TEST_F(Shade, a_large_picture_is_shaded_in_bands_without_a_seam) {
  auto [layer, palette, request] = add_sphere(2048, 1800);
  for (int i = 0; i < 3; ++i) request.style.layers.push_back({layer, palette, 0.5f});
  renderer_.paint(layer, dab(request.camera, 1024, 900, 500, 100));
  const auto picture = renderer_.draw(request);
  // Draw the same content in parts of one band each.
  for (const double y : {-0.4, 0.0, 0.4}) {
    auto part_request = request;
    part_request.changed = {{{-0.3, y - 0.1, 0.5}, {0.3, y + 0.1, 1}}};
    const auto part = renderer_.draw(part_request);
    ASSERT_GT(part.rects.at(0).height, 50);
    ASSERT_LT(part.rects.at(0).width * part.rects.at(0).height * 4, 1 << 22);
    for (int row = 0; row < part.rects.at(0).height; ++row) {
      const auto* whole =
          &picture.pixels[4 * (static_cast<std::size_t>(part.rects.at(0).y + row) * 2048 +
                               static_cast<std::size_t>(part.rects.at(0).x))];
      ASSERT_TRUE(
          std::equal(whole, whole + 4 * part.rects.at(0).width,
                     &part.pixels[static_cast<std::size_t>(4 * row * part.rects.at(0).width)]));
    }
  }
}

TEST_F(Shade, the_background_is_a_gradient_from_top_to_bottom) {
  request_.camera = orthographic_camera({0, 0, 2}, {5, 0, 0}, kSize, kSize, 0.5);
  request_.style.background = {{250, 0, 0, 255}, {0, 0, 250, 255}};
  const auto frame = renderer_.draw(request_);
  EXPECT_NEAR(pixel(frame, 0, 0)[0], 250, 2);
  EXPECT_NEAR(pixel(frame, 0, 255)[2], 250, 2);
  EXPECT_NEAR(pixel(frame, 128, 128)[0], 125, 3);
}

TEST_F(Shade, the_top_row_of_the_picture_is_the_top_of_the_view) {
  // The square fills the lower half of the frame.
  request_.camera = orthographic_camera({0, 0.5, 2}, {0, 0.5, 0}, kSize, kSize, 0.5);
  const auto frame = renderer_.draw(request_);
  EXPECT_EQ(pixel(frame, 128, 20), pixel(frame, 10, 20));
  EXPECT_NE(pixel(frame, 128, 240)[0], pixel(frame, 128, 20)[0]);
}

TEST_F(Shade, a_reshaded_rectangle_equals_a_full_redraw) {
  auto [layer, palette, request] = add_sphere(640, 480);
  request.style.layers = {{layer, palette, 0.8f}};
  auto picture = renderer_.draw(request);
  ASSERT_EQ(picture.rects.at(0), (render::PixelRect{0, 0, 640, 480}));
  for (int i = 0; i < 5; ++i) {
    const auto outcome = renderer_.paint(
        layer, dab(request.camera, 250 + 40 * i, 200 + 30 * i, 20, 20u * static_cast<unsigned>(i)));
    auto partial_request = request;
    partial_request.changed = {{outcome.written_min, outcome.written_max}};
    const auto part = renderer_.draw(partial_request);
    ASSERT_LT(part.rects.at(0).width * part.rects.at(0).height, 640 * 480 / 8);
    EXPECT_EQ(part.rects.at(0).x % 16, 0);
    EXPECT_EQ(part.rects.at(0).width % 16, 0);
    put(picture, part);
  }
  EXPECT_EQ(picture.pixels, renderer_.draw(request).pixels);
  // Without a change, no rectangle is sent. With another style, the complete frame is sent.
  auto nothing = request;
  nothing.changed.emplace();
  EXPECT_TRUE(renderer_.draw(nothing).rects.empty());
  nothing.style.layers[0].opacity = 0.5f;
  EXPECT_EQ(renderer_.draw(nothing).rects.at(0).width, 640);
}

TEST_F(Shade, rectangles_far_apart_equal_a_full_redraw_and_nothing_between_is_shaded) {
  auto [layer, palette, request] = add_sphere(640, 480);
  request.style.layers = {{layer, palette, 0.8f}};
  auto picture = renderer_.draw(request);
  auto partial_request = request;
  partial_request.changed.emplace();
  for (const glm::dvec2 at : {glm::dvec2(200, 150), {420, 160}, {320, 380}}) {
    const auto outcome = renderer_.paint(layer, dab(request.camera, at.x, at.y, 8, 70));
    partial_request.changed->push_back({outcome.written_min, outcome.written_max});
  }
  const auto part = renderer_.draw(partial_request);
  ASSERT_EQ(part.rects.size(), 3u);
  for (const auto& rect : part.rects) EXPECT_LT(rect.width * rect.height, 640 * 480 / 20);
  put(picture, part);
  EXPECT_EQ(picture.pixels, renderer_.draw(request).pixels);
}

TEST_F(Shade, a_picture_may_have_another_size_than_the_cameras_window) {
  request_.width = 96, request_.height = 64;
  const auto frame = renderer_.draw(request_);
  EXPECT_EQ(frame.pixels.size(), 4u * 96 * 64);
  EXPECT_EQ(frame.rects.at(0), (render::PixelRect{0, 0, 96, 64}));
}

TEST_F(Shade, views_give_their_buffers_up_when_memory_runs_out_and_draw_again) {
  render::RendererOptions options;
  options.gpu_memory_bytes = 14u << 20;
  TestRenderer renderer(options);
  const auto model = renderer.add(scene_);
  std::vector<render::ViewHandle> views;
  for (int i = 0; i < 4; ++i) views.push_back(renderer.add_view(model));
  request_.width = request_.height = 512;  // 4 MiB for each view
  for (int round = 0; round < 2; ++round) {
    for (const auto view : views) {
      request_.view = view;
      EXPECT_EQ(renderer.draw(request_).rects.at(0).width, 512);
      EXPECT_LE(renderer->gpu_bytes_used(), options.gpu_memory_bytes);
    }
  }
}

TEST_F(Shade, rectangles_of_views_that_gave_their_buffers_up_equal_a_full_redraw) {
  constexpr int kWidth = 640, kHeight = 480, kViews = 12;
  constexpr std::uint64_t kBytes = std::uint64_t{16} * kWidth * kHeight;  // buffers of one view
  render::RendererOptions options;
  options.gpu_memory_bytes = 160u << 20;  // a quarter is less than the memory of eight views
  TestRenderer renderer(options);
  const auto model = renderer.add(make_scene(bumpy_sphere(30), 512));
  const auto layer = renderer.add_layer(model, ValueType::u8, 512);
  std::vector<render::FrameRequest> requests(kViews);
  for (int i = 0; i < kViews; ++i) {
    auto& request = requests[static_cast<std::size_t>(i)];
    request.view = renderer.add_view(model);
    request.camera = perspective_camera({1.2 + 0.02 * i, 1.0, 2.4}, {0, 0, 0}, kWidth, kHeight);
    request.width = kWidth, request.height = kHeight;
    request.style.layers = {
        {layer, std::make_shared<const Palette>(default_palette(ValueType::u8, false)), 0.8f}};
  }
  renderer.paint(layer, dab(requests.back().camera, 300, 200, 40, 30));
  const auto without_views = renderer->gpu_bytes_used();
  std::vector<render::Frame> pictures;
  for (const auto& request : requests) pictures.push_back(renderer.draw(request));
  EXPECT_LE(renderer->gpu_bytes_used(), without_views + 8 * kBytes);

  std::vector<render::FrameRequest::Box> changed;
  for (const glm::dvec2 at : {glm::dvec2(260, 180), {400, 300}}) {
    const auto outcome = renderer.paint(layer, dab(requests.back().camera, at.x, at.y, 12, 90));
    changed.push_back({outcome.written_min, outcome.written_max});
  }
  for (std::size_t i = 0; i < requests.size(); ++i) {
    auto request = requests[i];
    request.changed = changed;
    const auto part = renderer.draw(request);
    ASSERT_FALSE(part.rects.empty());
    for (const auto& rect : part.rects) EXPECT_LT(rect.width * rect.height, kWidth * kHeight / 8);
    put(pictures[i], part);
  }
  // The views without buffers share theirs.
  EXPECT_LE(renderer->gpu_bytes_used(), without_views + 10 * kBytes);
  // With another style, the whole frame is drawn.
  auto other = requests.front();
  other.changed = changed;
  other.style.layers[0].opacity = 0.5f;
  EXPECT_EQ(renderer.draw(other).rects.at(0), (render::PixelRect{0, 0, kWidth, kHeight}));
  for (std::size_t i = 0; i < requests.size(); ++i)
    EXPECT_EQ(pictures[i].pixels, renderer.draw(requests[i]).pixels) << "view " << i;
}

TEST_F(Shade, requests_that_cannot_be_drawn_are_refused_with_a_reason) {
  const auto refused = [&](const render::FrameRequest& request, ErrorCode code) {
    const auto result =
        await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, code) << result.error().detail;
  };
  auto request = request_;
  request.view += 1000;
  refused(request, ErrorCode::not_found);
  request = request_;
  request.width = 0;
  refused(request, ErrorCode::invalid);
  request = request_;
  request.style.layers = {
      {view_ + 1000, std::make_shared<Palette>(default_palette(ValueType::u8, true)), 1}};
  refused(request, ErrorCode::not_found);
  request.style.layers = {{filled_layer(ValueType::u8, 1), nullptr, 1}};
  refused(request, ErrorCode::invalid);
  EXPECT_EQ(renderer_.draw(request_).rects.at(0).width, kSize)
      << "a refused request leaves the view usable";
}

}  // namespace
}  // namespace strata::test
