#include "render/thread/refinements.h"

#include <algorithm>

#include "render/thread/frame_queue.h"

namespace strata::render {

Error superseded_error() {
  return {ErrorCode::superseded,
          "Superseded",
          "A newer request of the same view replaced this one.",
          {}};
}

std::shared_ptr<Refinements::Task> Refinements::push(FrameRequest request, Done done) {
  std::lock_guard lock(mutex_);
  Task::Asker asker{request.view, draws_.try_emplace(request.view, 0).first->second,
                    std::move(done)};
  std::erase_if(tasks_, [](const auto& task) { return task.expired(); });
  for (const auto& one : tasks_) {
    const auto task = one.lock();
    if (!task || task->is_over || !same_picture(task->request, request)) continue;
    if (task->began_at.value_or(changes_) != changes_) continue;
    task->askers.push_back(std::move(asker));
    return nullptr;
  }
  auto task = std::make_shared<Task>();
  task->request = std::move(request);
  task->askers.push_back(std::move(asker));
  tasks_.push_back(task);
  return task;
}

void Refinements::content_changed() {
  std::lock_guard lock(mutex_);
  ++changes_;
}

void Refinements::overtake(ViewHandle view) {
  std::lock_guard lock(mutex_);
  if (const auto found = draws_.find(view); found != draws_.end()) ++found->second;
}

void Refinements::forget(ViewHandle view) {
  std::lock_guard lock(mutex_);
  draws_.erase(view);
}

std::vector<Refinements::Done> Refinements::take_overtaken(Task& task) {
  const auto waits = [&](const Task::Asker& asker) {
    const auto found = draws_.find(asker.view);
    return found != draws_.end() && found->second == asker.draw;
  };
  const auto gone = std::stable_partition(task.askers.begin(), task.askers.end(), waits);
  std::vector<Done> overtaken;
  for (auto asker = gone; asker != task.askers.end(); ++asker)
    overtaken.push_back(std::move(asker->done));
  task.askers.erase(gone, task.askers.end());
  return overtaken;
}

bool Refinements::continues(Task& task) {
  std::vector<Done> overtaken;
  bool is_wanted = false;
  {
    std::lock_guard lock(mutex_);
    if (!task.began_at) task.began_at = changes_;
    overtaken = take_overtaken(task);
    is_wanted = !task.askers.empty();
    task.is_over = !is_wanted;
  }
  for (const Done& done : overtaken) done(tl::unexpected(superseded_error()));
  return is_wanted;
}

void Refinements::answer(Task& task, const Result<SharedFrame>& frame) {
  std::vector<Task::Asker> askers;
  {
    std::lock_guard lock(mutex_);
    task.is_over = true;
    askers.swap(task.askers);
  }
  for (const auto& asker : askers) asker.done(frame);
}

}  // namespace strata::render
