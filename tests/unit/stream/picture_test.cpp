#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <set>

#include "stream/jpeg_pool.h"
#include "stream/timer_thread.h"
#include "support/gradient.h"

namespace strata::stream {
namespace {

using test::gradient;

struct Decoded {
  int width = 0, height = 0, sampling = 0;
  std::vector<std::uint8_t> rgba;
};

Decoded decode(const std::vector<std::uint8_t>& jpeg) {
  Decoded out;
  tjhandle handle = tjInitDecompress();
  int colorspace = 0;
  EXPECT_EQ(tjDecompressHeader3(handle, jpeg.data(), jpeg.size(), &out.width, &out.height,
                                &out.sampling, &colorspace),
            0);
  out.rgba.resize(std::size_t(out.width) * out.height * 4);
  EXPECT_EQ(tjDecompress2(handle, jpeg.data(), jpeg.size(), out.rgba.data(), out.width, 0,
                          out.height, TJPF_RGBA, 0),
            0);
  tjDestroy(handle);
  return out;
}

render::SharedFrame frame_of(std::vector<std::uint8_t> pixels, int width, int height) {
  render::Frame frame;
  frame.rects = {{0, 0, width, height}};
  frame.width = width;
  frame.height = height;
  frame.pixels = std::move(pixels);
  return std::make_shared<const render::Frame>(std::move(frame));
}

TEST(StreamPicture, the_pool_encodes_every_picture_it_is_given) {
  std::mutex mutex;
  std::condition_variable changed;
  std::multiset<int> widths;
  JpegPool pool(3);
  for (int i = 1; i <= 40; ++i)
    pool.encode(frame_of(gradient(i * 8, 16), i * 8, 16), {},
                [&](const Jpegs& jpegs, double elapsed_ms) {
                  EXPECT_GE(elapsed_ms, 0);
                  const int width = decode(jpegs->at(0)).width;
                  std::lock_guard lock(mutex);
                  widths.insert(width);
                  changed.notify_all();
                });
  std::unique_lock lock(mutex);
  ASSERT_TRUE(
      changed.wait_for(lock, std::chrono::seconds(60), [&] { return widths.size() == 40; }));
  for (int i = 1; i <= 40; ++i) EXPECT_EQ(widths.count(i * 8), 1u);
}

TEST(StreamPicture, a_picture_that_cannot_be_encoded_is_answered_without_bytes) {
  std::mutex mutex;
  std::condition_variable changed;
  bool answered = false;
  JpegPool pool(1);
  pool.encode(frame_of(std::vector<std::uint8_t>(4), 100, 100), {},
              [&](const Jpegs& jpegs, double) {
                std::lock_guard lock(mutex);
                EXPECT_FALSE(jpegs);
                answered = true;
                changed.notify_all();
              });
  std::unique_lock lock(mutex);
  EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] { return answered; }));
}

TEST(StreamPicture, each_rectangle_of_a_frame_is_a_jpeg_of_its_own_pixels) {
  render::Frame frame;
  frame.width = frame.height = 128;
  frame.rects = {{0, 0, 32, 16}, {64, 48, 16, 48}};
  const std::array<std::array<int, 3>, 2> colors{{{200, 40, 40}, {40, 40, 200}}};
  for (std::size_t i = 0; i < 2; ++i)
    for (int pixel = 0; pixel < frame.rects[i].width * frame.rects[i].height; ++pixel) {
      for (const int channel : colors[i])
        frame.pixels.push_back(static_cast<std::uint8_t>(channel));
      frame.pixels.push_back(255);
    }
  std::promise<Jpegs> encoded;
  JpegPool pool(1);
  pool.encode(std::make_shared<const render::Frame>(frame), {90, true},
              [&](const Jpegs& jpegs, double) { encoded.set_value(jpegs); });
  const Jpegs jpegs = encoded.get_future().get();
  ASSERT_TRUE(jpegs && jpegs->size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto picture = decode((*jpegs)[i]);
    ASSERT_EQ(picture.width, frame.rects[i].width);
    ASSERT_EQ(picture.height, frame.rects[i].height);
    for (std::size_t at = 0; at < picture.rgba.size(); ++at)
      if (at % 4 < 3) {
        ASSERT_NEAR(picture.rgba[at], colors[i][at % 4], 4);
      }
  }
}

TEST(StreamPicture, a_picture_for_many_is_encoded_once_for_each_setting) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Jpegs> few, more;
  JpegPool pool(2);
  const auto frame = frame_of(gradient(64, 64), 64, 64);
  const auto into = [&](std::vector<Jpegs>& list) {
    return [&](const Jpegs& jpegs, double) {
      std::lock_guard lock(mutex);
      list.push_back(jpegs);
      changed.notify_all();
    };
  };
  const auto wait_for = [&](std::size_t count) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(60),
                                 [&] { return few.size() + more.size() == count; }));
  };
  for (int i = 0; i < 20; ++i) {
    pool.encode(frame, {20, false}, into(few));
    pool.encode(frame, {90, true}, into(more));
  }
  wait_for(40);
  pool.encode(frame, {20, false}, into(few));  // long after the first encoding of the frame
  wait_for(41);
  EXPECT_EQ(pool.encoded(), 2u);
  for (const Jpegs& jpegs : few) EXPECT_EQ(jpegs, few[0]) << "one object for all";
  EXPECT_LT(few[0]->at(0).size(), more[0]->at(0).size());
  // Another frame with the same pixels must be encoded separately.
  pool.encode(frame_of(gradient(64, 64), 64, 64), {20, false}, into(few));
  wait_for(42);
  EXPECT_EQ(pool.encoded(), 3u);
}

TEST(StreamTimer, calls_come_in_the_order_of_their_times_and_not_before_them) {
  TimerThread timer;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<int> order;
  const auto start = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration last{};
  auto call = [&](int number) {
    return [&, number] {
      std::lock_guard lock(mutex);
      order.push_back(number);
      last = std::chrono::steady_clock::now() - start;
      changed.notify_all();
    };
  };
  timer.after(std::chrono::milliseconds(120), call(3));
  timer.after(std::chrono::milliseconds(0), call(1));
  timer.after(std::chrono::milliseconds(60), call(2));
  std::unique_lock lock(mutex);
  ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] { return order.size() == 3; }));
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
  EXPECT_GE(last, std::chrono::milliseconds(120));
}

TEST(StreamTimer, what_waits_when_it_ends_is_not_called) {
  std::atomic<bool> called{false};
  {
    TimerThread timer;
    timer.after(std::chrono::hours(1), [&] { called = true; });
  }
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace strata::stream
