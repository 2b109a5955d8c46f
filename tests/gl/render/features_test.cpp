// Tests lines and points over the surface, compared with distances in the image plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kSize = 200;
constexpr Rgba kRed{220, 30, 20, 255};

class SurfaceFeatures : public testing::Test {
 protected:
  SurfaceFeatures() : scene_(make_scene(flat_square(), 128)), model_(renderer_.add(scene_)) {}

  // Returns a point relative to the corner of the square at 0, 0. From above, a pixel is 1/100 of
  // the square's side.
  static glm::dvec3 at(double x, double y, double z = 0) { return {x - 0.5, y - 0.5, z}; }
  static Camera from_above() { return orthographic_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize, 1); }
  static glm::dvec2 on_picture(double x, double y) {
    return {(x + 0.5) * 100, kSize - (y + 0.5) * 100};
  }

  render::Frame draw(const Camera& camera, std::vector<render::DrawnFeature> features,
                     int scale = 1) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model_);
    request.camera = camera;
    request.width = scale * camera.width, request.height = scale * camera.height;
    if (!features.empty())
      request.style.features =
          std::make_shared<const std::vector<render::DrawnFeature>>(std::move(features));
    auto frame = renderer_.draw(request);
    renderer_->remove_view(request.view);
    return frame;
  }
  static std::array<int, 3> pixel(const render::Frame& frame, int x, int y) {
    const auto* p = &frame.pixels[4 * (static_cast<std::size_t>(y) * frame.width + x)];
    return {p[0], p[1], p[2]};
  }

  // Expects each pixel to have the color of the mark, the color of its casing, or its earlier
  // color. Pixels within 0.6 pixels of a border may have any color.
  static void expect_mark(const render::Frame& with, const render::Frame& without, glm::dvec2 a,
                          glm::dvec2 b, double width, double scale = 1) {
    const double half = width / 2 * scale, casing = render::kFeatureCasing_px * scale;
    int marked = 0;
    for (int y = 0; y < with.height; ++y)
      for (int x = 0; x < with.width; ++x) {
        const glm::dvec2 p(x + 0.5, y + 0.5), along = b - a;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0;
        const double apart = glm::distance(p, a + t * along);
        if (apart < half - 0.6) {
          ++marked;
          ASSERT_EQ(pixel(with, x, y), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}))
              << x << " " << y;
        } else if (apart > half + 0.6 && apart < half + casing - 0.6) {
          ASSERT_EQ(pixel(with, x, y), (std::array<int, 3>{255, 255, 255})) << x << " " << y;
        } else if (apart > half + casing + 0.6) {
          ASSERT_EQ(pixel(with, x, y), pixel(without, x, y)) << x << " " << y;
        }
      }
    EXPECT_GT(marked, 20);
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
};

TEST_F(SurfaceFeatures, lines_are_as_wide_as_they_should_be_with_round_ends_and_a_casing) {
  const auto without = draw(from_above(), {});
  for (const auto& [from, to] : {std::pair{glm::dvec2(0.2, 0.5), glm::dvec2(0.8, 0.5)},
                                 {glm::dvec2(0.3, 0.1), glm::dvec2(0.7, 0.95)},
                                 {glm::dvec2(-0.2, 0.4), glm::dvec2(0.4, 0.4)}}) {
    const auto with = draw(from_above(), {{{at(from.x, from.y), at(to.x, to.y)}, kRed}});
    expect_mark(with, without, on_picture(from.x, from.y), on_picture(to.x, to.y),
                render::kLineWidth_px);
  }
}

TEST_F(SurfaceFeatures, a_line_of_many_parts_is_one_line) {
  std::vector<glm::dvec3> places;
  for (int i = 0; i <= 40; ++i) places.push_back(at(0.2 + i * 0.6 / 40, 0.5));
  expect_mark(draw(from_above(), {{places, kRed}}), draw(from_above(), {}), on_picture(0.2, 0.5),
              on_picture(0.8, 0.5), render::kLineWidth_px);
}

TEST_F(SurfaceFeatures, points_are_discs_and_pictures_that_are_larger_show_all_larger) {
  expect_mark(draw(from_above(), {{{at(0.4, 0.6)}, kRed}}), draw(from_above(), {}),
              on_picture(0.4, 0.6), on_picture(0.4, 0.6), render::kPointWidth_px);
  expect_mark(draw(from_above(), {{{at(0.4, 0.6)}, kRed}}, 3), draw(from_above(), {}, 3),
              3.0 * on_picture(0.4, 0.6), 3.0 * on_picture(0.4, 0.6), render::kPointWidth_px, 3);
}

TEST_F(SurfaceFeatures, what_the_surface_hides_is_not_seen) {
  const auto without = draw(from_above(), {});
  const auto below = draw(from_above(), {{{at(0.2, 0.5, -0.3), at(0.8, 0.5, -0.3)}, kRed}});
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      ASSERT_EQ(pixel(below, x, y), pixel(without, x, y)) << x << " " << y;
  const auto above = draw(from_above(), {{{at(0.2, 0.5, 0.3), at(0.8, 0.5, 0.3)}, kRed}});
  EXPECT_NE(above.pixels, without.pixels);
}

TEST_F(SurfaceFeatures, the_section_cuts_them) {
  Camera camera = from_above();
  camera.section = {{1, 0, 0, 0}};  // keeps the right half
  const auto with = draw(camera, {{{at(0.2, 0.5), at(0.8, 0.5)}, kRed}, {{at(0.3, 0.8)}, kRed}});
  expect_mark(with, draw(camera, {}), on_picture(0.5, 0.5), on_picture(0.8, 0.5),
              render::kLineWidth_px);
}

TEST_F(SurfaceFeatures, a_line_past_the_eye_shows_the_part_that_is_ahead) {
  const Camera camera = perspective_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize);
  const auto without = draw(camera, {});
  // One line goes from the center of the square upwards and passes next to the eye.
  const auto with =
      draw(camera, {{{at(0.5, 0.5), at(0.9, 0.5, 5)}, kRed}, {{at(0.5, 0.5, 3)}, kRed}});
  EXPECT_EQ(pixel(with, kSize / 2 + 2, kSize / 2), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}));
  EXPECT_EQ(pixel(with, kSize - 2, kSize / 2), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}));
  for (int y = 0; y < kSize; ++y)
    ASSERT_EQ(pixel(with, kSize / 4, y), pixel(without, kSize / 4, y));
}

TEST_F(SurfaceFeatures, a_part_of_a_picture_that_is_drawn_anew_has_them_too) {
  render::FrameRequest request;
  request.view = renderer_.add_view(model_);
  request.camera = from_above();
  request.width = request.height = kSize;
  request.style.features = std::make_shared<const std::vector<render::DrawnFeature>>(
      std::vector<render::DrawnFeature>{{{at(0.1, 0.1), at(0.9, 0.9)}, kRed}});
  const auto whole = renderer_.draw(request);
  request.changed = std::vector<render::FrameRequest::Box>{{{-0.1f, -0.1f, 0}, {0.1f, 0.1f, 0}}};
  const auto part = renderer_.draw(request);
  ASSERT_LT(part.rects.at(0).width, kSize);
  ASSERT_GT(part.rects.at(0).width, 0);
  for (int y = 0; y < part.rects.at(0).height; ++y)
    for (int x = 0; x < part.rects.at(0).width; ++x) {
      const auto* p = &part.pixels[4 * (static_cast<std::size_t>(y) * part.rects.at(0).width + x)];
      ASSERT_EQ((std::array<int, 3>{p[0], p[1], p[2]}),
                pixel(whole, part.rects.at(0).x + x, part.rects.at(0).y + y));
    }
  // If the marks change, the complete frame is sent, even if no part of the surface changed.
  request.style.features = nullptr;
  request.changed = std::vector<render::FrameRequest::Box>{};
  EXPECT_EQ(renderer_.draw(request).rects.at(0).width, kSize);
  renderer_->remove_view(request.view);
}

// A relief of waves with known heights. The test computes its orthographic view on the CPU, by
// casting rays against the height field.
class FeaturesOnRelief : public SurfaceFeatures {
 protected:
  static constexpr double kHeight = 0.03, kWaves = 3;
  static constexpr double kPi = 3.14159265358979323846;
  static double height(double x, double y) {
    return kHeight * std::sin(2 * kPi * kWaves * x) * std::cos(2 * kPi * kWaves * y);
  }
  static glm::dvec3 on_relief(double x, double y) { return {x, y, height(x, y)}; }
  static glm::dvec3 normal(double x, double y) {
    const double k = 2 * kPi * kWaves;
    return glm::normalize(glm::dvec3(-kHeight * k * std::cos(k * x) * std::cos(k * y),
                                     kHeight * k * std::sin(k * x) * std::sin(k * y), 1));
  }

  FeaturesOnRelief()
      : relief_(make_scene(relief_square(160, height), 128)),
        relief_model_(renderer_.add(relief_)) {
    view_ = renderer_.add_view(relief_model_);
  }
  ~FeaturesOnRelief() override { renderer_->remove_view(view_); }

  // `elevation`: the angle of the eye above the plane, in degrees; 90 is from above.
  static Camera seen_from(double elevation, double half_height,
                          const glm::dvec3& target = {0, 0, 0}) {
    const double e = elevation * kPi / 180;
    return orthographic_camera(target + 4.0 * glm::dvec3(0, -std::cos(e), std::sin(e) + 1e-9),
                               target, kSize, kSize, half_height);
  }

  render::Frame draw_relief(const Camera& camera, std::vector<render::DrawnFeature> features,
                            int scale = 1) {
    render::FrameRequest request;
    request.view = view_;
    request.camera = camera;
    request.width = scale * camera.width, request.height = scale * camera.height;
    if (!features.empty())
      request.style.features =
          std::make_shared<const std::vector<render::DrawnFeature>>(std::move(features));
    return renderer_.draw(request);
  }

  static glm::dvec2 pixel_of(const Camera& camera, const glm::dvec3& world, int scale = 1) {
    const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(world, 1);
    return glm::dvec2((clip.x / clip.w + 1) / 2, (1 - clip.y / clip.w) / 2) * (1.0 * scale * kSize);
  }

  // `close`: a slightly different pixel or reach would change the result.
  enum class Sight { visible, hidden, close };

  // Returns how far a point is below the surface that its pixel shows, perpendicular to that
  // surface. Returns −1 if the pixel shows no surface in front of the point.
  static double depth_below(const Camera& camera, const glm::dvec2& pixel,
                            const glm::dvec3& place) {
    const Ray ray = ray_through_pixel(camera, pixel.x, pixel.y);
    const double until = glm::dot(place - ray.origin, ray.direction), step = 5e-4;
    for (double t = std::max(0.0, until - 1); t < until; t += step) {
      const glm::dvec3 p = ray.origin + t * ray.direction;
      if (std::abs(p.x) > 0.5 || std::abs(p.y) > 0.5 || p.z > height(p.x, p.y)) continue;
      return (until - t) * std::abs(glm::dot(normal(p.x, p.y), ray.direction));
    }
    return -1;
  }
  static Sight sight(const Camera& camera, const glm::dvec3& place, double around_px = 2) {
    const double pixel = 2 / (camera.projection[0][0] * camera.width);
    const glm::dvec2 at = pixel_of(camera, place);
    int visible = 0, hidden = 0;
    for (const double dx : {-around_px, 0.0, around_px})
      for (const double dy : {-around_px, 0.0, around_px}) {
        const glm::dvec2 p = at + glm::dvec2(dx, dy);
        // Use the point at the same depth under the other pixel, in a plane perpendicular to the
        // view.
        const Ray ray = ray_through_pixel(camera, p.x, p.y);
        const double depth = depth_below(
            camera, p, ray.origin + glm::dot(place - ray.origin, ray.direction) * ray.direction);
        if (depth > 4 * (pixel + 1.5e-3) + around_px * pixel) ++hidden;
      }
    const double depth = depth_below(camera, at, place);
    visible = depth < pixel / 2;
    return hidden == 9 ? Sight::hidden : visible && hidden == 0 ? Sight::visible : Sight::close;
  }

  // Counts of pixels: `all` and `differ` inside the disc, and `beyond` for differing pixels
  // outside.
  struct Drawn {
    int differ = 0, all = 0, beyond = 0;
  };
  static Drawn disc(const render::Frame& with, const render::Frame& without, const glm::dvec2& at,
                    double radius) {
    Drawn drawn;
    for (int y = 0; y < with.height; ++y)
      for (int x = 0; x < with.width; ++x) {
        const double apart = glm::distance(glm::dvec2(x + 0.5, y + 0.5), at);
        const bool differs = pixel(with, x, y) != pixel(without, x, y);
        if (apart < radius - 0.6) {
          ++drawn.all;
          drawn.differ += differs;
        } else if (apart > radius + 0.6) {
          drawn.beyond += differs;
        }
      }
    return drawn;
  }

  Scene relief_;
  render::ModelHandle relief_model_;
  render::ViewHandle view_;
};

TEST_F(FeaturesOnRelief, points_are_whole_where_their_place_is_visible_and_else_not_there) {
  constexpr double kRadius = render::kPointWidth_px / 2 + render::kFeatureCasing_px;
  for (const double elevation : {90.0, 40.0, 20.0, 10.0}) {
    const Camera camera = seen_from(elevation, 0.6);
    const auto without = draw_relief(camera, {});
    int visible = 0, hidden = 0;
    for (int i = 0; i < 11; ++i)
      for (int j = 0; j < 11; ++j) {
        const glm::dvec3 place = on_relief(-0.45 + 0.09 * i, -0.44 + 0.087 * j);
        const auto drawn =
            disc(draw_relief(camera, {{{place}, kRed}}), without, pixel_of(camera, place), kRadius);
        SCOPED_TRACE("from " + std::to_string(elevation) + " degrees, " + std::to_string(i) + " " +
                     std::to_string(j));
        ASSERT_EQ(drawn.beyond, 0);
        ASSERT_TRUE(drawn.differ == 0 || drawn.differ == drawn.all)
            << drawn.differ << " of " << drawn.all;
        const Sight seen = sight(camera, place);
        if (seen == Sight::visible) {
          ++visible;
          ASSERT_EQ(drawn.differ, drawn.all);
        } else if (seen == Sight::hidden) {
          ++hidden;
          ASSERT_EQ(drawn.differ, 0);
        }
      }
    EXPECT_GT(visible, 20) << elevation;
    EXPECT_GT(hidden, elevation == 10 ? 10 : -1);
    EXPECT_GT(visible, elevation == 90 ? 100 : 20);
  }
}

TEST_F(FeaturesOnRelief, lines_have_their_full_width_wherever_their_path_is_visible) {
  std::vector<glm::dvec3> places;
  for (int i = 0; i <= 30; ++i) {
    const double t = i / 30.0;
    places.push_back(on_relief(-0.4 + 0.8 * t, -0.4 + 0.8 * t + 0.05 * std::sin(9 * t)));
  }
  for (const double elevation : {90.0, 50.0, 25.0, 12.0}) {
    const Camera camera = seen_from(elevation, 0.6);
    const auto without = draw_relief(camera, {}), with = draw_relief(camera, {{places, kRed}});
    int visible = 0, hidden = 0;
    for (int i = 20; i <= 980; i += 4) {
      const double t = i / 1000.0;
      const auto at = [](double u) {
        return on_relief(-0.4 + 0.8 * u, -0.4 + 0.8 * u + 0.05 * std::sin(9 * u));
      };
      bool is_visible = true, is_hidden = true;
      for (const double near : {-0.02, -0.01, 0.0, 0.01, 0.02}) {
        // The mark extends beyond its point, so points near it are tested too.
        const Sight seen = sight(camera, at(t + near), near == 0 ? 2 : 1);
        is_visible &= seen == Sight::visible;
        is_hidden &= seen == Sight::hidden;
      }
      if (!is_visible && !is_hidden) continue;
      const glm::dvec2 middle = pixel_of(camera, at(t));
      // The line is straight between its points, so it may be a pixel away from `middle`.
      const int x = static_cast<int>(middle.x), y = static_cast<int>(middle.y);
      if (is_visible) {
        ++visible;
        ASSERT_EQ(pixel(with, x, y), (std::array<int, 3>{kRed[0], kRed[1], kRed[2]}))
            << elevation << " at " << t;
        const auto drawn =
            disc(with, without, middle, render::kLineWidth_px / 2 + render::kFeatureCasing_px / 2);
        ASSERT_EQ(drawn.differ, drawn.all) << elevation << " at " << t;
      } else {
        ++hidden;
        ASSERT_EQ(pixel(with, x, y), pixel(without, x, y)) << elevation << " at " << t;
      }
    }
    EXPECT_GT(visible, elevation > 20 ? 75 : 15) << elevation;
    EXPECT_GT(hidden, elevation == 12 ? 5 : -1);
  }
}

TEST_F(FeaturesOnRelief, symbols_of_a_figure_are_whole_at_every_scale_and_resolution) {
  // A line of 40 straight segments, as the page stores it for a view of a small part of the
  // surface. The segments are up to half a pixel away from the surface.
  std::vector<glm::dvec3> places;
  for (int i = 0; i <= 40; ++i) places.push_back(on_relief(-0.2 + 0.4 * i / 40, 0.13));
  const glm::dvec3 middle = on_relief(0.021, 0.13);
  for (const double elevation : {90.0, 45.0})
    for (const double half_height : {0.02, 0.1, 0.6, 5.0})
      for (const int scale : {1, 6}) {
        SCOPED_TRACE(std::to_string(half_height) + " " + std::to_string(scale) + " " +
                     std::to_string(elevation));
        const Camera camera = seen_from(elevation, half_height, middle);
        const auto without = draw_relief(camera, {}, scale);
        const auto point = disc(draw_relief(camera, {{{middle}, kRed}}, scale), without,
                                pixel_of(camera, middle, scale),
                                scale * (render::kPointWidth_px / 2 + render::kFeatureCasing_px));
        EXPECT_EQ(point.differ, point.all);
        EXPECT_EQ(point.beyond, 0);
        // Expects the complete visible part of the line, without a gap.
        const auto line = draw_relief(camera, {{places, kRed}}, scale);
        int reds = 0, gaps = 0;
        for (double t = 0; t < 1; t += 1e-4) {
          const std::size_t chord = std::min<std::size_t>(static_cast<std::size_t>(t * 40), 39);
          const glm::dvec2 p = pixel_of(
              camera,
              glm::mix(places[chord], places[chord + 1], t * 40 - static_cast<double>(chord)),
              scale);
          if (p.x < 1 || p.y < 1 || p.x >= line.width - 1 || p.y >= line.height - 1) continue;
          const bool red = pixel(line, static_cast<int>(p.x), static_cast<int>(p.y)) ==
                           (std::array<int, 3>{kRed[0], kRed[1], kRed[2]});
          ++(red ? reds : gaps);
        }
        EXPECT_GT(reds, 100);
        EXPECT_EQ(gaps, 0);
      }
}

TEST_F(SurfaceFeatures, what_lies_behind_an_edge_is_hidden_and_what_lies_before_it_is_whole) {
  // Two parallel sheets. Marks on the lower sheet are visible only from below, even next to the
  // edge of the upper sheet.
  const Scene sheets = make_scene(folded_sheets(0.05), 128);
  const auto model = renderer_.add(sheets);
  const auto draw_sheets = [&](const Camera& camera, std::vector<render::DrawnFeature> features) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model);
    request.camera = camera;
    request.width = camera.width, request.height = camera.height;
    if (!features.empty())
      request.style.features =
          std::make_shared<const std::vector<render::DrawnFeature>>(std::move(features));
    auto frame = renderer_.draw(request);
    renderer_->remove_view(request.view);
    return frame;
  };
  glm::dvec3 low(1e9), high(-1e9);
  for (const glm::dvec3& p : sheets.geometry->positions)
    low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 middle = (low + high) / 2.0;
  const auto at = [&](double x, double z) { return glm::dvec3(middle.x + x, middle.y, z); };
  for (const double side : {1.0, -1.0}) {
    const Camera camera =
        orthographic_camera(middle + glm::dvec3(0, 0, 2 * side), middle, kSize, kSize, 1);
    const auto without = draw_sheets(camera, {});
    const double front = side > 0 ? high.z : low.z, back = side > 0 ? low.z : high.z;
    for (const double x : {-0.3, 0.0, 0.3, 0.47}) {
      EXPECT_EQ(draw_sheets(camera, {{{at(x, back)}, kRed}}).pixels, without.pixels) << x;
      EXPECT_NE(draw_sheets(camera, {{{at(x, front)}, kRed}}).pixels, without.pixels) << x;
    }
    EXPECT_EQ(draw_sheets(camera, {{{at(-0.3, back), at(0.3, back)}, kRed}}).pixels,
              without.pixels);
    // A point exactly on the edge is a complete disc, half of it over the background.
    const auto edge = draw_sheets(camera, {{{at(0.499, front)}, kRed}});
    int reds = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        reds += pixel(edge, x, y) == std::array<int, 3>{kRed[0], kRed[1], kRed[2]};
    EXPECT_NEAR(reds, 3.14159 * 4.5 * 4.5, 6);  // the border is mixed with the casing
  }
}

}  // namespace
}  // namespace strata::test
