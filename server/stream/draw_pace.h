#pragma once

#include <chrono>

namespace strata::stream {

// Chooses the size of a view's moving frames from the time between their request and their
// completion. This time contains the turns of other views. If many people turn models on a machine
// without a GPU, smaller frames let everybody see movements and strokes sooner. Each size is kept
// for `kJudged` frames or more. A larger size is chosen only if its frames would take less than two
// thirds of the longest time. The estimate assumes that a frame with twice the pixels takes twice
// the time. Has no clocks or threads.
class DrawPace {
 public:
  using Seconds = std::chrono::duration<double>;
  static constexpr std::chrono::milliseconds kLongest{120};  // 8 frames per second
  static constexpr int kSteps = 3;
  static constexpr int kJudged = 3;

  explicit DrawPace(Seconds longest = kLongest) : longest_(longest) {}

  // A frame of a moving camera that shows the whole window took this time.
  void on_drawn(Seconds took);

  double scale() const;  // factor for the window's width and height

 private:
  void change_step(int step);

  Seconds longest_;
  int step_ = 0;
  int judged_ = 0;  // number of frames at this step
  Seconds mean_{};  // of these frames
};

}  // namespace strata::stream
