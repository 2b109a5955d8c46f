#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "stream/link_pace.h"

namespace strata::stream {
namespace {

using namespace std::chrono_literals;
using Clock = LinkPace::Clock;

// Simulates a link with a delay and a rate, and a renderer that makes a frame whenever fewer frames
// than the window of `pace` are unacknowledged. Time is simulated too.
class Simulation {
 public:
  Clock::duration delay = 0ms;  // round trip
  double bytes_per_s = 1e9;
  Clock::duration drawing = 25ms;
  Clock::duration showing = 0ms;  // time of the browser for a frame of any size
  bool moving = true;

  LinkPace pace;

  // Returns the number of moving frames that are shown in this time.
  int run(Clock::duration how_long) {
    const auto end = now_ + how_long;
    int shown = 0;
    while (now_ < end) {
      const bool may_send = sent_ - acked_ < std::uint64_t(pace.window());
      const auto next_ack =
          arrivals_.empty() ? Clock::time_point::max() : arrivals_.begin()->second;
      if (may_send && now_ + drawing <= next_ack) {
        now_ += drawing;
        send();
      } else if (next_ack != Clock::time_point::max()) {
        now_ = std::max(now_, next_ack);
        acked_ = arrivals_.begin()->first;
        arrivals_.erase(arrivals_.begin());
        pace.on_ack(acked_, now_);
        ++shown;
        if (took_longest_ < now_ - sent_at_[acked_]) took_longest_ = now_ - sent_at_[acked_];
      }
    }
    return shown;
  }
  Clock::duration longest() { return std::exchange(took_longest_, 0ms); }

 private:
  void send() {
    static constexpr double kBytes = 60e3;
    const MovingPicture picture = pace.moving();
    const double bytes = moving ? kBytes * picture.scale * picture.scale *
                                      (0.3 + 0.7 * picture.jpeg.quality / 75.0) *
                                      (picture.jpeg.full_color ? 1.5 : 1)
                                : 3 * kBytes;
    pace.on_sent(++sent_, static_cast<std::size_t>(bytes), moving, now_);
    sent_at_[sent_] = now_;
    link_free_ =
        std::max(link_free_, now_) + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(bytes / bytes_per_s));
    browser_free_ = std::max(browser_free_, link_free_ + delay) + showing;
    arrivals_[sent_] = browser_free_;
  }

  Clock::time_point now_{};
  Clock::time_point link_free_{}, browser_free_{};
  std::map<std::uint64_t, Clock::time_point> arrivals_, sent_at_;
  std::uint64_t sent_ = 0, acked_ = 0;
  Clock::duration took_longest_{};
};

TEST(LinkPace, a_fast_link_has_pictures_as_they_are) {
  Simulation link;
  link.run(60s);
  EXPECT_EQ(link.pace.step(), 0);
  EXPECT_EQ(link.pace.moving(), (MovingPicture{{80, true}, 1}));
  EXPECT_EQ(link.pace.window(), 2);
}

TEST(LinkPace, a_picture_at_rest_that_came_fast_gives_the_first_moving_ones_full_color) {
  Simulation link;
  link.moving = false;
  link.run(100ms);
  EXPECT_TRUE(link.pace.moving().jpeg.full_color);
}

TEST(LinkPace, full_color_comes_with_100_Mbit_and_not_with_50) {
  for (const auto& [bytes_per_s, full] : {std::pair{100e6 / 8, true}, {50e6 / 8, false}}) {
    SCOPED_TRACE(bytes_per_s);
    Simulation link;
    link.delay = 5ms;
    link.drawing = 1ms;  // frames wait for each other and show the link's rate
    link.bytes_per_s = bytes_per_s;
    link.run(10s);
    EXPECT_EQ(link.pace.moving().jpeg.full_color, full);
    EXPECT_EQ(link.pace.step(), 0);
  }
}

TEST(LinkPace, full_color_ends_when_the_link_becomes_slow_and_is_tried_ever_more_rarely) {
  Simulation link;
  link.run(10s);
  ASSERT_TRUE(link.pace.has_full_color());
  link.bytes_per_s = 0.5e6;
  link.run(2s);
  EXPECT_FALSE(link.pace.has_full_color());
  link.run(60s);
  int changes = 0;
  bool last = link.pace.has_full_color();
  for (int i = 0; i < 600; ++i) {
    link.run(100ms);
    changes += last != link.pace.has_full_color();
    last = link.pace.has_full_color();
  }
  EXPECT_LE(changes, 10) << "in a minute";
}

TEST(LinkPace, a_long_delay_alone_reduces_nothing_but_lets_more_be_on_their_way) {
  Simulation link;
  link.delay = 200ms;
  link.run(60s);
  EXPECT_EQ(link.pace.step(), 0);
  EXPECT_EQ(link.pace.window(), 3);
}

TEST(LinkPace, a_slow_renderer_is_not_taken_for_a_slow_link) {
  Simulation link;
  link.drawing = 200ms;
  link.delay = 300ms;
  link.run(60s);
  EXPECT_EQ(link.pace.step(), 0);
}

TEST(LinkPace, a_slow_browser_is_not_helped_by_small_pictures_and_has_whole_ones) {
  Simulation link;
  link.delay = 20ms;
  link.showing = 90ms;
  int reduced = 0;
  for (int i = 0; i < 600; ++i) {
    link.run(100ms);
    reduced += link.pace.step() > 0;
  }
  EXPECT_LT(reduced, 60) << "a tenth of the time, to try";
}

TEST(LinkPace, over_8_Mbit_and_80_ms_pictures_come_in_time) {
  Simulation link;
  link.delay = 80ms;
  link.bytes_per_s = 1e6;
  link.run(20s);
  link.longest();
  EXPECT_GE(link.run(10s), 120) << "12 a second";
  EXPECT_LT(link.longest(), 80ms + 100ms + 80ms);
}

TEST(LinkPace, a_slow_link_has_small_pictures_soon) {
  Simulation link;
  link.delay = 80ms;
  link.bytes_per_s = 0.25e6;  // 2 Mbit/s, where an unreduced frame takes 240 ms
  link.run(3s);
  EXPECT_GE(link.pace.step(), 1);
  EXPECT_GE(link.run(10s), 100);
  EXPECT_LT(link.pace.step(), LinkPace::kSteps - 1) << "no smaller than need be";
}

TEST(LinkPace, a_link_that_becomes_fast_again_has_whole_pictures_again) {
  Simulation link;
  link.bytes_per_s = 0.1e6;
  link.run(60s);
  EXPECT_EQ(link.pace.step(), LinkPace::kSteps - 1);
  link.bytes_per_s = 1e8;
  link.run(120s);
  EXPECT_EQ(link.pace.step(), 0);
}

TEST(LinkPace, a_better_step_that_does_not_hold_is_tried_ever_more_rarely) {
  Simulation link;
  link.bytes_per_s = 0.5e6;
  link.run(60s);
  int changes = 0, last = link.pace.step();
  for (int i = 0; i < 600; ++i) {
    link.run(100ms);
    changes += last != link.pace.step();
    last = link.pace.step();
  }
  EXPECT_LE(changes, 20) << "in a minute";
}

TEST(LinkPace, pictures_that_stand_still_say_nothing_of_moving_ones) {
  Simulation link;
  link.moving = false;
  link.bytes_per_s = 0.2e6;
  link.run(30s);
  EXPECT_EQ(link.pace.step(), 0);
}

TEST(LinkPace, an_acknowledgement_that_fits_nothing_is_harmless) {
  LinkPace pace;
  const auto now = Clock::now();
  pace.on_ack(5, now);
  pace.on_sent(1, 1000, true, now);
  pace.on_ack(9, now + 1ms);
  pace.on_ack(9, now + 10s);
  EXPECT_EQ(pace.step(), 0);
}

}  // namespace
}  // namespace strata::stream
