#include <gtest/gtest.h>

#include "mesh/analysis/contact_shadow.h"
#include "support/gl_scene.h"

namespace strata::test {
namespace {

using Box = render::FrameRequest::Box;

constexpr int kWidth = 640, kHeight = 480, kResolution = 512;
constexpr render::PixelRect kWhole{0, 0, kWidth, kHeight};
constexpr std::uint64_t kBytes = std::uint64_t{16} * kWidth * kHeight;  // buffers of one view
constexpr int kViews = 8;  // views of this size that have buffers at the same time
constexpr std::uint32_t kOutlined = 10, kHatched = 30, kDotted = 60, kOther = 90;

std::shared_ptr<const Palette> patterned_palette() {
  Palette palette{PaletteMode::categorical, 0, 255, {}, {}, Rgba{120, 120, 120, 255}};
  const auto add = [&](std::uint32_t value, Rgba color, Pattern pattern) {
    Palette::Point point{static_cast<double>(value), color};
    point.pattern = pattern;
    palette.points.push_back(std::move(point));
  };
  add(kOutlined, {200, 30, 30, 255}, Pattern::outline);
  add(kHatched, {30, 160, 30, 255}, Pattern::hatch);
  add(kDotted, {30, 30, 200, 255}, Pattern::dots);
  add(kOther, {200, 200, 30, 255}, Pattern::solid);
  return std::make_shared<const Palette>(std::move(palette));
}

// Rectangles of views that have lost their buffers.
class Parts : public testing::Test {
 protected:
  Parts() : Parts(30) {}
  explicit Parts(int quads_per_edge)
      : scene_(make_scene(bumpy_sphere(quads_per_edge), kResolution)),
        model_(renderer_.add(scene_)),
        layer_(renderer_.add_layer(model_, ValueType::u8, kResolution)) {}

  static render::RendererOptions options() {
    render::RendererOptions options;
    options.gpu_memory_bytes = 160u << 20;  // a quarter is the memory of eight views
    return options;
  }
  // `scale` is the number of frame pixels per pixel of the window.
  render::FrameRequest request_from(const glm::dvec3& eye, int scale = 1) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model_);
    request.camera = perspective_camera(eye, {0, 0, 0}, kWidth / scale, kHeight / scale);
    request.width = kWidth, request.height = kHeight;
    request.style.layers = {{layer_, patterned_palette(), 0.8f}};
    return request;
  }
  // Draws the frames of so many other views that all earlier views lose their buffers.
  void take_buffers() {
    std::vector<render::ViewHandle> others;
    for (int i = 0; i < kViews; ++i) {
      auto request = request_from({2.4, 0.1 * i, 1.2});
      renderer_.draw(request);
      others.push_back(request.view);
    }
    for (const auto view : others) renderer_->remove_view(view);
  }
  Box paint(const Camera& camera, double x, double y, double radius, std::uint32_t value) {
    const auto outcome = renderer_.paint(layer_, dab(camera, x * camera.width, y * camera.height,
                                                     radius * camera.width / kWidth, value));
    return {outcome.written_min, outcome.written_max};
  }
  // Fills the buffers that views share with another picture. All its pixels differ from those of
  // the tested views: it shows the other side from nearby.
  void spoil_shared_buffers(const render::FrameRequest& other) {
    auto request = other;
    request.changed = {{glm::vec3(-1.3f), glm::vec3(1.3f)}};
    const auto part = renderer_.draw(request);
    ASSERT_FALSE(part.rects.empty());
  }
  // Draws the view's frame, takes its buffers, paints and then expects that the rectangles of the
  // changes have the pixels of a whole frame.
  void expect_parts_equal_the_whole(const render::FrameRequest& request, std::vector<Box> changed) {
    Camera uncut = request.camera;
    uncut.section.clear();
    paint(uncut, 0.4, 0.45, 110, kOutlined);
    paint(uncut, 0.6, 0.55, 70, kHatched);
    paint(uncut, 0.45, 0.7, 60, kDotted);
    auto other = request_from({-0.4, 0.3, -1.7});
    other.style.background = {{5, 90, 5, 255}, {90, 5, 90, 255}};
    auto picture = renderer_.draw(request);
    renderer_.draw(other);
    take_buffers();

    for (const glm::dvec2 at : {glm::dvec2(0.4, 0.45), {0.61, 0.56}, {0.45, 0.69}})
      changed.push_back(paint(uncut, at.x, at.y, 9, kOther));
    for (const Box& box : changed) {
      spoil_shared_buffers(other);
      auto one = request;
      one.changed = {box};
      const auto part = renderer_.draw(one);
      ASSERT_FALSE(part.rects.empty());
      ASSERT_NE(part.rects.at(0), kWhole) << "a part was requested";
      put(picture, part);
    }
    EXPECT_EQ(picture.pixels, renderer_.draw(request).pixels);
    renderer_->remove_view(request.view);
    renderer_->remove_view(other.view);
  }

  TestRenderer renderer_{options()};
  Scene scene_;
  render::ModelHandle model_;
  render::LayerHandle layer_;
};

TEST_F(Parts, patterns_and_outlines_at_the_border_of_a_part_are_those_of_the_whole_frame) {
  expect_parts_equal_the_whole(request_from({1.2, 1.0, 2.4}), {});
}

TEST_F(Parts, outlines_are_also_whole_in_frames_with_more_pixels_than_the_window) {
  expect_parts_equal_the_whole(request_from({1.2, 1.0, 2.4}, 2), {});
}

TEST_F(Parts, a_part_at_the_border_of_the_frame_equals_the_whole_frame) {
  expect_parts_equal_the_whole(request_from({0.5, 0.4, 1.5}),
                               {{{-0.95f, -0.1f, -0.1f}, {-0.6f, 0.1f, 0.3f}}});
}

TEST_F(Parts, a_part_of_a_cut_has_no_outline_at_its_border) {
  auto request = request_from({0.4, 0.3, 2.8});
  request.camera.section = {{0, 0, -1, 0.3}};  // keeps z below 0.3, and the eye is cut away
  expect_parts_equal_the_whole(request, {{{-0.1f, -0.1f, 0.28f}, {0.1f, 0.1f, 0.3f}}});
}

TEST_F(Parts, lines_points_and_the_contact_shadow_are_those_of_the_whole_frame) {
  auto request = request_from({1.2, 1.0, 2.4});
  request.style.features = std::make_shared<const std::vector<render::DrawnFeature>>(
      std::vector<render::DrawnFeature>{{{{-0.5, 0.1, 1.0}, {0.7, 0.3, 0.8}}, {200, 0, 0, 255}},
                                        {{{0.5, 0.3, 0.85}}, {0, 0, 200, 255}}});
  request.style.contact_shadow = mesh::contact_shadow(*scene_.geometry, "z");
  expect_parts_equal_the_whole(request, {{{-1.2f, -1.2f, -1.1f}, {-0.7f, -0.7f, -0.9f}}});
}

TEST_F(Parts, views_whose_frames_grow_do_not_exceed_the_limit_of_buffers) {
  std::vector<render::FrameRequest> requests;
  for (int i = 0; i < 3 * kViews; ++i) {
    requests.push_back(request_from({1.2, 0.05 * i, 2.4}));
    requests.back().width = kWidth / 4, requests.back().height = kHeight / 4;
  }
  renderer_.draw(requests.front());
  const auto before = renderer_->gpu_bytes_used();
  for (const auto& request : requests) renderer_.draw(request);
  for (auto& request : requests) {
    request.width = kWidth, request.height = kHeight;
    EXPECT_EQ(renderer_.draw(request).rects.at(0), kWhole);
    // A few depth buffers of earlier cameras stay too.
    EXPECT_LE(renderer_->gpu_bytes_used(), before + options().gpu_memory_bytes / 4 + 2 * kBytes);
  }
}

TEST_F(Parts, a_view_that_has_lost_many_marks_draws_the_whole_frame) {
  auto request = request_from({1.2, 1.0, 2.4});
  for (const int count : {5, 2000}) {
    std::vector<render::DrawnFeature> points;
    for (int i = 0; i < count; ++i)
      points.push_back({{{-0.5 + 0.0005 * i, 0.3, 0.85}}, {0, 0, 200, 255}});
    request.style.features =
        std::make_shared<const std::vector<render::DrawnFeature>>(std::move(points));
    request.changed.reset();
    auto picture = renderer_.draw(request);
    take_buffers();
    request.changed = {paint(request.camera, 0.5, 0.5, 9, kOther)};
    const auto part = renderer_.draw(request);
    EXPECT_EQ(part.rects.at(0) == kWhole, count == 2000);
    put(picture, part);
    request.changed.reset();
    EXPECT_EQ(picture.pixels, renderer_.draw(request).pixels);
  }
}

TEST_F(Parts, a_painter_who_has_lost_the_buffers_gets_them_back_and_keeps_them) {
  auto request = request_from({1.2, 1.0, 2.4});
  renderer_.draw(request);
  take_buffers();
  request.acting = true;
  request.changed = {paint(request.camera, 0.5, 0.5, 9, kOther)};
  EXPECT_EQ(renderer_.draw(request).rects.at(0), kWhole);
  take_buffers();
  // The views of onlookers have lost their buffers instead, so this is only a rectangle.
  request.changed = {paint(request.camera, 0.4, 0.5, 9, kOutlined)};
  EXPECT_NE(renderer_.draw(request).rects.at(0), kWhole);
}

// Draws a request whose changes arrive while it waits: they are known when the frame asks for them.
struct LateDraw {
  render::Frame frame;
  int asked = 0;
};
LateDraw draw_with_late(render::Renderer& renderer, const render::FrameRequest& request,
                        const std::vector<Box>& late) {
  // The callback runs on the GPU thread, before the answer.
  const auto asked = std::make_shared<int>(0);
  const auto drawn = await<render::SharedFrame>([&](auto done) {
    renderer.draw(request, std::move(done), [asked, late] {
      ++*asked;
      return late;
    });
  });
  EXPECT_TRUE(drawn.has_value());
  return {drawn ? **drawn : render::Frame(), *asked};
}

TEST_F(Parts, a_frame_shows_the_changes_that_arrived_while_it_waited) {
  for (const bool has_buffers : {true, false}) {
    SCOPED_TRACE(has_buffers);
    auto request = request_from({1.2, 1.0, 2.4});
    auto picture = renderer_.draw(request);
    if (!has_buffers) take_buffers();
    request.changed = {paint(request.camera, 0.41, 0.38, 9, has_buffers ? kOther : kHatched)};
    const Box late = paint(request.camera, 0.625, 0.625, 9, has_buffers ? kOutlined : kDotted);
    const auto part = draw_with_late(renderer_.get(), request, {late});
    EXPECT_EQ(part.asked, 1);
    EXPECT_EQ(part.frame.rects.size(), 2u) << "one rectangle for the late change";
    put(picture, part.frame);
    request.changed.reset();
    const auto whole = draw_with_late(renderer_.get(), request, {late});
    EXPECT_EQ(whole.asked, 1) << "the requester learns that the frame shows the change";
    EXPECT_EQ(whole.frame.rects.at(0), kWhole);
    EXPECT_EQ(picture.pixels, whole.frame.pixels);
    // Only the late change is drawn if the request itself has none on the screen.
    request.changed.emplace();
    EXPECT_EQ(draw_with_late(renderer_.get(), request, {late}).frame.rects.size(), 1u);
    renderer_->remove_view(request.view);
  }
}

// So many clusters are culled by the depth of the nearer ones, which is that of another view
// outside the part.
class PartsOfManyClusters : public Parts {
 protected:
  PartsOfManyClusters() : Parts(180) {}
};

TEST_F(PartsOfManyClusters, equal_the_whole_frame) {
  expect_parts_equal_the_whole(request_from({1.2, 1.0, 2.4}),
                               {{glm::vec3(-0.6f), glm::vec3(0.6f)}});
}

}  // namespace
}  // namespace strata::test
