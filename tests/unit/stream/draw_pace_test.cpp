#include <gtest/gtest.h>

#include <set>

#include "stream/draw_pace.h"

namespace strata::stream {
namespace {

using namespace std::chrono_literals;

// Draws frames whose time grows with their pixels, and returns the last scale.
double draw(DrawPace& pace, DrawPace::Seconds whole, int frames,
            DrawPace::Seconds for_any_size = 0s) {
  for (int i = 0; i < frames; ++i)
    pace.on_drawn(for_any_size + whole * pace.scale() * pace.scale());
  return pace.scale();
}

TEST(DrawPace, fast_frames_have_the_size_of_the_window) {
  DrawPace pace;
  EXPECT_EQ(draw(pace, 119ms, 100), 1);
}

TEST(DrawPace, slow_frames_become_smaller_until_they_are_fast_enough) {
  DrawPace pace;
  EXPECT_EQ(draw(pace, 200ms, 100), 0.7);
  EXPECT_EQ(draw(pace, 600ms, 100), 0.5);
  EXPECT_EQ(draw(pace, 6000ms, 100), 0.5) << "the smallest size";
}

TEST(DrawPace, one_slow_frame_changes_nothing) {
  DrawPace pace;
  draw(pace, 20ms, 10);
  pace.on_drawn(300ms);
  EXPECT_EQ(pace.scale(), 1);
}

TEST(DrawPace, frames_have_their_size_again_when_the_machine_is_free) {
  DrawPace pace;
  ASSERT_EQ(draw(pace, 600ms, 100), 0.5);
  EXPECT_EQ(draw(pace, 100ms, 100), 0.7) << "100 ms are not short enough";
  EXPECT_EQ(draw(pace, 70ms, 100), 1);
}

TEST(DrawPace, the_size_does_not_alternate) {
  for (DrawPace::Seconds any : {0ms, 50ms, 119ms, 400ms}) {
    for (auto whole = 10ms; whole < 2s; whole += 10ms) {
      DrawPace pace;
      draw(pace, whole, 100, any);
      std::set<double> scales;
      for (int i = 0; i < 100; ++i) scales.insert(draw(pace, whole, 1, any));
      EXPECT_EQ(scales.size(), 1u) << whole.count() << " ms, " << any.count() << " s";
    }
  }
}

}  // namespace
}  // namespace strata::stream
