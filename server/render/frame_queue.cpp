#include "render/frame_queue.h"

#include <algorithm>

namespace strata::render {
namespace {

constexpr std::size_t kMaxBoxes = 64;

// What the replaced request had to redraw is still to be redrawn.
void inherit(FrameRequest& request, FrameRequest& replaced) {
  if (!request.changed) return;
  if (!replaced.changed) {
    request.changed.reset();
    return;
  }
  auto& boxes = *request.changed;
  boxes.insert(boxes.end(), replaced.changed->begin(), replaced.changed->end());
  if (boxes.size() <= kMaxBoxes) return;
  FrameRequest::Box all = boxes.front();
  for (const auto& box : boxes) all = {glm::min(all.min, box.min), glm::max(all.max, box.max)};
  boxes.assign(1, all);
}

}  // namespace

FrameQueue::Pushed FrameQueue::push(FrameTask task) {
  std::lock_guard lock(mutex_);
  const ViewHandle view = task.request.view;
  const auto waiting = waiting_.find(view);
  if (waiting != waiting_.end()) {
    inherit(task.request, waiting->second.request);
    std::swap(task, waiting->second);
    return {true, std::move(task)};
  }
  if (waiting_.size() >= max_views_) return {false, std::move(task)};
  turns_.push_back(view);
  waiting_.emplace(view, std::move(task));
  return {true, std::nullopt};
}

std::optional<FrameTask> FrameQueue::take() {
  std::lock_guard lock(mutex_);
  const auto turn = std::find_if(turns_.begin(), turns_.end(), [&](ViewHandle v) { return !under_way_.contains(v); });
  if (turn == turns_.end()) return std::nullopt;
  const ViewHandle view = *turn;
  turns_.erase(turn);
  auto node = waiting_.extract(view);
  under_way_.insert(view);
  return std::move(node.mapped());
}

void FrameQueue::finished(ViewHandle view) {
  std::lock_guard lock(mutex_);
  under_way_.erase(view);
}

std::vector<FrameTask> FrameQueue::take_all() {
  std::lock_guard lock(mutex_);
  std::vector<FrameTask> tasks;
  for (auto& [view, task] : waiting_) tasks.push_back(std::move(task));
  waiting_.clear();
  turns_.clear();
  under_way_.clear();
  return tasks;
}

}  // namespace strata::render
