#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>

#include "core/picture.h"

namespace strata::stream {

// How far pictures of a moving camera are reduced, so that they come in time over one client's link. What stands still is always of full
// quality.
struct MovingPicture {
  JpegSettings jpeg;
  double scale = 1;  // of the window's width and height
  bool operator==(const MovingPicture&) const = default;
};

// What one client's link and browser manage, judged by when frames were sent and acknowledged (as TCP Vegas judges a path):
// the shortest that a frame of late took is the link's delay, and what others take beyond it they waited behind other frames.
// A wait beyond `kLongestWait` reduces pictures, a series of short ones makes them better again, step by step; a better
// step that did not hold is tried again later and later. Without clocks or threads.
class LinkPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLongestWait{80}, kShortWait{30};
  static constexpr std::chrono::seconds kDelayKept{15};  // a delay is of the last one to two of these
  static constexpr int kSteps = 5;
  static constexpr int kFirstTrial = 12, kLastTrial = 384;  // frames with a short wait, until a better step is tried

  void on_sent(std::uint64_t frame, bool moving, Clock::time_point at);
  void on_ack(std::uint64_t frame, Clock::time_point at);

  MovingPicture moving() const;
  int step() const { return step_; }  // 0: not reduced
  // Frames that may be on their way: more where the link's delay would leave it idle.
  int window() const;

 private:
  struct Sent {
    std::uint64_t frame;
    int step;  // -1: not of a moving camera
    Clock::time_point at;
  };
  Clock::duration delay() const { return std::min(delay_, delay_before_); }
  void note_delay(Clock::duration took, Clock::time_point at);
  void judge(Clock::duration wait);

  std::deque<Sent> on_the_way_;
  Clock::duration delay_ = Clock::duration::max(), delay_before_ = Clock::duration::max();  // shortest of two spans
  Clock::time_point span_ends_{};
  int step_ = 0;
  int short_waits_ = 0;
  int trial_ = kFirstTrial;
  bool trying_ = false;  // a better step than the last that held
};

}  // namespace strata::stream
