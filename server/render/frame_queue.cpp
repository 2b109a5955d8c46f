#include "render/frame_queue.h"

#include <algorithm>
#include <limits>
#include <set>

namespace strata::render {
namespace {

constexpr std::size_t kMaxBoxes = 64;

// Everything that either had to redraw is to be redrawn.
void inherit(FrameRequest& request, const FrameRequest& other) {
  if (!request.changed) return;
  if (!other.changed) {
    request.changed.reset();
    return;
  }
  auto& boxes = *request.changed;
  for (const auto& box : *other.changed)
    if (std::find(boxes.begin(), boxes.end(), box) == boxes.end()) boxes.push_back(box);
  if (boxes.size() <= kMaxBoxes) return;
  FrameRequest::Box all = boxes.front();
  for (const auto& box : boxes) all = {glm::min(all.min, box.min), glm::max(all.max, box.max)};
  boxes.assign(1, all);
}

// Whether a view that drew one of them has the other's picture, but for what changed on the surface.
bool same_picture(const FrameRequest& a, const FrameRequest& b) {
  return a.model != 0 && a.model == b.model && a.moving == b.moving && a.width == b.width && a.height == b.height &&
         a.camera == b.camera && a.layers == b.layers && a.looks == b.looks && a.marks == b.marks &&
         a.light == b.light && a.unit_mm == b.unit_mm && a.background == b.background && a.align_to_16 == b.align_to_16;
}

}  // namespace

FrameQueue::Pushed FrameQueue::push(FrameRequest request, Renderer::Done<SharedFrame> done) {
  std::lock_guard lock(mutex_);
  const ViewHandle view = request.view;
  View& state = views_[view];
  Pushed pushed{true, std::nullopt};
  if (state.waits) {
    inherit(request, (*state.waits)->request);
    auto& askers = (*state.waits)->askers;
    const auto mine = std::find_if(askers.begin(), askers.end(), [&](const auto& one) { return one.view == view; });
    pushed.displaced = std::move(mine->done);
    leave(view, state);
  } else if (askers_ >= max_askers_) {
    return {false, std::move(done)};
  }
  if (!state.under_way) state.served_ms = std::max(state.served_ms, now_ms_);
  // A whole picture is not forced on those who want a part of it.
  auto same = std::find_if(waiting_.begin(), waiting_.end(), [&](const FrameTask& other) {
    return other.request.changed.has_value() == request.changed.has_value() && same_picture(other.request, request);
  });
  if (same == waiting_.end()) {
    waiting_.push_back({std::move(request), {}, 0});
    same = std::prev(waiting_.end());
  } else {
    inherit(same->request, request);
  }
  same->askers.push_back({view, std::move(done)});
  state.waits = same;
  ++askers_;
  return pushed;
}

void FrameQueue::leave(ViewHandle view, View& state) {
  const Place place = *state.waits;
  std::erase_if(place->askers, [&](const auto& one) { return one.view == view; });
  if (place->askers.empty()) waiting_.erase(place);
  state.waits.reset();
  --askers_;
}

double FrameQueue::turn_of(const FrameTask& task) const {
  double turn = std::numeric_limits<double>::infinity();
  for (const auto& asker : task.askers) turn = std::min(turn, views_.at(asker.view).served_ms);
  return turn;
}

std::optional<ViewHandle> FrameQueue::drawer_of(const FrameTask& task) const {
  for (const auto& asker : task.askers)
    if (views_.at(asker.view).under_way) return std::nullopt;
  const auto has_it = [&](const View& state) { return state.drew && same_picture(*state.drew, task.request); };
  for (const auto& asker : task.askers)
    if (has_it(views_.at(asker.view))) return asker.view;
  if (task.request.model != 0)
    for (const auto& [view, state] : views_) {
      if (!has_it(state)) continue;
      return state.under_way ? std::nullopt : std::optional(view);
    }
  return task.askers.front().view;
}

template <class Wanted>
std::optional<FrameTask> FrameQueue::take_if(const Wanted& wanted) {
  std::set<const FrameTask*> cannot;
  for (;;) {
    Place next = waiting_.end();
    double turn = std::numeric_limits<double>::infinity();
    for (auto place = waiting_.begin(); place != waiting_.end(); ++place) {
      if (const double its = turn_of(*place); its < turn && !cannot.contains(&*place) && wanted(*place, its)) {
        turn = its;
        next = place;
      }
    }
    if (next == waiting_.end()) return std::nullopt;
    const auto drawer = drawer_of(*next);
    if (!drawer) {
      cannot.insert(&*next);
      continue;
    }
    now_ms_ = std::max(now_ms_, turn);
    next->request.view = *drawer;
    next->turn_ms = turn;
    for (const auto& asker : next->askers) {
      View& state = views_.at(asker.view);
      state.waits.reset();
      state.under_way = true;
    }
    askers_ -= next->askers.size();
    View& drawing = views_.at(*drawer);
    drawing.under_way = true;
    if (!drawing.gone) drawing.drew = next->request;
    FrameTask task = std::move(*next);
    waiting_.erase(next);
    return task;
  }
}

std::optional<FrameTask> FrameQueue::take() {
  std::lock_guard lock(mutex_);
  return take_if([](const FrameTask&, double) { return true; });
}

std::optional<FrameTask> FrameQueue::take_part(double turn_ms) {
  std::lock_guard lock(mutex_);
  return take_if([&](const FrameTask& task, double its) { return task.request.changed && its < turn_ms; });
}

void FrameQueue::finished(const FrameTask& task, double took_ms) {
  std::lock_guard lock(mutex_);
  const auto rests = [&](ViewHandle view, double served_ms) {
    const auto state = views_.find(view);
    if (state == views_.end()) return;
    state->second.under_way = false;
    state->second.served_ms += served_ms;
    if (state->second.gone && !state->second.waits) views_.erase(state);
  };
  for (const auto& asker : task.askers) rests(asker.view, took_ms / static_cast<double>(task.askers.size()));
  rests(task.request.view, 0);
}

void FrameQueue::forget(ViewHandle view) {
  std::lock_guard lock(mutex_);
  const auto state = views_.find(view);
  if (state == views_.end()) return;
  state->second.gone = true;
  state->second.drew.reset();
  // Who still waits is answered when its turn comes, that there is no such view.
  if (!state->second.waits && !state->second.under_way) views_.erase(state);
}

std::vector<FrameTask> FrameQueue::take_all() {
  std::lock_guard lock(mutex_);
  std::vector<FrameTask> tasks(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
  waiting_.clear();
  views_.clear();
  askers_ = 0;
  return tasks;
}

}  // namespace strata::render
