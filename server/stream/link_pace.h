#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "media/picture.h"

namespace strata::stream {

// How far pictures of a moving camera are reduced, so that they come in time over one client's
// link. What stands still is always of full quality.
struct MovingPicture {
  JpegSettings jpeg;
  double scale = 1;  // of the window's width and height
  bool operator==(const MovingPicture&) const = default;
};

// What one client's link and browser manage, judged by when frames were sent and acknowledged. Two
// frames that were sent close together and acknowledged further apart tell the link's rate (a
// packet pair); the shortest that a frame of late took, without what its bytes need at that rate,
// is the link's delay (as TCP Vegas has it). What a frame takes beyond the delay is its wait: for
// those before it, and for itself. Waits beyond `kMaxWait` reduce pictures, unless that
// shortens them little, since then something else is slow; a series of short ones makes pictures
// better again, step by step; a better step that did not hold is tried again later and later. Where
// the delay is long and waits are short the link lies idle between two frames: then three may be on
// their way, until they wait for each other. Without clocks or threads.
class LinkPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kMaxWait{100}, kShortWait{50}, kLongDelay{50};
  // a delay is of the last one to two of these
  static constexpr std::chrono::seconds kDelayKept{15};
  static constexpr int kSteps = 4;
  // frames with a short wait, until a better step is tried
  static constexpr int kFirstTrial = 12, kLastTrial = 384;
  static constexpr int kJudged = 3;  // frames until a step is judged
  // of the wait before, that a reduction must leave at most
  static constexpr double kWorthIt = 0.85;

  void on_sent(std::uint64_t frame, std::size_t bytes, bool moving, Clock::time_point at);
  void on_ack(std::uint64_t frame, Clock::time_point at);

  MovingPicture moving() const;
  int step() const { return step_; }            // 0: not reduced
  int window() const { return wide_ ? 3 : 2; }  // frames that may be on their way

 private:
  struct Sent {
    std::uint64_t frame;
    double bytes;
    int step;  // -1: not of a moving camera
    bool wide;
    bool alike;  // as all that were before it on their way
    Clock::time_point at;
  };
  using Seconds = std::chrono::duration<double>;
  struct Passed {
    double bytes = 0;
    Seconds took{};
  };
  Seconds delay_of(const Passed& frame) const;
  Seconds delay() const;
  void note_rate(const Sent& sent, Clock::time_point acked);
  void note_delay(const Passed& frame, Clock::time_point at);
  void judge(Seconds wait, Clock::time_point at);
  void reduce(Seconds wait);
  void change_step(int step);

  std::deque<Sent> on_the_way_;
  Clock::time_point last_sent_{}, last_ack_{};        // of the last frame that was acknowledged
  double s_per_byte_ = 0;                             // 0: not known, as if nothing took any time
  std::optional<Passed> shortest_, shortest_before_;  // of this span and the last
  Clock::time_point span_ends_{};
  int step_ = 0;
  int judged_ = 0;       // frames of this step
  Seconds mean_wait_{};  // of them
  struct Reduced {
    int from;
    Seconds wait;  // before
  };
  std::optional<Reduced> reduced_;  // until it is known whether that was worth it
  Clock::time_point no_reduction_until_{};
  bool wide_ = false;  // the window
  int short_waits_ = 0;
  int trial_ = kFirstTrial;
  bool trying_ = false;  // a better step than the last that held
};

}  // namespace strata::stream
