#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/edit_oracle.h"
#include "support/shapes.h"

namespace strata::test {
namespace {

constexpr int kResolution = 1024;
constexpr int kUndecidedOneIn = 2'000;  // shapes have more edges than discs

StrokeBatch shaped(StrokeBatch stroke, bool (*inside)(double, double)) {
  stroke.shape = ToolShape::texture;
  stroke.texture = shape(inside);
  return stroke;
}

TEST(ToolTexture, a_dab_of_any_shape_and_size_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  const auto model = renderer.add(scene);
  const auto camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1280, 720);
  for (const auto inside : {in_flag, in_ring, in_bar, in_dots})
    for (const double radius : {9.0, 60.0, 250.0})
      expect_as_oracle(renderer, scene, shaped(dab(camera, 600, 350, radius), inside),
                       {radius > 50 ? 8 : 0, kUndecidedOneIn}, model);
}

TEST(ToolTexture, a_swept_shape_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  const auto model = renderer.add(scene);
  auto stroke = dab(perspective_camera({0.4, -1.5, 2.4}, {0, 0, 0}, 1280, 720), 200, 100, 40);
  stroke.path = {{400, 300}, {700, 350}, {720, 350}, {720, 500}, {640, 200}};
  for (const auto inside : {in_flag, in_ring, in_bar, in_dots})
    expect_as_oracle(renderer, scene, shaped(stroke, inside), {1000, kUndecidedOneIn}, model);
}

TEST(ToolTexture, a_shape_that_grows_along_its_path_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  const auto model = renderer.add(scene);
  auto stroke = dab(perspective_camera({0.9, 0.4, 1.3}, {0, 0, 0}, 1280, 720, 60), 0, 0, 0);
  stroke.radius_world = 0.11;
  stroke.path = {{500, 360}, {800, 300}, {860, 420}};
  for (const auto inside : {in_flag, in_ring, in_bar, in_dots})
    expect_as_oracle(renderer, scene, shaped(stroke, inside), {400, kUndecidedOneIn}, model);
}

TEST(ToolTexture, a_path_of_4096_points_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  auto stroke = dab(orthographic_camera({0, 0, 3}, {0, 0, 0}, 640, 480, 0.7), 0, 0, 14);
  stroke.path.clear();
  for (int i = 0; i < 4096; ++i)
    stroke.path.emplace_back(320 + 150 * std::sin(i * 0.013), 240 + 110 * std::sin(i * 0.0097));
  const auto scene = make_scene(flat_square(), 256);
  expect_as_oracle(renderer, scene, shaped(stroke, in_dots), {5000, kUndecidedOneIn});
}

// The bar is thinner than the distance between two events and moves perpendicular to its length.
TEST(ToolTexture, a_swept_shape_has_no_gap_however_thin_it_is) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  auto stroke =
      shaped(dab(orthographic_camera({0, 0, 2}, {0, 0, 0}, 1000, 1000, 0.5), 0, 0, 40), in_bar);
  stroke.path = {{500, 100}, {500, 350}, {500, 640}, {500, 900}};
  std::set<int> rows;
  int written = 0;
  for (const auto& tile :
       renderer.paint(renderer.add_layer(renderer.add(scene), ValueType::u8, 512), stroke).tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (!tile.written.test(i)) continue;
      rows.insert(tile.address.y * kTileSize + i / kTileSize);
      ++written;
    }
  }
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(*rows.rbegin() - *rows.begin() + 1, static_cast<int>(rows.size()));
  EXPECT_GT(rows.size(), 360u);
  const int across = static_cast<int>(0.9 * 512 * 0.85 * 0.08);  // texels along the bar
  EXPECT_NEAR(written / double(rows.size()), across, 1.5);
}

TEST(ToolTexture, the_top_of_the_picture_is_the_top_of_the_tool) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 400, 400, 0.5);
  const auto stroke = shaped(dab(camera, 200, 200, 100), [](double, double y) { return y > 0.5; });
  const auto outcome =
      renderer.paint(renderer.add_layer(renderer.add(scene), ValueType::u8, 512), stroke);
  ASSERT_FALSE(outcome.tiles.empty());
  EXPECT_GT(outcome.written_max.y, 0.2);
  EXPECT_GT(outcome.written_min.y, 0.1);
}

TEST(ToolTexture, a_full_shape_is_the_square) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto model = renderer.add(scene);
  auto square = dab(orthographic_camera({0, 0, 2}, {0, 0, 0}, 403, 401, 0.5), 111, 150, 37);
  square.path.emplace_back(260.5, 190.25);
  square.shape = ToolShape::square;
  const auto full = shaped(square, [](double, double) { return true; });
  const auto mine = renderer.paint(renderer.add_layer(model, ValueType::u8, 512), full);
  const auto theirs = renderer.paint(renderer.add_layer(model, ValueType::u8, 512), square);
  ASSERT_EQ(mine.tiles.size(), theirs.tiles.size());
  int differ = 0;
  for (std::size_t i = 0; i < mine.tiles.size(); ++i)
    for (int texel = 0; texel < kTexelsPerTile; ++texel)
      differ += mine.tiles[i].written.test(texel) != theirs.tiles[i].written.test(texel);
  EXPECT_LE(differ, 2);
  EXPECT_GT(written_texels(theirs), 10'000);
}

TEST(AngleLimit, strokes_with_one_write_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  const auto model = renderer.add(scene);
  for (const auto& camera : {perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 640, 360),
                             orthographic_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 640, 360, 1.3)}) {
    int least = 0;
    for (const double limit : {20.0, 45.0, 75.0, 90.0}) {
      auto stroke = dab(camera, 320, 180, 200);
      stroke.max_angle_deg = limit;
      expect_as_oracle(renderer, scene, stroke, {least, kUndecidedOneIn}, model);
      least = std::max(2000, least);
    }
  }
}

// The square is rotated about the vertical axis and is painted completely or not at all.
TEST(AngleLimit, a_plane_is_painted_up_to_its_angle_and_not_beyond) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 256);
  const auto model = renderer.add(scene);
  for (const double turned : {10.0, 45.0, 80.0}) {
    const double a = glm::radians(turned);
    const auto camera =
        orthographic_camera({2 * std::sin(a), 0, 2 * std::cos(a)}, {0, 0, 0}, 400, 400, 0.6);
    const auto painted = [&](std::optional<double> limit) {
      auto stroke = dab(camera, 200, 200, 30);
      stroke.max_angle_deg = limit;
      return written_texels(renderer.paint(renderer.add_layer(model, ValueType::u8, 256), stroke));
    };
    const int all = painted({});
    EXPECT_GT(all, 500);
    EXPECT_EQ(painted(turned + 0.5), all);
    EXPECT_EQ(painted(turned - 0.5), 0);
    EXPECT_EQ(painted(90.0), all);
  }
}

// With perspective, each point is viewed at a different angle.
TEST(AngleLimit, under_perspective_the_direction_to_the_eye_decides_not_the_cameras_axis) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 512);
  auto stroke = dab(perspective_camera({0, 0, 0.6}, {0, 0, 0}, 900, 900, 90), 450, 450, 600);
  stroke.max_angle_deg = 30;
  const double texels = written_texels(renderer.paint(layer, stroke));
  // The side of the square takes 0.9 of the atlas.
  const double radius = 0.6 * std::tan(glm::radians(30.0)) * 0.9 * 512;
  EXPECT_NEAR(texels, 3.14159265 * radius * radius, 0.02 * texels);
}

TEST(AngleLimit, strokes_whose_shape_or_angle_makes_no_sense_are_refused) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 256);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 256);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 100, 100, 0.5);
  const auto field_of = [&](const StrokeBatch& stroke) {
    const auto result = await<render::StrokeOutcome>(
        [&](auto done) { renderer->paint(layer, stroke, std::move(done)); });
    return result                                      ? "painted"
           : result.error().code == ErrorCode::invalid ? result.error().field
                                                       : result.error().detail;
  };
  for (const double angle : {0.0, -5.0, 90.1, std::nan("")}) {
    auto stroke = dab(camera, 50, 50, 10);
    stroke.max_angle_deg = angle;
    EXPECT_EQ(field_of(stroke), "max_angle_deg");
  }
  auto through = dab(camera, 50, 50, 10);
  through.max_angle_deg = 60;
  through.through = true;
  EXPECT_EQ(field_of(through), "max_angle_deg");
  auto bare = dab(camera, 50, 50, 10);
  bare.shape = ToolShape::texture;
  EXPECT_EQ(field_of(bare), "shape");
}

}  // namespace
}  // namespace strata::test
