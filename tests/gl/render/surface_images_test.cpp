#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kSize = 256;
using Color = std::array<int, 3>;

// Returns an image with the pixels `at(x, y)`, top row first.
template <class At>
std::shared_ptr<const render::MipmappedPicture> image_of(int width, int height, At at) {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int channel : at(x, y)) rgba.push_back(static_cast<std::uint8_t>(channel));
  return std::make_shared<const render::MipmappedPicture>(
      render::make_mipmaps(std::move(rgba), width, height, 8192));
}
std::shared_ptr<const render::MipmappedPicture> plain(std::array<int, 4> color) {
  return image_of(8, 8, [&](int, int) { return color; });
}

// A square that fills the frame, with texture coordinates 0.05 … 0.95, seen from the front without
// light.
class SurfaceImages : public testing::Test {
 protected:
  SurfaceImages() : model_(renderer_.add(make_scene(flat_square(), 256))) {
    request_.view = renderer_.add_view(model_);
    request_.camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, kSize, kSize, 0.5);
    request_.width = request_.height = kSize;
    request_.style.light.mode = LightMode::unlit;
  }
  render::SurfaceImageHandle add(std::shared_ptr<const render::MipmappedPicture> image) {
    auto surface_image = await<render::SurfaceImageHandle>(
        [&](auto done) { renderer_->add_surface_image(model_, image, std::move(done)); });
    EXPECT_TRUE(surface_image) << surface_image.error().detail;
    return surface_image.value_or(0);
  }
  Color pixel(int x, int y) {
    const auto frame = renderer_.draw(request_);
    const auto* p = &frame.pixels[4 * static_cast<std::size_t>(y * kSize + x)];
    return {p[0], p[1], p[2]};
  }
  static void expect_near(const Color& got, const Color& expected, int within = 1) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], expected[i], within) << "channel " << i;
  }
  Error refusal(const render::FrameRequest& request) {
    auto frame =
        await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
    EXPECT_FALSE(frame);
    return frame ? Error{} : frame.error();
  }

  TestRenderer renderer_;
  render::ModelHandle model_;
  render::FrameRequest request_;
};

TEST_F(SurfaceImages, the_top_row_of_a_picture_is_the_top_of_the_surface) {
  request_.style.images = {
      {add(image_of(64, 64,
                    [](int x, int y) {
                      return std::array{x < 32 ? 255 : 0, y < 32 ? 200 : 0, 40, 255};
                    })),
       1}};
  expect_near(pixel(60, 60), {255, 200, 40});
  expect_near(pixel(200, 60), {0, 200, 40});
  expect_near(pixel(60, 200), {255, 0, 40});
}

TEST_F(SurfaceImages, they_blend_bottom_to_top_over_the_colours_of_the_vertices) {
  const Color base = pixel(100, 100);
  const auto red = add(plain({255, 0, 0, 255})), clear = add(plain({0, 0, 255, 128}));
  request_.style.images = {{red, 0.25f}};
  expect_near(pixel(100, 100), {base[0] + (255 - base[0]) / 4, base[1] * 3 / 4, base[2] * 3 / 4});
  request_.style.images = {{red, 1}, {clear, 1}};
  expect_near(pixel(100, 100), {127, 0, 128});
  request_.style.images = {{clear, 1}, {red, 1}};
  expect_near(pixel(100, 100), {255, 0, 0});
  request_.style.images = {{red, 1}, {red, 1}, {red, 1}, {clear, 0.5f}};
  expect_near(pixel(100, 100), {191, 0, 64});
  request_.style.images.clear();
  EXPECT_EQ(pixel(100, 100), base);
}

TEST_F(SurfaceImages, a_layer_lies_over_them) {
  request_.style.images = {{add(plain({255, 0, 0, 255})), 1}};
  const auto layer = renderer_.add_layer(model_, ValueType::u8, 256);
  renderer_.paint(layer, dab(request_.camera, 128, 128, 30, 1));
  request_.style.layers = {
      {layer,
       std::make_shared<Palette>(Palette{PaletteMode::step, 0, 1, {{0, {0, 255, 0, 255}, {}}}, {}}),
       1}};
  expect_near(pixel(128, 128), {0, 255, 0});
  expect_near(pixel(20, 20), {255, 0, 0});
}

TEST_F(SurfaceImages, what_a_view_cannot_show_is_refused) {
  const auto surface_image = add(plain({1, 2, 3, 255}));
  request_.style.images.assign(5, {surface_image, 1});
  EXPECT_EQ(refusal(request_).code, ErrorCode::invalid);
  request_.style.images = {{surface_image, std::nanf("")}};
  EXPECT_EQ(refusal(request_).code, ErrorCode::invalid);
  request_.style.images = {{surface_image + 1000, 1}};
  EXPECT_EQ(refusal(request_).code, ErrorCode::not_found);
  request_.style.images = {{surface_image, 1}};
  request_.style.light.direction = {0, 0, 0};
  EXPECT_EQ(refusal(request_).field, "light.direction");
  request_.style.light.direction = {0, 0, 1};
  const auto other = renderer_.add(make_scene(flat_square(), 256));
  request_.view = renderer_.add_view(other);
  EXPECT_EQ(refusal(request_).code, ErrorCode::invalid) << "a look of another model";
}

TEST_F(SurfaceImages, their_memory_is_counted_and_given_back) {
  const auto before = renderer_->gpu_bytes_used();
  const auto image = image_of(512, 256, [](int x, int y) {
    return std::array{x % 256, y, 0, 255};
  });
  const auto surface_image = add(image);
  EXPECT_EQ(renderer_->gpu_bytes_used(), before + image->bytes());
  renderer_->remove_surface_image(surface_image);
  renderer_->finish();
  EXPECT_EQ(renderer_->gpu_bytes_used(), before);
  const auto missing = await<render::SurfaceImageHandle>([&](auto done) {
    renderer_->add_surface_image(model_ + 1000, plain({0, 0, 0, 0}), std::move(done));
  });
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  const auto empty = await<render::SurfaceImageHandle>([&](auto done) {
    renderer_->add_surface_image(model_, std::make_shared<const render::MipmappedPicture>(),
                                 std::move(done));
  });
  EXPECT_EQ(empty.error().code, ErrorCode::invalid);
}

TEST_F(SurfaceImages, a_picture_of_many_megabytes_arrives_whole) {
  request_.style.images = {
      {add(image_of(3000, 2000,
                    [](int x, int y) {
                      return std::array{x * 255 / 2999, (1999 - y) * 255 / 1999, 0, 255};
                    })),
       1}};
  for (const int at : {10, 128, 250}) {
    const double u = 0.05 + 0.9 * (at + 0.5) / kSize;
    const int shade = static_cast<int>(u * 255);
    expect_near(pixel(at, kSize - 1 - at), {shade, shade, 0}, 2);
  }
}

TEST_F(SurfaceImages, fine_detail_seen_from_afar_keeps_its_light) {
  request_.style.images = {
      {add(image_of(
           1024, 1024,
           [](int x, int y) {
             return (x + y) % 2 ? std::array{255, 255, 255, 255} : std::array{0, 0, 0, 255};
           })),
       1}};
  // In sRGB, half of the light is 188 of 255, not 127.
  expect_near(pixel(128, 128), {188, 188, 188}, 2);
}

TEST_F(SurfaceImages, raking_light_shows_what_leans_towards_it) {
  const auto ball = renderer_.add(make_scene(bumpy_sphere(40), 256));
  request_.view = renderer_.add_view(ball);
  request_.camera = orthographic_camera({0, 0, 4}, {0, 0, 0}, kSize, kSize, 1.25);
  // Take the mean of a patch, because the ball is bumpy.
  const auto bright = [&](int center) {
    const auto frame = renderer_.draw(request_);
    double sum = 0;
    for (int y = 98; y < 158; ++y)
      for (int x = center - 15; x < center + 15; ++x)
        sum += frame.pixels[4 * static_cast<std::size_t>(y * kSize + x)];
    return sum / (60 * 30);
  };
  constexpr int kLeft = 65, kMiddle = 128, kRight = 191;
  request_.style.light = {LightMode::raking, {-1, 0, 0.2}};
  EXPECT_GT(bright(kLeft), bright(kMiddle) + 25);
  EXPECT_LT(bright(kRight), 40) << "the side away from the light is dark";
  request_.style.light.direction = {5, 0, 1};
  EXPECT_GT(bright(kRight), bright(kMiddle) + 25);
  EXPECT_LT(bright(kLeft), 40);
  request_.style.light.mode = LightMode::headlight;
  EXPECT_GT(bright(kMiddle), bright(kLeft) + 20);
  EXPECT_NEAR(bright(kLeft), bright(kRight), 20) << "as bright on both sides";
  const double lit = bright(kMiddle);
  request_.style.light.mode = LightMode::unlit;
  EXPECT_EQ(bright(kLeft), bright(kRight));
  EXPECT_GE(bright(kMiddle), lit);
}

// Returns the standard light on an open plane with this normal, in the axes of the eye.
double museum_light(const glm::dvec3& normal, double openness = 1) {
  const auto from = [&](const glm::dvec3& direction) {
    return glm::dot(normal, glm::normalize(direction));
  };
  const double key = std::max(0.0, 0.83 * from({-0.45, 0.60, 0.75}) + 0.17),
               fill = std::max(0.0, 0.71 * from({0.80, 0.05, 0.45}) + 0.29),
               rim = std::max(0.0, from({0.35, 0.75, -0.45})), sky = 0.5 + 0.5 * from({0, 1, 0.15});
  const double light =
      std::sqrt(0.73 * key + 0.26 * rim + openness * (0.26 * fill + 0.12 + 0.19 * sky));
  return std::min(light, 0.65 + 0.33 * light);
}

// Returns the color under a light without exposure, which clips at 255.
Color lit(const Color& color, double light) {
  Color at = color;
  for (auto& channel : at)
    channel = static_cast<int>(std::lround(std::min(255.0, channel * light)));
  return at;
}

// Returns one channel of a color after exposure, as the frame shows it.
int exposed(const Color& color, std::size_t channel, double factor) {
  const double peak = factor * *std::ranges::max_element(color) / 255;
  const double over = std::max(0.0, peak - 0.9);
  const double shown = std::min(peak, 0.9) + 0.1 * over / (over + 0.1);
  return static_cast<int>(std::lround(color[channel] * factor * shown / peak));
}
Color exposed(const Color& color, double factor) {
  return {exposed(color, 0, factor), exposed(color, 1, factor), exposed(color, 2, factor)};
}

TEST_F(SurfaceImages,
       museum_light_is_the_same_in_each_pixel_as_at_the_vertices_of_small_triangles) {
  // With two triangles, the light is computed in each pixel. With 80,000 triangles of less than two
  // pixels, it is computed at their vertices.
  for (const int quads : {1, 200}) {
    request_.view = renderer_.add_view(renderer_.add(make_scene(flat_square(quads), 256)));
    for (const glm::dvec3 eye :
         {glm::dvec3{0, 0, 2}, {-1, 1, 1}, {1.5, -1, 1}, {-1, -0.5, -1}, {0.2, 0.3, -2}}) {
      request_.camera = orthographic_camera(eye, {0, 0, 0}, kSize, kSize, 0.5);
      const glm::dvec3 up = glm::dmat3(request_.camera.view) * glm::dvec3(0, 0, 1);
      request_.style.light.mode = LightMode::unlit;
      const Color plain = pixel(kSize / 2, kSize / 2);
      // From behind, the square must be as bright as from the front.
      const Color expected = lit(plain, museum_light(eye.z > 0 ? up : -up));
      request_.style.light.mode = LightMode::museum;
      SCOPED_TRACE(std::to_string(quads) + " quads, eye at " + std::to_string(eye.x) + " " +
                   std::to_string(eye.z));
      expect_near(pixel(kSize / 2, kSize / 2), expected, 2);
    }
  }
}

TEST_F(SurfaceImages, exposure_brightens_the_surface_and_rolls_off_what_is_too_bright) {
  request_.style.images = {{add(plain({30, 39, 25, 255}))}};
  const Color dark{30, 39, 25};
  expect_near(pixel(kSize / 2, kSize / 2), dark, 0);
  for (const double ev : {-3.0, -1.0, 0.5, 2.0, 3.0}) {
    SCOPED_TRACE(ev);
    request_.style.light.exposure_ev = ev;
    expect_near(pixel(kSize / 2, kSize / 2), exposed(dark, std::exp2(ev / 2)));
  }
  // Exposure must not change the proportions of the channels, so orange stays orange.
  const Color orange{230, 120, 40};
  request_.style.images = {{add(plain({230, 120, 40, 255}))}};
  expect_near(pixel(kSize / 2, kSize / 2), exposed(orange, std::exp2(1.5)));
  EXPECT_LT(pixel(kSize / 2, kSize / 2)[0], 255);
  request_.style.light.exposure_ev = 0;
  expect_near(pixel(kSize / 2, kSize / 2), orange, 0);
}

TEST_F(SurfaceImages, a_fill_lights_the_shadows_of_raking_light) {
  const auto at = [&](double fill, const glm::dvec3& direction) {
    request_.style.light = {LightMode::raking, direction, 0, fill};
    return pixel(kSize / 2, kSize / 2)[0];
  };
  request_.style.light.mode = LightMode::unlit;
  const int plain = pixel(kSize / 2, kSize / 2)[0];
  // The fill must not change the brightness of a plane that faces the viewer.
  for (const double fill : {0.0, 0.3, 1.0}) EXPECT_NEAR(at(fill, {-1, 0, 0.3}), plain * 0.54, 2);
  // In a shadow, all light comes from the fill.
  request_.camera = orthographic_camera({1.2, 0, 1.6}, {0, 0, 0}, kSize, kSize, 0.5);
  for (const double fill : {0.0, 0.3, 1.0})
    EXPECT_NEAR(at(fill, {1, 0, 0.1}), plain * (0.04 + fill * 0.5 * 0.8), 2);
}

TEST_F(SurfaceImages, the_numbers_of_a_light_are_in_their_ranges) {
  const auto field = [&](const Light& light) {
    request_.style.light = light;
    return refusal(request_).field;
  };
  EXPECT_EQ(field({LightMode::museum, {0, 0, 1}, 3.01}), "light.exposure");
  EXPECT_EQ(field({LightMode::museum, {0, 0, 1}, std::nan("")}), "light.exposure");
  EXPECT_EQ(field({LightMode::raking, {0, 0, 1}, 0, -0.01}), "light.fill");
  EXPECT_EQ(field({LightMode::raking, {0, 0, 1}, 0, 0, 1.01}), "light.layer_opacity");
}

TEST_F(SurfaceImages, a_cavity_gets_less_of_the_sky) {
  auto scene = make_scene(flat_square(), 256);
  mesh::Geometry dark = *scene.geometry;
  for (auto& vertex : dark.vertices) vertex.color &= 0x40ffffffu;
  const auto view = [&](std::shared_ptr<const mesh::Geometry> geometry) {
    Scene of{scene};
    of.geometry = std::move(geometry);
    request_.view = renderer_.add_view(renderer_.add(of));
    return pixel(kSize / 2, kSize / 2);
  };
  const Color plain = view(scene.geometry);
  EXPECT_EQ(view(std::make_shared<const mesh::Geometry>(dark)), plain) << "without light";
  request_.style.light.mode = LightMode::museum;
  expect_near(view(std::make_shared<const mesh::Geometry>(dark)),
              lit(plain, museum_light({0, 0, 1}, 64.0 / 255)), 2);
}

TEST_F(SurfaceImages, a_view_is_drawn_anew_when_only_its_light_changes) {
  const auto unlit = renderer_.draw(request_).pixels;
  request_.style.light.mode = LightMode::museum;
  const auto museum = renderer_.draw(request_).pixels;
  EXPECT_NE(unlit, museum);
  request_.style.light.mode = LightMode::unlit;
  EXPECT_EQ(renderer_.draw(request_).pixels, unlit);
}

TEST(MipmappedPicture, levels_halve_down_to_one_texel_and_those_too_large_are_left_out) {
  const auto image = render::make_mipmaps(std::vector<std::uint8_t>(4 * 100 * 7, 50), 100, 7, 30);
  ASSERT_EQ(image.levels.size(), 5u);
  EXPECT_EQ(image.levels[0].width, 25);
  EXPECT_EQ(image.levels[0].height, 1);
  EXPECT_EQ(image.levels.back().width, 1);
  for (const auto& level : image.levels)
    for (const auto value : level.rgba) EXPECT_EQ(value, 50);
}

TEST(MipmappedPicture, clear_texels_do_not_darken_their_neighbours) {
  const auto image = render::make_mipmaps(
      {200, 100, 50, 255, 0, 0, 0, 0, 0, 0, 0, 0, 200, 100, 50, 255}, 2, 2, 8192);
  ASSERT_EQ(image.levels.size(), 2u);
  EXPECT_EQ(image.levels[1].rgba, (std::vector<std::uint8_t>{200, 100, 50, 128}));
}

}  // namespace
}  // namespace strata::test
