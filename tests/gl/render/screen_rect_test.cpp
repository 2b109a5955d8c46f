#include "render/thread/screen_rect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/gl_scene.h"

namespace strata::test {
namespace {

using render::PixelRect;
using render::screen_rect;

glm::dmat4 clip_of(const Camera& camera) { return camera.projection * camera.view; }

TEST(ScreenRect, every_point_of_a_box_lies_in_its_rectangle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (const auto& camera : {perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 640, 480),
                             orthographic_camera({0, 1, 3}, {0, 0, 0}, 640, 480, 1.5)}) {
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 a(uniform(random), uniform(random), uniform(random)),
          b(uniform(random), uniform(random), uniform(random));
      const render::FrameRequest::Box box{glm::min(a, b), glm::max(a, b)};
      const auto rect = screen_rect(box, clip_of(camera), 640, 480, i % 2 == 0);
      for (int k = 0; k < 50; ++k) {
        const glm::vec3 t((uniform(random) + 1) / 2, (uniform(random) + 1) / 2,
                          (uniform(random) + 1) / 2);
        const glm::dvec4 clip = clip_of(camera) * glm::dvec4(glm::mix(box.min, box.max, t), 1);
        const double x = (clip.x / clip.w * 0.5 + 0.5) * 640,
                     y = (0.5 - clip.y / clip.w * 0.5) * 480;
        if (x < 0 || y < 0 || x >= 640 || y >= 480) continue;
        EXPECT_TRUE(x >= rect.x && x < rect.x + rect.width && y >= rect.y &&
                    y < rect.y + rect.height);
      }
    }
  }
}

TEST(ScreenRect, a_box_around_the_eye_takes_the_whole_picture_and_one_behind_it_nothing) {
  const auto camera = perspective_camera({0, 0, 2}, {0, 0, 0}, 640, 480);
  const render::FrameRequest::Box around{{-1, -1, 1}, {1, 1, 3}}, behind{{-1, -1, 3}, {1, 1, 4}},
      beside{{50, -1, 0}, {51, 1, 0}};
  EXPECT_EQ(screen_rect(around, clip_of(camera), 640, 480, true), (PixelRect{0, 0, 640, 480}));
  EXPECT_EQ(screen_rect(behind, clip_of(camera), 640, 480, true), PixelRect{});
  EXPECT_EQ(screen_rect(beside, clip_of(camera), 640, 480, true), PixelRect{});
}

TEST(ScreenRect, the_pixels_that_outlines_read_are_added_but_none_outside_the_picture) {
  EXPECT_EQ(render::with_neighbors({100, 50, 20, 30}, 640, 480, 1), (PixelRect{97, 47, 26, 36}));
  EXPECT_EQ(render::with_neighbors({100, 50, 20, 30}, 640, 480, 2), (PixelRect{95, 45, 30, 40}));
  EXPECT_EQ(render::with_neighbors({100, 50, 20, 30}, 640, 480, 0.5), (PixelRect{97, 47, 26, 36}));
  EXPECT_EQ(render::with_neighbors({0, 460, 640, 20}, 640, 480, 1), (PixelRect{0, 457, 640, 23}));
}

TEST(ScreenRect, it_grows_to_multiples_of_16_but_not_out_of_the_picture) {
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 650, 470, 1);
  const render::FrameRequest::Box box{{1.2f, -0.9f, 0}, {1.3f, -0.8f, 0}};
  const auto rect = screen_rect(box, clip_of(camera), 650, 470, true);
  EXPECT_EQ(rect.x % 16, 0);
  EXPECT_EQ(rect.y % 16, 0);
  EXPECT_TRUE(rect.width % 16 == 0 || rect.x + rect.width == 650);
  EXPECT_TRUE(rect.height % 16 == 0 || rect.y + rect.height == 470);
}

TEST(ScreenRect, boxes_far_apart_have_rectangles_of_their_own_and_near_ones_share_one) {
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 1280, 720, 1);
  const auto box = [](float x, float y) {
    return render::FrameRequest::Box{{x, y, 0}, {x + 0.05f, y + 0.05f, 0}};
  };
  const auto rects = [&](std::vector<render::FrameRequest::Box> boxes) {
    return render::screen_rects(boxes, clip_of(camera), 1280, 720, true);
  };
  EXPECT_TRUE(rects({}).empty());
  EXPECT_TRUE(rects({box(50, 0)}).empty()) << "outside the window";
  const auto one = rects({box(-1.2f, 0.5f)});
  EXPECT_EQ(one.size(), 1u);
  EXPECT_EQ(rects({box(-1.2f, 0.5f), box(-1.2f, 0.5f)}), one);
  EXPECT_EQ(rects({box(-1.2f, 0.5f), box(-1.15f, 0.5f)}).size(), 1u);
  EXPECT_EQ(rects({box(-1.2f, 0.5f), box(1.2f, -0.5f)}).size(), 2u);
  // The third rectangle is between the two others and joins them.
  EXPECT_EQ(rects({box(-0.1f, 0), box(0.15f, 0), box(0.02f, 0)}).size(), 1u);
}

TEST(ScreenRect, the_rectangles_of_many_boxes_cover_each_of_them_and_are_few) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, 1920, 1080);
  for (int round = 0; round < 100; ++round) {
    std::vector<render::FrameRequest::Box> boxes;
    for (int i = 0; i < 1 + round; ++i) {
      const glm::vec3 low(uniform(random), uniform(random), uniform(random));
      boxes.push_back({low, low + 0.03f});
    }
    const auto rects = render::screen_rects(boxes, clip_of(camera), 1920, 1080, round % 2 == 0);
    ASSERT_LE(rects.size(), render::kMaxScreenRects);
    for (const auto& one : boxes) {
      const auto rect = screen_rect(one, clip_of(camera), 1920, 1080, false);
      EXPECT_TRUE(rect.width == 0 ||
                  std::any_of(rects.begin(), rects.end(), [&](const PixelRect& other) {
                    return render::intersection(rect, other) == rect;
                  }));
    }
  }
}

TEST(ScreenRect, one_around_all_is_taken_where_the_parts_would_be_more) {
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 1920, 1080, 1);
  const auto rects = [&](float share, std::int64_t cost_px = render::kRectCost_px) {
    const float x = 1920.0f / 1080, w = 2 * x * share, h = 2 * share;
    const std::vector<render::FrameRequest::Box> sides{{{-x, -1, 0}, {-x + w, 1, 0}},
                                                       {{x - w, -1, 0}, {x, 1, 0}},
                                                       {{-x, -1, 0}, {x, -1 + h, 0}},
                                                       {{-x, 1 - h, 0}, {x, 1, 0}}};
    return render::screen_rects(sides, clip_of(camera), 1920, 1080, true, cost_px);
  };
  EXPECT_EQ(rects(0.48f), (std::vector<PixelRect>{{0, 0, 1920, 1080}}));
  EXPECT_EQ(rects(0.05f).size(), 4u);
  EXPECT_EQ(rects(0.05f, 1 << 21).size(), 1u) << "what is drawn for each rectangle may be much";
}

TEST(ScreenRect, boxes_beyond_the_limit_grow_around_what_is_near) {
  std::vector<render::FrameRequest::Box> boxes;
  const auto at = [](float x) { return render::FrameRequest::Box{{x, 0, 0}, {x + 1, 1, 1}}; };
  for (const float x : {0.0f, 100.0f, 0.0f, 200.0f}) render::add_box(boxes, at(x), 3);
  ASSERT_EQ(boxes, (std::vector{at(0), at(100), at(200)})) << "one is there already";
  render::add_box(boxes, at(104), 3);
  EXPECT_EQ(boxes,
            (std::vector<render::FrameRequest::Box>{at(0), {{100, 0, 0}, {105, 1, 1}}, at(200)}));
}

TEST(ScreenRect, rectangles_that_do_not_meet_have_no_intersection) {
  EXPECT_EQ(render::intersection({0, 0, 10, 10}, {5, 6, 10, 10}), (PixelRect{5, 6, 5, 4}));
  EXPECT_EQ(render::intersection({0, 0, 10, 10}, {10, 0, 5, 5}), PixelRect{});
}

}  // namespace
}  // namespace strata::test
