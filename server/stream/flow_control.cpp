#include "stream/flow_control.h"

#include <algorithm>
#include <utility>

#include "render/thread/screen_rect.h"

namespace strata::stream {

void FlowControl::on_ready() { ready_ = true; }

void FlowControl::on_news() {
  news_ = true;
  refused_ = false;
  rests_ = false;
  refined_ = false;
  // A refinement in progress would show the old state, and new frames do not wait for it.
  if (out_ && out_->samples > 1) out_.reset();
}

void FlowControl::on_reset() {
  on_news();
  ready_ = false;
  out_.reset();
  boxes_.clear();
  surface_waits_ = false;
  everything_waits_ = true;
  refine_waits_ = false;
}

void FlowControl::on_camera(std::uint64_t camera_seq, const Camera& camera, bool moving) {
  camera_seq_ = camera_seq;
  moving_ = moving;
  if (camera_ == camera) return;
  on_news();
  if (camera_waits_) ++dropped_;
  camera_ = camera;
  camera_waits_ = true;
  everything_waits_ = true;
}

void FlowControl::add_box(const Box& box) { render::add_box(boxes_, box, kMaxBoxes); }

void FlowControl::on_change(const Box& box, std::int64_t sequence) {
  on_news();
  sequence_ = std::max(sequence_, sequence);
  add_box(box);
}

void FlowControl::on_change_everywhere(std::int64_t sequence) {
  on_news();
  sequence_ = std::max(sequence_, sequence);
  surface_waits_ = true;
}

void FlowControl::on_style() {
  on_news();
  everything_waits_ = true;
}

bool FlowControl::on_past(std::optional<std::int64_t> sequence) {
  return std::exchange(past_, sequence) != sequence;
}

void FlowControl::on_ack(std::uint64_t frame) {
  acked_ = std::max(acked_, std::min(frame, last_frame_));
}

void FlowControl::on_quiet() { moving_ = false; }

std::optional<FlowControl::Draw> FlowControl::next() {
  if (!ready_ || !camera_ || out_ || refused_) return std::nullopt;
  if (last_frame_ - acked_ >= static_cast<std::uint64_t>(window_)) return std::nullopt;
  const bool refine = refine_waits_ && !moving_;
  const bool whole = everything_waits_ || surface_waits_ || refine;
  const bool changes = whole || !boxes_.empty();
  // A refinement waits until the client has all frames. Otherwise it would delay the next frame.
  if (!changes && (!rests_ || refined_ || moving_ || acked_ < last_frame_)) return std::nullopt;

  Draw draw{++tickets_, camera_seq_,  past_.value_or(sequence_),
            *camera_,   std::nullopt, Quality::still,
            1};
  if (!changes) draw.samples = samples_at_rest_;
  if (whole || !changes) {
    draw.quality = moving_ ? Quality::moving : Quality::still;
    everything_waits_ = surface_waits_ = false;
  } else {
    draw.changed = boxes_;
    // The camera still moves. The whole frame is drawn at full quality when it stops.
    if (refine_waits_) draw.quality = Quality::moving;
  }
  boxes_.clear();
  camera_waits_ = false;
  news_ = false;
  out_is_past_ = past_.has_value();
  out_ = draw;
  return draw;
}

std::vector<FlowControl::Box> FlowControl::on_begun(std::uint64_t ticket) {
  if (!out_ || out_->ticket != ticket || out_is_past_ || past_) return {};
  // A rectangle cannot show a change of the whole surface, so it also shows no newer edit.
  if (surface_waits_ && out_->changed) return {};
  surface_waits_ = false;
  out_->sequence = sequence_;
  std::vector<Box> late = std::exchange(boxes_, {});
  if (!out_->changed) return {};  // all pixels are drawn
  for (const Box& box : late) render::add_box(*out_->changed, box, kMaxBoxes);
  return late;
}

std::optional<FlowControl::Numbered> FlowControl::on_drawn(std::uint64_t ticket, bool sent) {
  if (!out_ || out_->ticket != ticket) return std::nullopt;
  const bool everything = !out_->changed;
  const std::int64_t sequence = out_->sequence;
  // After an empty whole frame there is nothing to draw at full quality.
  if (out_->samples > 1) refined_ = true;
  if (everything) refine_waits_ = sent && out_->quality == Quality::moving;
  out_.reset();
  if (!sent) return std::nullopt;
  return Numbered{++last_frame_, !refine_waits_, sequence};
}

bool FlowControl::on_failed(std::uint64_t ticket) {
  if (!out_ || out_->ticket != ticket) return false;
  if (out_->changed)
    for (const Box& box : *out_->changed) add_box(box);
  else
    everything_waits_ = true;
  out_.reset();
  return true;
}

bool FlowControl::on_not_refined(std::uint64_t ticket, bool again) {
  if (!out_ || out_->ticket != ticket) return false;
  out_.reset();
  rests_ = false;
  refined_ = !again;
  return true;
}

bool FlowControl::on_refused(std::uint64_t ticket) {
  if (!on_failed(ticket)) return false;
  refused_ = !news_;
  return true;
}

}  // namespace strata::stream
