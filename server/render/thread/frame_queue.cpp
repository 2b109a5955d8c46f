#include "render/thread/frame_queue.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "render/thread/screen_rect.h"

namespace strata::render {
namespace {

constexpr std::size_t kMaxBoxes = 64;
// One band is drawn while another is read back. More bands would take slots from smaller frames
// (GpuThread).
constexpr std::size_t kMaxLarge = 2;

// Merges the changes, so the result covers the areas of both requests.
void inherit(FrameRequest& request, const FrameRequest& other) {
  if (!request.changed) return;
  if (!other.changed) {
    request.changed.reset();
    return;
  }
  for (const auto& box : *other.changed) add_box(*request.changed, box, kMaxBoxes);
}

}  // namespace

bool same_picture(const FrameRequest& a, const FrameRequest& b) {
  return a.model != 0 && a.model == b.model && a.moving == b.moving && a.width == b.width &&
         a.height == b.height && a.camera == b.camera && a.style == b.style &&
         a.background_rows == b.background_rows && a.large == b.large && a.samples == b.samples &&
         a.smooth == b.smooth && a.align_to_16 == b.align_to_16;
}

FrameQueue::Pushed FrameQueue::push(FrameRequest request, Renderer::Done<SharedFrame> done) {
  std::lock_guard lock(mutex_);
  const ViewHandle view = request.view;
  View& state = views_[view];
  Pushed pushed{true, std::nullopt};
  const bool waited = state.waits.has_value();
  if (waited) {
    inherit(request, (*state.waits)->request);
    auto& askers = (*state.waits)->askers;
    const auto mine = std::find_if(askers.begin(), askers.end(),
                                   [&](const auto& one) { return one.view == view; });
    pushed.displaced = std::move(mine->done);
    leave(view, state);
  } else if (askers_ >= max_askers_) {
    return {false, std::move(done)};
  }
  enter_half(state, request.acting, waited);
  // A request for a part is not combined with a request for the whole frame.
  auto same = std::find_if(waiting_.begin(), waiting_.end(), [&](const FrameTask& other) {
    return other.request.changed.has_value() == request.changed.has_value() &&
           same_picture(other.request, request);
  });
  if (same == waiting_.end()) {
    waiting_.push_back({std::move(request), {}, {}});
    same = std::prev(waiting_.end());
  } else {
    inherit(same->request, request);
  }
  same->askers.push_back({view, std::move(done)});
  same->turn.acting = is_acting(*same);
  state.waits = same;
  ++askers_;
  return pushed;
}

// Moves a view to the half for acting users or the half for onlookers. A view that changes halves
// gets the served time of the last turn in the new half.
void FrameQueue::enter_half(View& state, bool acting, bool waited) {
  Half& to = half(acting);
  const bool is_empty =
      to.under_way == 0 && std::ranges::none_of(waiting_, [&](const FrameTask& task) {
        return task.turn.acting == acting;
      });
  if (is_empty) to.served_ms = std::max(to.served_ms, now_ms_);
  if (std::exchange(state.acting, acting) != acting)
    state.served_ms = to.now_ms;
  else if (!state.under_way && !waited)
    state.served_ms = std::max(state.served_ms, to.now_ms);
}

bool FrameQueue::is_acting(const FrameTask& task) const {
  return std::ranges::any_of(task.askers,
                             [&](const auto& asker) { return views_.at(asker.view).acting; });
}

void FrameQueue::leave(ViewHandle view, View& state) {
  const Place place = *state.waits;
  std::erase_if(place->askers, [&](const auto& one) { return one.view == view; });
  if (place->askers.empty())
    waiting_.erase(place);
  else
    place->turn.acting = is_acting(*place);
  state.waits.reset();
  --askers_;
}

FrameTask::Turn FrameQueue::turn_of(const FrameTask& task) const {
  double ms = std::numeric_limits<double>::infinity();
  for (const auto& asker : task.askers)
    if (const View& state = views_.at(asker.view); state.acting == task.turn.acting)
      ms = std::min(ms, state.served_ms);
  return {task.turn.acting, ms, task.request.large};
}

bool FrameQueue::is_before(const FrameTask::Turn& a, const FrameTask::Turn& b) const {
  if (a.acting == b.acting) return a.ms < b.ms;
  const double of_a = half(a.acting).served_ms, of_b = half(b.acting).served_ms;
  return of_a < of_b || (of_a == of_b && a.acting);
}

bool FrameQueue::is_under_way(const FrameTask& task) const {
  return std::ranges::any_of(task.askers,
                             [&](const auto& asker) { return views_.at(asker.view).under_way; });
}

std::optional<ViewHandle> FrameQueue::drawer_of(const FrameTask& task) const {
  if (is_under_way(task)) return std::nullopt;
  const auto has_it = [&](const View& state) {
    return state.drew && same_picture(*state.drew, task.request);
  };
  for (const auto& asker : task.askers)
    if (has_it(views_.at(asker.view))) return asker.view;
  if (task.request.model != 0)
    for (const auto& [view, state] : views_) {
      if (!has_it(state)) continue;
      return state.under_way ? std::nullopt : std::optional(view);
    }
  return task.askers.front().view;
}

template <class Predicate>
std::optional<FrameTask> FrameQueue::take_if(const Predicate& predicate) {
  std::set<const FrameTask*> cannot;
  for (;;) {
    Place next = waiting_.end();
    FrameTask::Turn turn;
    for (auto place = waiting_.begin(); place != waiting_.end(); ++place) {
      const auto its = turn_of(*place);
      if (cannot.contains(&*place) || !predicate(*place, its)) continue;
      if (next != waiting_.end() && !is_before(its, turn)) continue;
      turn = its;
      next = place;
    }
    if (next == waiting_.end()) return std::nullopt;
    const auto drawer = drawer_of(*next);
    if (!drawer) {
      cannot.insert(&*next);
      continue;
    }
    Half& from = half(turn.acting);
    large_under_way_ += next->request.large;
    from.now_ms = std::max(from.now_ms, turn.ms);
    now_ms_ = std::max(now_ms_, from.served_ms);
    ++from.under_way;
    next->request.view = *drawer;
    next->turn = turn;
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
  return take_if([this](const FrameTask& task, const FrameTask::Turn&) {
    return !task.request.large || large_under_way_ < kMaxLarge;
  });
}

std::optional<FrameTask> FrameQueue::take_part(std::span<const FrameTask::Turn> under_way) {
  std::lock_guard lock(mutex_);
  // The next turn of each half. A rectangle must not use a turn of the other half. It also must not
  // use a whole frame's turn to precede the other half. Otherwise rectangles alone could use all
  // the time of their half.
  std::array<std::optional<FrameTask::Turn>, 2> next;
  for (const FrameTask& task : waiting_) {
    auto& first = next[task.turn.acting ? 0 : 1];
    if (is_under_way(task)) continue;
    if (const auto its = turn_of(task); !first || its.ms < first->ms) first = its;
  }
  // A band of a large image takes longer than most frames, which need not wait for its end.
  const bool only_large =
      !under_way.empty() && std::ranges::all_of(under_way, &FrameTask::Turn::large);
  const auto may_go_before = [&](const FrameTask& task) {
    return task.request.changed.has_value() || (only_large && !task.request.large);
  };
  return take_if([&](const FrameTask& task, const FrameTask::Turn& its) {
    if (is_under_way(task) || !may_go_before(task)) return false;
    const auto &own = next[its.acting ? 0 : 1], &other = next[its.acting ? 1 : 0];
    if (other && is_before(*other, its)) return false;
    return std::ranges::all_of(under_way, [&](const FrameTask::Turn& one) {
      return is_before(its, one) && (its.acting == one.acting || its.ms <= own->ms);
    });
  });
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
  for (const auto& asker : task.askers)
    rests(asker.view, took_ms / static_cast<double>(task.askers.size()));
  rests(task.request.view, 0);
  Half& its = half(task.turn.acting);
  if (its.under_way == 0) return;  // `take_all` has removed the frame
  large_under_way_ -= task.request.large;
  its.served_ms += took_ms;
  --its.under_way;
}

void FrameQueue::forget(ViewHandle view) {
  std::lock_guard lock(mutex_);
  const auto state = views_.find(view);
  if (state == views_.end()) return;
  state->second.gone = true;
  state->second.drew.reset();
  // A waiting request of this view keeps its turn. It then fails because the view does not exist.
  if (!state->second.waits && !state->second.under_way) views_.erase(state);
}

std::vector<FrameTask> FrameQueue::take_all() {
  std::lock_guard lock(mutex_);
  std::vector<FrameTask> tasks(std::make_move_iterator(waiting_.begin()),
                               std::make_move_iterator(waiting_.end()));
  waiting_.clear();
  views_.clear();
  halves_ = {};
  large_under_way_ = 0;
  now_ms_ = 0;
  askers_ = 0;
  return tasks;
}

}  // namespace strata::render
