#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "support/edit_oracle.h"

namespace strata::test {
namespace {

constexpr int kResolution = 1024;

TEST(Edit, a_dab_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1280, 720);
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), dab(camera, 600, 350, 40),
                   {.at_least = 500});
}

TEST(Edit, a_dab_with_an_orthographic_camera_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto camera = orthographic_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1280, 720, 1.3);
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), dab(camera, 600, 350, 70),
                   {.at_least = 1000});
}

TEST(Edit, a_square_tool_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  auto stroke = dab(perspective_camera({2.4, 0.3, 1.1}, {0, 0, 0}, 1280, 720), 640, 380, 50);
  stroke.shape = ToolShape::square;
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), stroke, {.at_least = 500});
}

TEST(Edit, a_swept_disc_over_a_silhouette_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  auto stroke = dab(perspective_camera({0.4, -1.5, 2.4}, {0, 0, 0}, 1280, 720), 200, 100, 25);
  stroke.path = {{200, 100}, {700, 350}, {720, 350}, {1000, 700}, {640, 200}};
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), stroke, {.at_least = 2000});
}

TEST(Edit, a_swept_square_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  auto stroke = dab(perspective_camera({0.4, -1.5, 2.4}, {0, 0, 0}, 1280, 720), 200, 100, 25);
  stroke.path = {{400, 300}, {700, 350}, {720, 500}};
  stroke.shape = ToolShape::square;
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), stroke, {.at_least = 1000});
}

TEST(Edit, a_pens_widths_write_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  for (const auto shape : {ToolShape::disc, ToolShape::square})
    for (const bool on_surface : {false, true}) {
      auto stroke = dab(perspective_camera({0.4, -1.5, 2.4}, {0, 0, 0}, 1280, 720), 0, 0, 50);
      stroke.path = {{400, 300}, {500, 330}, {600, 360}, {720, 420}};
      stroke.widths = {0.1, 1, 0.4, 0.08};
      stroke.shape = shape;
      if (on_surface) stroke.radius_px = 0, stroke.radius_world = 0.12;
      expect_as_oracle(renderer, scene, stroke, {.at_least = 800});
    }
}

TEST(Edit, a_path_of_4096_points_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  auto stroke = dab(orthographic_camera({0, 0, 3}, {0, 0, 0}, 640, 480, 0.7), 0, 0, 6);
  stroke.path.clear();
  for (int i = 0; i < 4096; ++i)
    stroke.path.emplace_back(320 + 150 * std::sin(i * 0.013), 240 + 110 * std::sin(i * 0.0097));
  const auto scene = make_scene(flat_square(), 256);
  const auto model = renderer.add(scene);
  const auto outcome = renderer.paint(renderer.add_layer(model, ValueType::u8, 256), stroke);
  const auto expected = oracle_edit(scene, stroke, std::vector<double>(4096, 6.0),
                                    renderer.depth(scene, stroke.camera));
  EXPECT_EQ(compare(expected, outcome).surface, 0);
  EXPECT_GT(expected.count, 5000);
}

TEST(Edit, a_fixed_depth_bias_writes_the_texels_that_the_oracle_says) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(60), kResolution);
  for (const double bias : {5e-5, 2e-4, 5e-3}) {
    auto stroke = dab(perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1280, 720), 640, 360, 200);
    stroke.fixed_depth_bias = bias;
    expect_as_oracle(renderer, scene, stroke, {.at_least = 500});
  }
}

TEST(Edit, a_fixed_depth_bias_reaches_what_lies_so_much_behind) {
  TestRenderer renderer;
  const auto scene = make_scene(folded_sheets(0.02), 512);
  const auto model = renderer.add(scene);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 400, 400, 0.5);
  const double gap = 0.02 * std::abs(camera.projection[2][2]) / 2;  // in window depth
  const auto hidden = [&](double bias) {
    auto stroke = dab(camera, 200, 200, 100);
    stroke.fixed_depth_bias = bias;
    int count = 0;
    for (const auto& tile :
         renderer.paint(renderer.add_layer(model, ValueType::u8, 512), stroke).tiles)
      count += tile.address.x >= 2 ? tile.written.count() : 0;
    return count;
  };
  EXPECT_EQ(hidden(0.9 * gap), 0);
  EXPECT_GT(hidden(1.1 * gap), 5000);
}

TEST(Edit, painting_through_reaches_what_is_hidden) {
  TestRenderer renderer;
  auto stroke = dab(perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1280, 720), 640, 360, 60);
  stroke.through = true;
  expect_as_oracle(renderer, make_scene(bumpy_sphere(60), kResolution), stroke, {.at_least = 2000});
}

TEST(Edit, an_occluded_texel_is_not_painted) {
  TestRenderer renderer;
  const auto scene = make_scene(folded_sheets(0.02), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 512);
  const auto camera = perspective_camera({0, 0, 2}, {0, 0, 0}, 800, 600);
  const auto outcome = renderer.paint(layer, dab(camera, 400, 300, 100));
  ASSERT_FALSE(outcome.tiles.empty());
  int front = 0;
  for (const auto& tile : outcome.tiles) {
    EXPECT_LT(tile.address.x, 2) << "the hidden sheet lies in the right half of the atlas";
    front += tile.written.count();
  }
  EXPECT_GT(front, 5000);
  // The other sheet is visible from behind.
  for (const auto& tile :
       renderer
           .paint(layer, dab(perspective_camera({0, 0, -2}, {0, 0, 0}, 800, 600), 400, 300, 100))
           .tiles) {
    EXPECT_GE(tile.address.x, 2);
  }
}

TEST(Edit, a_stroke_at_3000_pixels_a_second_has_no_gap) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 512);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 1000, 1000, 0.5);
  auto stroke = dab(camera, 100, 500, 4);
  // Pointer events at 60 Hz are 50 pixels apart.
  stroke.path.clear();
  for (int x = 100; x <= 900; x += 50) stroke.path.emplace_back(x, 500);
  std::set<int> columns;
  for (const auto& tile : renderer.paint(layer, stroke).tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (tile.written.test(i)) columns.insert(tile.address.x * kTileSize + i % kTileSize);
    }
  }
  ASSERT_FALSE(columns.empty());
  EXPECT_EQ(*columns.rbegin() - *columns.begin() + 1, static_cast<int>(columns.size()));
  EXPECT_GT(columns.size(), 360u);
}

TEST(Edit, a_radius_in_model_units_covers_that_area_at_any_distance) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 1024);
  const auto model = renderer.add(scene);
  constexpr double kRadius = 0.2;
  const double expected = 3.14159265358979 * kRadius * kRadius;
  for (const auto& camera : {perspective_camera({0, 0, 2}, {0, 0, 0}, 800, 600),
                             perspective_camera({0, 0, 5}, {0, 0, 0}, 800, 600),
                             orthographic_camera({0, 0, 2}, {0, 0, 0}, 800, 600, 0.6)}) {
    auto stroke = dab(camera, 400, 300, 0);
    stroke.radius_world = kRadius;
    const auto outcome = renderer.paint(renderer.add_layer(model, ValueType::u8, 1024), stroke);
    const double area = written_texels(outcome) / (0.9 * 1024 * 0.9 * 1024);
    EXPECT_NEAR(area, expected, expected * 0.01);
  }
}

TEST(Edit, a_radius_in_model_units_grows_towards_the_eye_along_a_segment) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(8), 1024);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 1024);
  // The camera views the square at an angle, so the lower end of the path is nearer.
  const auto camera = perspective_camera({0, -1.2, 0.9}, {0, 0, 0}, 800, 600);
  auto stroke = dab(camera, 400, 250, 0);
  stroke.path = {{400, 220}, {400, 420}};
  stroke.radius_world = 0.08;
  const auto outcome = renderer.paint(layer, stroke);
  const auto depth = renderer.depth(scene, camera);
  std::vector<double> radii;
  for (const auto& p : stroke.path) {
    const double d = depth[static_cast<std::size_t>(599 - int(p.y)) * 800 + std::size_t(p.x)];
    const double ndc = 2 * d - 1, near = 0.1, far = 20;
    const double w = 2 * near * far / (far + near - ndc * (far - near));
    radii.push_back(0.08 * 300 / std::tan(glm::radians(22.5)) / w);
  }
  EXPECT_GT(radii[1], radii[0] * 1.1);
  EXPECT_EQ(compare(oracle_edit(scene, stroke, radii, depth), outcome).surface, 0);
}

TEST(Edit, a_radius_in_model_units_does_not_depend_on_the_units_of_the_view) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 1024);
  const auto model = renderer.add(scene);
  const auto camera = perspective_camera({0, 0, 2}, {0, 0, 0}, 800, 600);
  const auto written_from = [&](const Camera& from) {
    auto stroke = dab(from, 400, 300, 0);
    stroke.radius_world = 0.2;
    return written_texels(renderer.paint(renderer.add_layer(model, ValueType::u8, 1024), stroke));
  };
  auto scaled = camera;  // the same view in different units of its view space
  scaled.view = glm::scale(glm::dmat4(1.0), glm::dvec3(2.5)) * camera.view;
  EXPECT_NEAR(written_from(scaled), written_from(camera), 20);
}

TEST(Edit, a_radius_far_beyond_the_window_paints_all_that_is_seen) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 1024);
  const auto model = renderer.add(scene);
  const auto camera = perspective_camera({0.1, 0, 0.5}, {0.1, 0, 0}, 800, 600);
  const auto written_by = [&](double radius_px, double radius_world) {
    auto stroke = dab(camera, 300, 200, radius_px);
    stroke.radius_world = radius_world;
    return written_texels(renderer.paint(renderer.add_layer(model, ValueType::u8, 1024), stroke));
  };
  const int all = written_by(10'000, 0);
  EXPECT_GT(all, 50'000);
  EXPECT_EQ(written_by(0, 1e10), all);
  EXPECT_EQ(written_by(1e300, 0), all);
}

// Makes the driver refuse to map a buffer, after `granted` successful calls, until destruction. GPU
// thread only.
class MapRefusal {
 public:
  explicit MapRefusal(int granted) : real_(epoxy_glMapNamedBufferRange) {
    granted_left_ = granted;
    next_call_ = real_;
    epoxy_glMapNamedBufferRange = [](GLuint buffer, GLintptr offset, GLsizeiptr length,
                                     GLbitfield access) -> void* {
      return granted_left_-- == 0 ? nullptr : next_call_(buffer, offset, length, access);
    };
  }
  ~MapRefusal() { epoxy_glMapNamedBufferRange = real_; }

 private:
  const PFNGLMAPNAMEDBUFFERRANGEPROC real_;
  static inline PFNGLMAPNAMEDBUFFERRANGEPROC next_call_;
  static inline int granted_left_;
};

TEST(Edit, a_stroke_that_is_refused_for_want_of_memory_has_painted_nothing) {
  const auto scene = make_scene(flat_square(), 256);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  if (TestRenderer()->info().edit_path == render::EditPath::kernel)
    GTEST_SKIP() << "the kernel maps no buffer";
  int refusals = 0;
  for (bool painted = false; !painted; ++refusals) {
    TestRenderer renderer;  // a new renderer has no buffer to reuse
    const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 256);
    std::optional<MapRefusal> refusal;
    renderer->run_on_gpu_thread_for_test([&] { refusal.emplace(refusals); });
    const auto outcome = await<render::StrokeOutcome>(
        [&](auto done) { renderer->paint(layer, dab(camera, 60, 60, 40, 7), std::move(done)); });
    renderer->run_on_gpu_thread_for_test([&] { refusal.reset(); });
    painted = outcome.has_value();
    if (painted) break;
    EXPECT_EQ(outcome.error().code, ErrorCode::out_of_memory);
    for (const auto& tile : renderer.paint(layer, dab(camera, 30, 60, 3, 9)).tiles) {
      EXPECT_TRUE(tile.after.valid == tile.written) << "refused at buffer " << refusals;
    }
  }
  EXPECT_GE(refusals, 2) << "what is touched and written, and the tiles, are read back";
}

TEST(Edit, erasing_clears_value_and_flag_and_tells_what_it_touched) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u16, 512);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 512, 512, 0.5);
  const auto painted = renderer.paint(layer, dab(camera, 256, 256, 100, 513));
  auto eraser = dab(camera, 256, 256, 50);
  eraser.erase = true;
  const auto erased = renderer.paint(layer, eraser);
  ASSERT_FALSE(erased.tiles.empty());
  for (const auto& tile : erased.tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (!tile.written.test(i)) continue;
      EXPECT_FALSE(tile.after.valid.test(i));
      EXPECT_EQ(tile.after.bits(i), 0u);
    }
  }
  EXPECT_LT(written_texels(erased), written_texels(painted));
}

TEST(Edit, erasing_an_empty_layer_counts_texels_as_written_and_makes_no_page) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 512);
  const auto before = renderer->layer_bytes_used(layer);
  auto eraser = dab(orthographic_camera({0, 0, 2}, {0, 0, 0}, 512, 512, 0.5), 256, 256, 50);
  eraser.erase = true;
  const auto outcome = renderer.paint(layer, eraser);
  EXPECT_GT(written_texels(outcome), 5000);
  for (const auto& tile : outcome.tiles) EXPECT_FALSE(tile.after.valid.any());
  EXPECT_EQ(renderer->layer_bytes_used(layer), before);
}

TEST(Edit, gutter_texels_follow_their_owner) {
  TestRenderer renderer;
  const auto scene = make_scene(bumpy_sphere(40), kResolution);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, kResolution);
  const auto outcome = renderer.paint(
      layer, dab(perspective_camera({2.0, 2.0, 2.0}, {0, 0, 0}, 1280, 720), 640, 360, 120));
  const auto& map = *scene.map;
  std::vector<std::uint8_t> written(static_cast<std::size_t>(kResolution) * kResolution);
  const auto at = [](int x, int y) {
    return static_cast<std::size_t>(y) * kResolution + static_cast<std::size_t>(x);
  };
  for (const auto& tile : outcome.tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i) {
      written[at(tile.address.x * kTileSize + i % kTileSize,
                 tile.address.y * kTileSize + i / kTileSize)] = tile.written.test(i);
    }
  }
  struct Texel {
    bool owned, surface;
    glm::vec3 position;
  };
  const auto texel = [&](int x, int y) -> Texel {
    if (x < 0 || y < 0 || x >= kResolution || y >= kResolution) return {false, false, {}};
    const auto slot =
        map.slot_of_block[static_cast<std::size_t>(y / 8 * map.blocks_per_side + x / 8)];
    const int i = y % 8 * 8 + x % 8;
    if (slot == mesh::kNoSlot ||
        map.packed_position[slot * 64 + static_cast<std::uint32_t>(i)] == mesh::kNoPosition)
      return {false, false, {}};
    return {true, (map.surface_mask[slot] >> i & 1) != 0, map.position(slot, i)};
  };
  int followed = 0;
  for (int y = 0; y < kResolution; ++y) {
    for (int x = 0; x < kResolution; ++x) {
      const Texel gutter = texel(x, y);
      if (!gutter.owned || gutter.surface) continue;
      // The owner is the nearby surface texel with the same position.
      float nearest = 1e-5f;
      std::size_t owner = 0;
      for (int dy = -3; dy <= 3; ++dy) {
        for (int dx = -3; dx <= 3; ++dx) {
          const Texel other = texel(x + dx, y + dy);
          const float distance = glm::length(other.position - gutter.position);
          if (!other.surface || distance >= nearest) continue;
          nearest = distance;
          owner = at(x + dx, y + dy);
        }
      }
      ASSERT_LT(nearest, 1e-5f) << "no owner at " << x << ", " << y;
      EXPECT_EQ(written[at(x, y)], written[owner]) << "at " << x << ", " << y;
      followed += written[at(x, y)];
    }
  }
  EXPECT_GT(followed, 50) << "the stroke must lie over seams";
}

TEST(Edit, the_written_box_holds_the_painted_surface_and_little_more) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(16), 1024);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 1024);
  const auto outcome = renderer.paint(
      layer, dab(orthographic_camera({0, 0, 2}, {0, 0, 0}, 1000, 1000, 0.5), 500, 500, 100));
  EXPECT_NEAR(outcome.written_min.x, -0.1, 0.015);
  EXPECT_NEAR(outcome.written_max.y, 0.1, 0.015);
}

TEST(Edit, strokes_that_cannot_be_painted_are_refused_with_a_reason) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 256);
  const auto model = renderer.add(scene);
  const auto layer = renderer.add_layer(model, ValueType::u8, 256);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 100, 100, 0.5);
  const auto refused = [&](render::LayerHandle target, const StrokeBatch& stroke, ErrorCode code) {
    const auto result = await<render::StrokeOutcome>(
        [&](auto done) { renderer->paint(target, stroke, std::move(done)); });
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, code);
    EXPECT_FALSE(result.error().detail.empty());
  };
  auto stroke = dab(camera, 50, 50, 10);
  refused(layer + 100, stroke, ErrorCode::not_found);
  refused(renderer.add_layer(model, ValueType::u8, 512), stroke,
          ErrorCode::conflict);  // the model has no surface map of 512²
  stroke.path.clear();
  refused(layer, stroke, ErrorCode::invalid);
  refused(layer, dab(camera, std::nan(""), 0, 10), ErrorCode::invalid);
  refused(layer, dab(camera, 50, 50, 0), ErrorCode::invalid);
  for (const double bias : {-1e-9, 1.5, std::nan("")}) {
    auto biased = dab(camera, 50, 50, 10);
    biased.fixed_depth_bias = bias;
    refused(layer, biased, ErrorCode::invalid);
  }
  refused(layer, dab({glm::dmat4(0.0), camera.projection, 100, 100}, 50, 50, 10),
          ErrorCode::invalid);
}

}  // namespace
}  // namespace strata::test
