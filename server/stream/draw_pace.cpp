#include "stream/draw_pace.h"

#include <array>
#include <cstddef>

namespace strata::stream {
namespace {

// Each step has half the pixels of the previous one.
constexpr std::array<double, DrawPace::kSteps> kScales{1, 0.7, 0.5};
constexpr double kNew = 0.3;         // the weight of a new time in the mean
constexpr double kEnough = 2.0 / 3;  // the part of the longest time that allows a larger size

double pixels(int step) {
  const double scale = kScales.at(static_cast<std::size_t>(step));
  return scale * scale;
}

}  // namespace

void DrawPace::on_drawn(Seconds took) {
  ++judged_;
  mean_ = judged_ == 1 ? took : mean_ + kNew * (took - mean_);
  if (judged_ < kJudged) return;
  if (mean_ > longest_ && step_ + 1 < kSteps) return change_step(step_ + 1);
  if (step_ == 0) return;
  const Seconds larger = mean_ * (pixels(step_ - 1) / pixels(step_));
  if (larger < kEnough * longest_) change_step(step_ - 1);
}

double DrawPace::scale() const { return kScales.at(static_cast<std::size_t>(step_)); }

void DrawPace::change_step(int step) {
  step_ = step;
  judged_ = 0;
}

}  // namespace strata::stream
