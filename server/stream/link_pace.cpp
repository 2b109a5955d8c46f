#include "stream/link_pace.h"

#include <algorithm>
#include <array>
#include <utility>

namespace strata::stream {
namespace {

// Smaller frames of a camera at rest are usually rectangles of edits.
constexpr double kLargeStill_bytes = 20'000;

constexpr std::array<MovingPicture, LinkPace::kSteps> kReductions{
    // Each step has about half the bytes of the previous one.
    {{{75, false}, 1}, {{65, false}, 0.7}, {{60, false}, 0.5}, {{50, false}, 0.35}}};
// Keeps thin colored lines sharp. Has about 1.6 times the bytes of step 0.
constexpr MovingPicture kFullColor{{80, true}, 1};
constexpr double kFullColorBytes = 1.6;
// The weights of new values in running means.
constexpr double kNewPair = 0.3, kNewWait = 0.3;
constexpr double kDrawnApart = 1.25;
// With a smaller gap, two acknowledgments arrived together.
constexpr std::chrono::milliseconds kMinGap{5};

}  // namespace

void LinkPace::on_sent(std::uint64_t frame, std::size_t bytes, bool moving, Clock::time_point at) {
  const int its_kind = moving ? kind() : -1;
  const bool alike = std::all_of(on_the_way_.begin(), on_the_way_.end(),
                                 [&](const Sent& one) { return one.kind == its_kind; });
  on_the_way_.push_back({frame, static_cast<double>(bytes), its_kind, wide_, alike, at});
}

void LinkPace::on_ack(std::uint64_t frame, Clock::time_point at) {
  std::optional<Sent> last;
  int acked = 0;
  for (; !on_the_way_.empty() && on_the_way_.front().frame <= frame; ++acked) {
    last = on_the_way_.front();
    on_the_way_.pop_front();
  }
  if (!last) return;
  if (acked == 1) note_rate(*last, at);
  last_sent_ = last->at;
  last_ack_ = at;
  const Passed passed{last->bytes, at - last->at};
  if (last->kind < 0 && last->bytes >= kLargeStill_bytes) {
    still_took_ = passed.took;
    // Only at the first trial: later trials need a series of short waits.
    if (step_ == 0 && color_trial_ == kFirstTrial && passed.took <= kFastStill) change_color(true);
  }
  note_delay(passed, at);
  // Does not judge frames that were sent with another kind or window, or after such frames.
  if (last->kind != kind() || !last->alike || last->wide != wide_) return;
  judge(passed.took - delay(), at);
  if (last->kind == kind()) judge_color(last->bytes);
}

void LinkPace::note_rate(const Sent& sent, Clock::time_point acked) {
  const auto gap = acked - last_ack_;
  if (sent.at >= last_ack_ || gap < kMinGap) return;
  const double s_per_byte = Seconds(gap).count() / sent.bytes;
  // The link was still busy with the first frame when the second was sent.
  if (kDrawnApart * (sent.at - last_sent_) < gap)
    s_per_byte_ =
        s_per_byte_ == 0 ? s_per_byte : s_per_byte_ + kNewPair * (s_per_byte - s_per_byte_);
  else  // the link has at least this rate
    s_per_byte_ = std::min(s_per_byte_, s_per_byte);
}

LinkPace::Seconds LinkPace::delay_of(const Passed& frame) const {
  return std::max(Seconds(0), frame.took - Seconds(frame.bytes * s_per_byte_));
}

LinkPace::Seconds LinkPace::delay() const {
  if (!shortest_before_) return delay_of(*shortest_);
  return std::min(delay_of(*shortest_), delay_of(*shortest_before_));
}

void LinkPace::note_delay(const Passed& frame, Clock::time_point at) {
  if (at >= span_ends_) {
    shortest_before_ = shortest_;
    shortest_.reset();
    span_ends_ = at + kDelayKept;
  }
  if (!shortest_ || delay_of(frame) < delay_of(*shortest_)) shortest_ = frame;
}

void LinkPace::judge(Seconds wait, Clock::time_point at) {
  if (wide_ && wait > kShortWait) {
    wide_ = false;
    return;
  }
  ++judged_;
  mean_wait_ = judged_ == 1 ? wait : mean_wait_ + kNewWait * (wait - mean_wait_);
  if (judged_ >= kJudged && reduced_) {
    const Reduced reduced = *std::exchange(reduced_, std::nullopt);
    if (mean_wait_ > kWorthIt * reduced.wait) {
      no_reduction_until_ = at + kDelayKept;
      return change_step(reduced.from);
    }
  }
  const bool is_clear = judged_ >= kJudged || wait > 4 * kMaxWait;
  if (mean_wait_ > kMaxWait && is_clear && step_ + 1 < kSteps && at >= no_reduction_until_)
    return reduce(wait);
  short_waits_ = wait > kShortWait ? 0 : short_waits_ + 1;
  if (!wide_ && delay() > kLongDelay && short_waits_ == kFirstTrial) wide_ = true;
  if (step_ == 0 || short_waits_ < trial_) return;
  // The waits at the current step stayed short, so its trial has succeeded.
  if (trying_) trial_ = kFirstTrial;
  trying_ = true;
  change_step(step_ - 1);
}

void LinkPace::judge_color(double bytes) {
  const Seconds took(bytes * s_per_byte_);
  if (full_color_ && (took > 2 * kFullColorTime || (judged_ >= kJudged && mean_wait_ > kShortWait)))
    return change_color(false);
  if (!full_color_ && step_ == 0 && short_waits_ >= color_trial_ &&
      kFullColorBytes * took <= kFullColorTime)
    change_color(true);
}

void LinkPace::change_color(bool full) {
  if (full_color_ == full) return;
  full_color_ = full;
  if (!full) color_trial_ = std::min(2 * color_trial_, kLastTrial);
  judged_ = short_waits_ = 0;
}

void LinkPace::reduce(Seconds wait) {
  if (full_color_ && wait <= 4 * kMaxWait) return change_color(false);
  if (trying_) trial_ = std::min(2 * trial_, kLastTrial);
  trying_ = false;
  const Reduced reduced{step_, mean_wait_};
  change_step(std::min(step_ + (wait > 4 * kMaxWait ? 2 : 1), kSteps - 1));
  reduced_ = reduced;
}

void LinkPace::change_step(int step) {
  step_ = step;
  change_color(false);
  judged_ = short_waits_ = 0;
  reduced_.reset();
}

MovingPicture LinkPace::moving() const {
  return full_color_ ? kFullColor : kReductions[static_cast<std::size_t>(step_)];
}

}  // namespace strata::stream
