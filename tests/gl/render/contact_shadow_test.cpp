#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/analysis/contact_shadow.h"
#include "shared/contact_shadow.h"
#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kWidth = 240, kHeight = 180;
constexpr int kSize = mesh::ContactShadow::kSize;

// A bumpy sphere on its floor.
class ContactShadow : public testing::Test {
 protected:
  ContactShadow()
      : scene_(make_scene(bumpy_sphere(24), 256)),
        model_(renderer_.add(scene_)),
        layer_(renderer_.add_layer(model_, ValueType::u8, 256)),
        shadow_(mesh::contact_shadow(*scene_.geometry, "z")) {
    request_.view = renderer_.add_view(model_);
    request_.model = model_;
    request_.width = kWidth;
    request_.height = kHeight;
    request_.style.background = {{200, 200, 200, 255}, {200, 200, 200, 255}};
    look({2.0, 1.5, 2.5});
  }
  void look(const glm::dvec3& eye) {
    request_.camera = perspective_camera(eye, {0, 0, -0.4}, kWidth, kHeight);
  }
  render::Frame drawn(bool with_shadow) {
    request_.style.contact_shadow = with_shadow ? shadow_ : nullptr;
    return renderer_.draw(request_);
  }
  // The oracle: the cover where the ray through the center of a pixel meets the floor, interpolated
  // between the four nearest texels of the map.
  double cover(int x, int y) const {
    const glm::dmat4 world_from_clip =
        glm::inverse(request_.camera.projection * request_.camera.view);
    const auto unproject = [&](double depth) {
      const glm::dvec4 p = world_from_clip * glm::dvec4(2 * (x + 0.5) / kWidth - 1,
                                                        1 - 2 * (y + 0.5) / kHeight, depth, 1);
      return glm::dvec3(p) / p.w - scene_.geometry->origin;
    };
    const glm::dvec3 eye = unproject(-1), direction = unproject(0.5) - eye;
    const glm::dvec3 corner(shadow_->corner), up(shadow_->up);
    const double along = glm::dot(corner - eye, up) / glm::dot(direction, up);
    if (!(along > 0)) return 0;
    const glm::dvec3 hit = eye + along * direction - corner;
    const auto texel = [&](const glm::vec3& side) {
      return glm::dot(hit, glm::dvec3(side)) / glm::dot(glm::dvec3(side), glm::dvec3(side)) *
                 kSize -
             0.5;
    };
    const double column = texel(shadow_->along_row), row = texel(shadow_->along_column);
    const auto at = [&](double c, double r) {
      const auto clamped = [](double v) {
        return static_cast<std::size_t>(std::clamp(v, 0.0, kSize - 1.0));
      };
      return double(shadow_->cover[clamped(r) * kSize + clamped(c)]);
    };
    const double c = std::floor(column), r = std::floor(row), u = column - c, v = row - r;
    return ((at(c, r) * (1 - u) + at(c + 1, r) * u) * (1 - v) +
            (at(c, r + 1) * (1 - u) + at(c + 1, r + 1) * u) * v) /
           255;
  }
  std::vector<bool> background() {
    const auto depth = renderer_.depth(scene_, request_.camera);
    std::vector<bool> is_background;
    for (int y = kHeight - 1; y >= 0; --y)
      for (int x = 0; x < kWidth; ++x)
        is_background.push_back(
            depth[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] == 1);
    return is_background;
  }

  TestRenderer renderer_;
  Scene scene_;
  render::ModelHandle model_;
  render::LayerHandle layer_;
  std::shared_ptr<const mesh::ContactShadow> shadow_;
  render::FrameRequest request_;
};

TEST_F(ContactShadow, darkens_the_background_as_computed_on_the_cpu_and_nothing_else) {
  const Camera cameras[]{perspective_camera({2.0, 1.5, 2.5}, {0, 0, -0.4}, kWidth, kHeight),
                         perspective_camera({0.6, 0.4, 3.5}, {0, 0.5, -1}, kWidth, kHeight),
                         perspective_camera({3, 0, -0.6}, {0, 0, -0.9}, kWidth, kHeight, 80),
                         orthographic_camera({2, 2, 2}, {0, 0, -0.5}, kWidth, kHeight, 1.8)};
  for (const Camera& camera : cameras) {
    request_.camera = camera;
    const auto plain = drawn(false), shaded = drawn(true);
    const auto is_background = background();
    int darkened = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto pixel = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        const double before = plain.pixels[4 * pixel], after = shaded.pixels[4 * pixel];
        if (!is_background[pixel]) {
          ASSERT_EQ(before, after) << x << ", " << y;
          continue;
        }
        const double factor = 1 - double(shader::kContactShadowStrength) * cover(x, y);
        ASSERT_NEAR(after, before * factor, 1.5) << x << ", " << y;
        darkened += factor < 0.99;
      }
    EXPECT_GT(darkened, 100);
  }
}

TEST_F(ContactShadow, is_absent_from_below_and_with_a_section) {
  look({2.0, 1.5, -2.5});
  EXPECT_EQ(drawn(false).pixels, drawn(true).pixels) << "the floor is seen from below";
  look({2.0, 1.5, 2.5});
  ASSERT_NE(drawn(false).pixels, drawn(true).pixels);
  request_.camera.section = {{1, 0, 0, 0}};
  EXPECT_EQ(drawn(false).pixels, drawn(true).pixels);
}

TEST_F(ContactShadow, is_in_rectangles_and_refinements_too) {
  auto palette = std::make_shared<const Palette>(
      Palette{PaletteMode::categorical, 0, 9, {{7, {230, 20, 20, 255}}}, {}});
  request_.style.layers = {{layer_, palette, 1}};
  auto whole = drawn(true);
  const auto outcome = renderer_.paint(layer_, dab(request_.camera, 120, 90, 40));
  auto part_request = request_;
  part_request.changed = {{outcome.written_min, outcome.written_max}};
  const auto part = renderer_.draw(part_request);
  ASSERT_EQ(part.rects.size(), 1U);
  ASSERT_LT(part.rects.front().height, kHeight) << "a part";
  put(whole, part);
  EXPECT_EQ(whole.pixels, renderer_.draw(request_).pixels);

  auto refined_request = request_;
  refined_request.samples = 16;
  const auto refined = renderer_.draw(refined_request);
  const auto is_background = background();
  double error = 0;
  int count = 0;
  for (int y = 1; y + 1 < kHeight; ++y)
    for (int x = 1; x + 1 < kWidth; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      // Compare only pixels with background around them, because no edge of the model is there.
      bool inner = true;
      for (const auto other : {pixel, pixel - 1, pixel + 1, pixel - kWidth, pixel + kWidth})
        inner = inner && is_background[other];
      if (!inner) continue;
      error =
          std::max(error, std::abs(double(refined.pixels[4 * pixel]) - whole.pixels[4 * pixel]));
      ++count;
    }
  EXPECT_GT(count, 1000);
  EXPECT_LE(error, 3);
}

}  // namespace
}  // namespace strata::test
