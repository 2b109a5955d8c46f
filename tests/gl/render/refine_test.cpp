#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <future>
#include <thread>
#include <vector>

#include "render/thread/detail_budget.h"
#include "render/view/accumulation.h"
#include "support/gl_scene.h"

namespace strata::test {
namespace {

constexpr int kWidth = 200, kHeight = 150;
constexpr int kSamples = 16;

using Means = std::vector<double>;  // red, green and blue of each pixel

Means colors(const render::Frame& frame) {
  Means all;
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    if (i % 4 != 3) all.push_back(frame.pixels[i]);
  return all;
}

// A bumpy sphere with classes in rings, which has silhouettes and borders of classes.
class Refine : public testing::Test {
 protected:
  explicit Refine(const render::RendererOptions& options = {})
      : renderer_(options), model_(renderer_.add(make_scene(bumpy_sphere(24), 512))) {
    const auto layer = renderer_.add_layer(model_, ValueType::u8, 512);
    request_.view = renderer_.add_view(model_);
    request_.model = model_;
    request_.camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, kWidth, kHeight);
    request_.width = kWidth;
    request_.height = kHeight;
    for (int ring = 0; ring < 4; ++ring)
      renderer_.paint(layer, dab(request_.camera, 100, 75, 52 - 13 * ring, 1 + ring % 2));
    const Palette classes{
        PaletteMode::categorical, 0, 2, {{1, {230, 159, 0, 255}}, {2, {0, 114, 178, 255}}}, {}};
    request_.style.layers = {{layer, std::make_shared<const Palette>(classes), 1}};
  }
  render::Frame refined(int samples = kSamples) {
    render::FrameRequest request = request_;
    request.samples = samples;
    request.refinement = true;
    return renderer_.draw(request);
  }
  // The oracle: the mean of frames with one sample each. Their cameras are shifted to a regular
  // grid of `side` × `side` points in the pixel. The renderer does not shift these projections;
  // this function does.
  Means reference(int side) {
    Means mean(static_cast<std::size_t>(kWidth) * kHeight * 3, 0.0);
    render::FrameRequest request = request_;
    for (int i = 0; i < side * side; ++i) {
      const int column_of = i % side, row_of = i / side;
      const double x = (column_of + 0.5) / side - 0.5, y = (row_of + 0.5) / side - 0.5;
      request.camera = request_.camera;
      for (int column = 0; column < 4; ++column) {
        auto& p = request.camera.projection[column];
        p[0] += 2 * x / kWidth * p[3];
        p[1] += 2 * y / kHeight * p[3];
      }
      const Means one = colors(renderer_.draw(request));
      for (std::size_t at = 0; at < mean.size(); ++at) mean[at] += one[at] / (side * side);
    }
    return mean;
  }
  static double root_mean_square(const Means& a, const Means& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
  }

  TestRenderer renderer_;
  render::ModelHandle model_;
  render::FrameRequest request_;
};

TEST(RefineSamples, they_cover_a_pixel_evenly_around_its_middle) {
  EXPECT_EQ(render::sample_offset(0, 1), glm::dvec2(0));
  for (const int count : {4, 8, 16, 32, 64}) {
    SCOPED_TRACE(count);
    glm::dvec2 mean{0}, low{1}, high{-1};
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 at = render::sample_offset(i, count);
      mean += at / double(count);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    EXPECT_LT(glm::length(mean), 1e-9);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_LT(high[axis] - low[axis], 1);
      // Each quarter of the range must have about the same number of samples.
      std::array<int, 4> quarters{};
      for (int i = 0; i < count; ++i) {
        const double at = render::sample_offset(i, count)[axis] - low[axis];
        ++quarters[static_cast<std::size_t>(std::min(at / (high[axis] - low[axis]), 0.999) * 4)];
      }
      for (const int in_quarter : quarters) EXPECT_NEAR(in_quarter, count / 4.0, 2);
    }
  }
}

TEST_F(Refine, edges_differ_from_256_samples_by_a_quarter_of_what_one_sample_does_at_most) {
  const Means truth = reference(16);
  const double plain = root_mean_square(colors(renderer_.draw(request_)), truth);
  const double fine = root_mean_square(colors(refined()), truth);
  std::printf("root mean square to 256 samples: 1 sample %.3f, %d samples %.3f\n", plain, kSamples,
              fine);
  EXPECT_GT(plain, 2) << "there are edges";
  EXPECT_LE(fine, plain / 4);
}

// As on a fast GPU: whole frames of the view have five samples.
class Smooth : public Refine {
 protected:
  Smooth()
      : Refine([] {
          render::RendererOptions options;
          options.smooth_samples = render::DetailBudget::kSmoothSamples;
          return options;
        }()) {}
  render::Frame smooth(bool moving = true) {
    render::FrameRequest request = request_;
    request.smooth = true;
    request.moving = moving;
    return renderer_.draw(request);
  }
};

TEST_F(Smooth, edges_in_motion_differ_by_less_than_half_of_what_one_sample_does) {
  const Means truth = reference(16);
  const double plain = root_mean_square(colors(renderer_.draw(request_)), truth);
  const double fine = root_mean_square(colors(smooth()), truth);
  std::printf("root mean square to 256 samples: 1 sample %.3f, %d samples %.3f\n", plain,
              render::DetailBudget::kSmoothSamples, fine);
  EXPECT_LE(fine, plain / 2);
  EXPECT_EQ(smooth(false).pixels, smooth().pixels) << "also of a camera at rest";
}

TEST_F(Smooth, the_view_keeps_its_frame_with_one_sample_and_takes_rectangles) {
  const render::Frame plain = renderer_.draw(request_);
  request_.camera = perspective_camera({1.3, 1.0, 2.3}, {0, 0, 0}, kWidth, kHeight);
  const render::Frame moved = smooth();
  ASSERT_EQ(moved.rects, (std::vector<render::PixelRect>{{0, 0, kWidth, kHeight}}));
  render::FrameRequest part = request_;
  part.smooth = true;
  part.changed = {{glm::vec3(-0.2f), glm::vec3(0.2f)}};
  part.align_to_16 = false;
  const render::Frame changed = renderer_.draw(part);
  ASSERT_EQ(changed.rects.size(), 1u);
  const auto& rect = changed.rects.front();
  ASSERT_LT(rect.width, kWidth) << "the view has the frame of the new camera";
  const render::Frame whole = renderer_.draw(request_);
  EXPECT_NE(whole.pixels, plain.pixels);
  for (int y = 0; y < rect.height; ++y)
    for (int i = 0; i < rect.width * 4; ++i)
      ASSERT_EQ(changed.pixels[static_cast<std::size_t>(y * rect.width * 4 + i)],
                whole.pixels[static_cast<std::size_t>(((rect.y + y) * kWidth + rect.x) * 4 + i)]);
}

TEST_F(Smooth, a_new_style_without_a_new_camera_is_smooth_too) {
  smooth();
  request_.style.background.top = {0, 90, 0, 255};
  const render::Frame restyled = smooth();
  request_.camera = perspective_camera({9, 1.0, 2.4}, {0, 0, 0}, kWidth, kHeight);
  smooth();
  request_.camera = perspective_camera({1.2, 1.0, 2.4}, {0, 0, 0}, kWidth, kHeight);
  EXPECT_EQ(restyled.pixels, smooth().pixels);
}

TEST_F(Smooth, a_frame_without_memory_for_samples_has_one) {
  const auto smooth_frame = [&](TestRenderer& renderer) {
    render::FrameRequest request = request_;
    request.model = renderer.add(make_scene(bumpy_sphere(24), 512));
    request.view = renderer.add_view(request.model);
    request.style.layers.clear();
    request.smooth = true;
    return renderer.draw(request);
  };
  TestRenderer plain;
  const render::Frame one_sample = smooth_frame(plain);
  render::RendererOptions options;
  options.smooth_samples = render::DetailBudget::kSmoothSamples;
  TestRenderer large(options);
  EXPECT_NE(one_sample.pixels, smooth_frame(large).pixels);
  options.gpu_memory_bytes = plain->gpu_bytes_used() + 100'000;
  TestRenderer small(options);
  EXPECT_EQ(one_sample.pixels, smooth_frame(small).pixels);
}

TEST(DetailBudget, takes_samples_only_while_the_gpu_has_time) {
  constexpr std::size_t kPixels = 1280 * 720,
                        kExtra = kPixels * (render::DetailBudget::kSmoothSamples - 1);
  render::DetailBudget software(true), hardware(false);
  EXPECT_EQ(software.samples(kPixels), 1);
  EXPECT_EQ(hardware.samples(kPixels), render::DetailBudget::kSmoothSamples);
  EXPECT_EQ(hardware.samples(64 * kPixels), 1) << "a very large frame";
  for (int i = 0; i < 20; ++i) hardware.smoothed(kExtra, 40);
  EXPECT_EQ(hardware.samples(kPixels), 1) << "it took 40 ms";
  int refused = 0;
  while (hardware.samples(kPixels) == 1 && refused < 100'000) ++refused;
  EXPECT_GT(refused, 300) << "not tried again at once";
  EXPECT_LT(refused, 3000) << "but some time later";
}

TEST_F(Refine, flat_colors_are_the_same) {
  const render::Frame plain = renderer_.draw(request_), fine = refined();
  ASSERT_EQ(fine.rects, (std::vector<render::PixelRect>{{0, 0, kWidth, kHeight}}));
  const auto same_around = [&](std::size_t at) {
    for (const int dy : {-2, -1, 0, 1, 2})
      for (const int dx : {-2, -1, 0, 1, 2})
        for (std::size_t c = 0; c < 3; ++c) {
          const auto other = at + static_cast<std::size_t>(4 * (dy * kWidth + dx)) + c;
          if (std::abs(int(plain.pixels[other]) - int(plain.pixels[at + c])) > 3) return false;
        }
    return true;
  };
  std::size_t flat = 0;
  for (int y = 2; y < kHeight - 2; ++y)
    for (int x = 2; x < kWidth - 2; ++x) {
      const auto at = std::size_t{4} * static_cast<std::size_t>(y * kWidth + x);
      if (!same_around(at)) continue;
      ++flat;
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(plain.pixels[at + c], fine.pixels[at + c], 4) << x << ", " << y;
      ASSERT_EQ(fine.pixels[at + 3], 255);
    }
  EXPECT_GT(flat, std::size_t{kWidth} * kHeight / 3);
}

TEST_F(Refine, the_picture_of_the_view_stays_and_takes_rectangles) {
  const render::Frame before = renderer_.draw(request_);
  refined();
  render::FrameRequest part = request_;
  part.changed = {{glm::vec3(-0.2f), glm::vec3(0.2f)}};
  part.align_to_16 = false;
  const render::Frame changed = renderer_.draw(part);
  ASSERT_EQ(changed.rects.size(), 1u);
  const auto& rect = changed.rects.front();
  ASSERT_LT(rect.width, kWidth) << "the view still had its picture";
  for (int y = 0; y < rect.height; ++y)
    for (int i = 0; i < rect.width * 4; ++i)
      ASSERT_EQ(changed.pixels[static_cast<std::size_t>(y * rect.width * 4 + i)],
                before.pixels[static_cast<std::size_t>(((rect.y + y) * kWidth + rect.x) * 4 + i)]);
}

TEST_F(Refine, a_newer_request_of_its_view_ends_it) {
  // The GPU thread begins when both requests wait.
  std::promise<void> holds, release;
  std::thread holder([&] {
    renderer_->run_on_gpu_thread_for_test([&] {
      holds.set_value();
      release.get_future().wait();
    });
  });
  holds.get_future().wait();
  const auto draw = [&](const render::FrameRequest& request) {
    auto drawn = std::make_shared<std::promise<Result<render::SharedFrame>>>();
    renderer_->draw(request,
                    [drawn](const Result<render::SharedFrame>& frame) { drawn->set_value(frame); });
    return drawn->get_future();
  };
  render::FrameRequest refinement = request_;
  refinement.samples = kSamples;
  refinement.refinement = true;
  auto refined = draw(refinement);
  auto news = draw(request_);
  release.set_value();
  holder.join();
  ASSERT_TRUE(news.get());
  const auto result = refined.get();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::superseded);
}

TEST_F(Refine, wrong_numbers_of_samples_are_refused) {
  for (const int samples : {-1, 0, render::kMaxSamples + 1}) {
    SCOPED_TRACE(samples);
    render::FrameRequest request = request_;
    request.samples = samples;
    const auto frame =
        await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().code, ErrorCode::invalid);
  }
}

TEST_F(Refine, a_picture_to_keep_has_the_same_samples_and_takes_its_turn) {
  const render::Frame fine = refined();
  render::FrameRequest request = request_;
  request.samples = kSamples;
  const render::Frame kept = renderer_.draw(request);
  EXPECT_EQ(kept.rects, fine.rects);
  EXPECT_TRUE(kept.pixels == fine.pixels);
  renderer_->finish();
  EXPECT_EQ(renderer_.draw(request_).pixels.size(), kept.pixels.size());
}

TEST_F(Refine, bands_of_a_picture_to_keep_join_without_a_seam) {
  render::FrameRequest request = request_;
  request.samples = kSamples;
  const render::Frame whole = renderer_.draw(request);
  constexpr int kFirst = 40, kRows = 70, kAround = 16;
  request.camera = camera_of_rows(request_.camera, kFirst - kAround, kRows + 2 * kAround);
  request.height = kRows + 2 * kAround;
  request.background_rows = glm::vec2(kFirst - kAround, kFirst + kRows + kAround) / float(kHeight);
  const render::Frame band = renderer_.draw(request);
  int differ = 0;
  for (int y = 0; y < kRows; ++y)
    for (int i = 0; i < 4 * kWidth; ++i) {
      const auto at = [&](const render::Frame& frame, int row) {
        return int{frame.pixels[std::size_t{4} * static_cast<std::size_t>(kWidth) *
                                    static_cast<std::size_t>(row) +
                                static_cast<std::size_t>(i)]};
      };
      // At an edge, rounding may move one of the sixteen samples to the other side.
      const int difference = std::abs(at(whole, kFirst + y) - at(band, kAround + y));
      differ += difference > 1;
      ASSERT_LE(difference, 2 * 255 / kSamples) << y << ", " << i / 4;
    }
  EXPECT_LT(differ, kRows * kWidth * 4 / 200);
}

TEST_F(Refine, a_short_time_gives_a_picture_to_keep_fewer_samples_and_a_refinement_none) {
  render::FrameRequest request = request_;
  request.samples = render::kMaxSamples;
  request.samples_time = std::chrono::milliseconds(1);
  EXPECT_EQ(renderer_.draw(request).pixels.size(), std::size_t{4} * kWidth * kHeight);
  if (!renderer_->info().software) GTEST_SKIP() << "a GPU has no such limit";
  request.refinement = true;
  const auto frame =
      await<render::SharedFrame>([&](auto done) { renderer_->draw(request, std::move(done)); });
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, ErrorCode::too_large);
}

TEST_F(Refine, its_buffers_are_gone_with_it) {
  renderer_.draw(request_);
  const auto before = renderer_->gpu_bytes_used();
  refined();
  renderer_->finish();  // the job ends after its callback
  EXPECT_EQ(renderer_->gpu_bytes_used(), before);
}

TEST_F(Refine, nothing_is_evicted_for_it) {
  renderer_.draw(request_);
  render::RendererOptions options;
  options.gpu_memory_bytes = renderer_->gpu_bytes_used() + 100'000;
  TestRenderer small(options);
  render::FrameRequest request = request_;
  request.style.layers.clear();
  request.model = small.add(make_scene(bumpy_sphere(24), 512));
  request.view = small.add_view(request.model);
  small.draw(request);
  // The refinement needs so much memory that the view's own buffers, or the surface map, would have
  // to be evicted.
  const auto used = small->gpu_bytes_used();
  request.width = request.height = 2048;
  request.samples = 2;
  request.refinement = true;
  const auto frame =
      await<render::SharedFrame>([&](auto done) { small->draw(request, std::move(done)); });
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, ErrorCode::out_of_memory);
  EXPECT_EQ(small->gpu_bytes_used(), used);
}

}  // namespace
}  // namespace strata::test
