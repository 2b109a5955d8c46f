#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

struct FrameTask {
  FrameRequest request;
  Renderer::Done<Frame> done;
};

// Frames that wait: one place a view, where the latest wins and inherits what the replaced ones had to redraw. Views take
// turns. Thread-safe.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t max_views) : max_views_(max_views) {}

  struct Pushed {
    bool accepted = false;               // false: too many views wait; the task is in `displaced`
    std::optional<FrameTask> displaced;  // refused, or replaced by the new one
  };
  Pushed push(FrameTask task);
  // The view that has waited longest, except views with a frame under way; that view is then under way until `finished`.
  std::optional<FrameTask> take();
  void finished(ViewHandle view);
  std::vector<FrameTask> take_all();  // and nothing is under way any more

 private:
  const std::size_t max_views_;
  std::mutex mutex_;
  std::deque<ViewHandle> turns_;
  std::unordered_map<ViewHandle, FrameTask> waiting_;
  std::unordered_set<ViewHandle> under_way_;
};

}  // namespace strata::render
