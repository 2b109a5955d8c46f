#include "render/screen_rect.h"

#include <gtest/gtest.h>

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
      const auto rect = screen_rect({&box, 1}, clip_of(camera), 640, 480, i % 2 == 0);
      for (int k = 0; k < 50; ++k) {
        const glm::vec3 t((uniform(random) + 1) / 2, (uniform(random) + 1) / 2, (uniform(random) + 1) / 2);
        const glm::dvec4 clip = clip_of(camera) * glm::dvec4(glm::mix(box.min, box.max, t), 1);
        const double x = (clip.x / clip.w * 0.5 + 0.5) * 640, y = (0.5 - clip.y / clip.w * 0.5) * 480;
        if (x < 0 || y < 0 || x >= 640 || y >= 480) continue;
        EXPECT_TRUE(x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height);
      }
    }
  }
}

TEST(ScreenRect, a_box_around_the_eye_takes_the_whole_picture_and_one_behind_it_nothing) {
  const auto camera = perspective_camera({0, 0, 2}, {0, 0, 0}, 640, 480);
  const render::FrameRequest::Box around{{-1, -1, 1}, {1, 1, 3}}, behind{{-1, -1, 3}, {1, 1, 4}},
      beside{{50, -1, 0}, {51, 1, 0}};
  EXPECT_EQ(screen_rect({&around, 1}, clip_of(camera), 640, 480, true), (PixelRect{0, 0, 640, 480}));
  EXPECT_EQ(screen_rect({&behind, 1}, clip_of(camera), 640, 480, true), PixelRect{});
  EXPECT_EQ(screen_rect({&beside, 1}, clip_of(camera), 640, 480, true), PixelRect{});
}

TEST(ScreenRect, it_grows_to_multiples_of_16_but_not_out_of_the_picture) {
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 650, 470, 1);
  const render::FrameRequest::Box box{{1.2f, -0.9f, 0}, {1.3f, -0.8f, 0}};
  const auto rect = screen_rect({&box, 1}, clip_of(camera), 650, 470, true);
  EXPECT_EQ(rect.x % 16, 0);
  EXPECT_EQ(rect.y % 16, 0);
  EXPECT_TRUE(rect.width % 16 == 0 || rect.x + rect.width == 650);
  EXPECT_TRUE(rect.height % 16 == 0 || rect.y + rect.height == 470);
}

TEST(ScreenRect, rectangles_that_do_not_meet_have_no_intersection) {
  EXPECT_EQ(render::intersection({0, 0, 10, 10}, {5, 6, 10, 10}), (PixelRect{5, 6, 5, 4}));
  EXPECT_EQ(render::intersection({0, 0, 10, 10}, {10, 0, 5, 5}), PixelRect{});
}

}  // namespace
}  // namespace strata::test
