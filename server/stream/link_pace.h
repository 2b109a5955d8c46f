#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "media/picture.h"

namespace strata::stream {

// How pictures of a moving camera are sent, so that they arrive in time over one client's link.
// Pictures of a still camera are always of full quality.
struct MovingPicture {
  JpegSettings jpeg;
  double scale = 1;  // of the window's width and height
  bool operator==(const MovingPicture&) const = default;
};

// The capacity of one client's link and browser, estimated from the times when frames were sent and
// acknowledged. Two frames that were sent close together and acknowledged further apart measure the
// link's rate (a packet pair); the shortest recent time of a frame, without the time for its bytes
// at that rate, is the link's delay (as in TCP Vegas). The time of a frame beyond the delay is its
// wait: for earlier frames, and for itself. Waits beyond `kMaxWait` reduce pictures, unless that
// shortens the waits little, because then something else is slow. A series of short waits improves
// pictures again, step by step; a better step that did not hold is tried again after longer and
// longer periods. If the delay is long and waits are short, the link is idle between two frames:
// then three may be on their way, until they wait for each other. Pictures have full color while
// the link needs little time for them: as soon as a picture of a still camera arrived that fast, or
// after a series of short waits. Without clocks or threads.
class LinkPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kMaxWait{100}, kShortWait{50}, kLongDelay{50};
  // a delay is the shortest of the last one to two of these periods
  static constexpr std::chrono::seconds kDelayKept{15};
  static constexpr std::chrono::milliseconds kRoomy{400};
  // the longest time of a still picture, and of the bytes of a moving one, for full color
  static constexpr std::chrono::milliseconds kFastStill{50}, kFullColorTime{12};
  static constexpr int kSteps = 4;
  // frames with a short wait, until a better step is tried
  static constexpr int kFirstTrial = 12, kLastTrial = 384;
  static constexpr int kJudged = 3;  // frames until a step is judged
  // maximum share of the wait before a reduction that must remain after it
  static constexpr double kWorthIt = 0.85;

  void on_sent(std::uint64_t frame, std::size_t bytes, bool moving, Clock::time_point at);
  void on_ack(std::uint64_t frame, Clock::time_point at);

  MovingPicture moving() const;
  int step() const { return step_; }  // 0: not reduced
  bool has_full_color() const { return full_color_; }
  // Whether a whole picture of full quality arrives without delay for the frames after it.
  bool has_room() const { return step_ == 0 && (!still_took_ || *still_took_ <= kRoomy); }
  int window() const { return wide_ ? 3 : 2; }  // frames that may be on their way

 private:
  struct Sent {
    std::uint64_t frame;
    double bytes;
    int kind;  // -1: not of a moving camera
    bool wide;
    bool alike;  // same kind as all frames that were on their way before it
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
  // of the present pictures of a moving camera
  int kind() const { return full_color_ ? kSteps : step_; }
  void reduce(Seconds wait);
  void change_step(int step);

  std::deque<Sent> on_the_way_;
  Clock::time_point last_sent_{}, last_ack_{};        // of the last acknowledged frame
  double s_per_byte_ = 0;                             // 0: not known, as for an infinitely fast
                                                      // link
  std::optional<Passed> shortest_, shortest_before_;  // of this period and the last
  Clock::time_point span_ends_{};
  int step_ = 0;
  int judged_ = 0;       // frames of this step
  Seconds mean_wait_{};  // of these frames
  struct Reduced {
    int from;
    Seconds wait;  // before the reduction
  };
  std::optional<Reduced> reduced_;  // until its effect is known
  Clock::time_point no_reduction_until_{};
  // the time of the last large picture of full quality, until it was acknowledged
  std::optional<Seconds> still_took_;
  bool full_color_ = false;  // only at step 0
  int color_trial_ = kFirstTrial;
  bool wide_ = false;  // the window
  int short_waits_ = 0;
  int trial_ = kFirstTrial;
  bool trying_ = false;  // a better step than the last that held
};

}  // namespace strata::stream
