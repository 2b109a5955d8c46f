#include "stream/link_pace.h"

#include <algorithm>
#include <array>
#include <optional>

namespace strata::stream {
namespace {

constexpr std::array<MovingPicture, LinkPace::kSteps> kReductions{
    {{{75, false}, 1}, {{55, false}, 1}, {{60, false}, 0.7}, {{60, false}, 0.5}, {{50, false}, 0.35}}};
constexpr std::chrono::milliseconds kLongDelay{50};

}  // namespace

void LinkPace::on_sent(std::uint64_t frame, bool moving, Clock::time_point at) {
  on_the_way_.push_back({frame, moving ? step_ : -1, at});
}

void LinkPace::on_ack(std::uint64_t frame, Clock::time_point at) {
  std::optional<Sent> last;
  while (!on_the_way_.empty() && on_the_way_.front().frame <= frame) {
    last = on_the_way_.front();
    on_the_way_.pop_front();
  }
  if (!last) return;
  const auto took = at - last->at;
  note_delay(took, at);
  // Frames of another step say nothing about this one.
  if (last->step == step_) judge(took - delay());
}

void LinkPace::note_delay(Clock::duration took, Clock::time_point at) {
  if (at >= span_ends_) {
    delay_before_ = delay_;
    delay_ = Clock::duration::max();
    span_ends_ = at + kDelayKept;
  }
  delay_ = std::min(delay_, took);
}

void LinkPace::judge(Clock::duration wait) {
  if (wait > kLongestWait) {
    if (trying_) trial_ = std::min(2 * trial_, kLastTrial);
    trying_ = false;
    short_waits_ = 0;
    step_ = std::min(step_ + (wait > 4 * kLongestWait ? 2 : 1), kSteps - 1);
    return;
  }
  if (step_ == 0 || wait > kShortWait || ++short_waits_ < trial_) return;
  // A step that held as long as this was no mere trial.
  if (trying_) trial_ = kFirstTrial;
  trying_ = true;
  short_waits_ = 0;
  --step_;
}

MovingPicture LinkPace::moving() const { return kReductions[static_cast<std::size_t>(step_)]; }

int LinkPace::window() const {
  const bool known = delay() != Clock::duration::max();
  return known && delay() > kLongDelay ? 3 : 2;
}

}  // namespace strata::stream
