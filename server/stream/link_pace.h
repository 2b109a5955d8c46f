#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "media/picture.h"

namespace strata::stream {

// The settings for frames of a moving camera, which must arrive in time over one client's link.
// Frames of a camera at rest always have full quality.
struct MovingPicture {
  JpegSettings jpeg;
  double scale = 1;  // factor for the window's width and height
  bool operator==(const MovingPicture&) const = default;
};

// Estimates the capacity of one client's link and browser from the times at which frames were sent
// and acknowledged. Two frames that were sent close together and acknowledged further apart show
// the link's rate (a packet pair). The delay is the shortest recent time of a frame, without the
// time for its bytes at that rate (as in TCP Vegas). A frame's wait is its time beyond the delay.
// Waits longer than `kMaxWait` reduce the quality and size of frames. A reduction that hardly
// shortens the waits is reverted, because the link is then not the cause. After a series of short
// waits, frames improve again, step by step. If a better step was too slow, it is tried again after
// longer and longer periods. If the delay is long and the waits are short, the link is idle between
// two frames. Then three unacknowledged frames are allowed, until they wait for each other. Frames
// get full color if a frame of a camera at rest arrived fast enough, or after a series of short
// waits. They keep it while the link needs little time for their bytes. Has no clocks or threads.
class LinkPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kMaxWait{100}, kShortWait{50}, kLongDelay{50};
  // The delay is the shortest time in the current and the previous of these periods.
  static constexpr std::chrono::seconds kDelayKept{15};
  static constexpr std::chrono::milliseconds kRoomy{400};
  // For full color: the longest time of a frame at rest, and of the bytes of a moving frame.
  static constexpr std::chrono::milliseconds kFastStill{50}, kFullColorTime{12};
  static constexpr int kSteps = 4;
  // The number of frames with a short wait before a better step is tried.
  static constexpr int kFirstTrial = 12, kLastTrial = 384;
  static constexpr int kJudged = 3;  // number of frames before a step is judged
  // A reduction is kept if at most this share of the wait remains.
  static constexpr double kWorthIt = 0.85;

  void on_sent(std::uint64_t frame, std::size_t bytes, bool moving, Clock::time_point at);
  void on_ack(std::uint64_t frame, Clock::time_point at);

  MovingPicture moving() const;
  int step() const { return step_; }  // 0: not reduced
  bool has_full_color() const { return full_color_; }
  // Returns whether the link can send a whole frame of full quality without a delay for later
  // frames.
  bool has_room() const { return step_ == 0 && (!still_took_ || *still_took_ <= kRoomy); }
  int window() const { return wide_ ? 3 : 2; }  // allowed unacknowledged frames

 private:
  struct Sent {
    std::uint64_t frame;
    double bytes;
    int kind;  // -1: the camera is at rest
    bool wide;
    bool alike;  // all unacknowledged frames before it have the same kind
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
  void judge_color(double bytes);
  void change_color(bool full);
  // The kind of the current frames of a moving camera.
  int kind() const { return full_color_ ? kSteps : step_; }
  void reduce(Seconds wait);
  void change_step(int step);

  std::deque<Sent> on_the_way_;
  Clock::time_point last_sent_{}, last_ack_{};        // times of the last acknowledged frame
  double s_per_byte_ = 0;                             // 0: unknown, like an infinitely fast link
  std::optional<Passed> shortest_, shortest_before_;  // of this period and the previous one
  Clock::time_point span_ends_{};
  int step_ = 0;
  int judged_ = 0;       // number of judged frames at this step
  Seconds mean_wait_{};  // of the judged frames
  struct Reduced {
    int from;
    Seconds wait;  // mean wait before the reduction
  };
  std::optional<Reduced> reduced_;  // set until the effect of the reduction is known
  Clock::time_point no_reduction_until_{};
  // The time of the last large frame at rest, from sending to its acknowledgment.
  std::optional<Seconds> still_took_;
  bool full_color_ = false;  // only at step 0
  int color_trial_ = kFirstTrial;
  bool wide_ = false;  // the larger window
  int short_waits_ = 0;
  int trial_ = kFirstTrial;
  bool trying_ = false;  // the current step is a trial of a better step
};

}  // namespace strata::stream
