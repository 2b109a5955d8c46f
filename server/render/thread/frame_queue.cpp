#include "render/thread/frame_queue.h"

#include <algorithm>
#include <functional>
#include <limits>
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

// Requests for the same picture have the same hash. In addition to the camera, it contains what
// differs between people with the same saved view: the size of the window, layers and palettes.
std::size_t hash_of(const FrameRequest& request) {
  std::size_t hash = std::hash<ModelHandle>()(request.model);
  const auto add = [&]<class Value>(const Value& value) {
    hash = hash * 1099511628211u ^ std::hash<Value>()(value);
  };
  for (const glm::dmat4& matrix : {request.camera.view, request.camera.projection})
    for (glm::length_t column = 0; column < 4; ++column)
      for (glm::length_t row = 0; row < 4; ++row) add(matrix[column][row]);
  add(request.width);
  add(request.height);
  add(request.moving);
  add(request.samples);
  for (const LayerStyle& style : request.style.layers) {
    add(style.layer);
    add(style.palette.get());
    add(style.opacity);
  }
  return hash;
}

}  // namespace

bool same_picture(const FrameRequest& a, const FrameRequest& b) {
  return a.model != 0 && a.model == b.model && a.moving == b.moving && a.width == b.width &&
         a.height == b.height && a.camera == b.camera && a.style == b.style &&
         a.background_rows == b.background_rows && a.large == b.large && a.samples == b.samples &&
         a.smooth == b.smooth && a.align_to_16 == b.align_to_16;
}

void FrameTask::add_late_changes() {
  for (Asker& asker : askers) {
    if (!asker.late_changes) continue;
    const auto boxes = std::exchange(asker.late_changes, {})();
    for (const auto& box : boxes)
      if (request.changed) add_box(*request.changed, box, kMaxBoxes);
  }
}

FrameQueue::Pushed FrameQueue::push(FrameRequest request, Renderer::Done<SharedFrame> done,
                                    Renderer::LateChanges late_changes) {
  std::lock_guard lock(mutex_);
  const ViewHandle view = request.view;
  View& state = views_[view];
  Pushed pushed{true, std::nullopt};
  const bool waited = state.waits.has_value();
  if (waited) {
    inherit(request, (*state.waits)->task.request);
    auto& askers = (*state.waits)->task.askers;
    const auto mine = std::find_if(askers.begin(), askers.end(),
                                   [&](const auto& one) { return one.view == view; });
    pushed.displaced = std::move(mine->done);
    leave(view, state);
  } else if (askers_ >= max_askers_) {
    return {false, std::move(done)};
  }
  enter_half(state, request.acting, waited);
  const std::size_t hash = hash_of(request);
  const auto same = find_same(request, hash);
  Place place;
  if (same) {
    place = *same;
    inherit(place->task.request, request);
    remove_turn(place);
  } else {
    waiting_.push_back({{std::move(request), {}, {}}, 0, ++numbers_, hash});
    place = std::prev(waiting_.end());
    by_content_.emplace(hash, place);
  }
  place->task.askers.push_back({view, std::move(done), std::move(late_changes)});
  state.waits = place;
  sort(place);
  ++askers_;
  return pushed;
}

// Moves a view to the half for acting users or the half for onlookers. A view that changes halves
// gets the served time of the last turn in the new half.
void FrameQueue::enter_half(View& state, bool acting, bool waited) {
  Half& to = half(acting);
  if (to.under_way == 0 && sorted(acting).empty()) to.served_ms = std::max(to.served_ms, now_ms_);
  if (std::exchange(state.acting, acting) != acting)
    state.served_ms = to.now_ms;
  else if (!state.under_way && !waited)
    state.served_ms = std::max(state.served_ms, to.now_ms);
}

bool FrameQueue::is_acting(const FrameTask& task) const {
  return std::ranges::any_of(task.askers,
                             [&](const auto& asker) { return views_.at(asker.view).acting; });
}

void FrameQueue::sort(Place place) {
  FrameTask& task = place->task;
  task.turn.acting = is_acting(task);
  place->turn_ms = std::numeric_limits<double>::infinity();
  for (const auto& asker : task.askers)
    if (const View& state = views_.at(asker.view); state.acting == task.turn.acting)
      place->turn_ms = std::min(place->turn_ms, state.served_ms);
  turns(task).insert(place);
}

void FrameQueue::leave(ViewHandle view, View& state) {
  const Place place = *state.waits;
  remove_turn(place);
  std::erase_if(place->task.askers, [&](const auto& one) { return one.view == view; });
  if (place->task.askers.empty())
    erase(place);
  else
    sort(place);
  state.waits.reset();
  --askers_;
}

void FrameQueue::erase(Place place) {
  auto [entry, end] = by_content_.equal_range(place->hash);
  while (entry != end && entry->second != place) ++entry;
  if (entry != end) by_content_.erase(entry);
  waiting_.erase(place);
}

std::optional<FrameQueue::Place> FrameQueue::find_same(const FrameRequest& request,
                                                       std::size_t hash) const {
  // A request for a part is not combined with a request for the whole frame.
  for (auto [entry, end] = by_content_.equal_range(hash); entry != end; ++entry) {
    const FrameRequest& other = entry->second->task.request;
    if (other.changed.has_value() == request.changed.has_value() && same_picture(other, request))
      return entry->second;
  }
  return std::nullopt;
}

void FrameQueue::set_drew(ViewHandle view, View& state, const FrameRequest& request,
                          std::size_t hash) {
  forget_drew(view, state);
  state.drew = request;
  state.drew_hash = hash;
  if (request.model != 0) drew_.emplace(hash, view);
}

void FrameQueue::forget_drew(ViewHandle view, View& state) {
  if (!state.drew) return;
  auto [entry, end] = drew_.equal_range(state.drew_hash);
  while (entry != end && entry->second != view) ++entry;
  if (entry != end) drew_.erase(entry);
  state.drew.reset();
}

void FrameQueue::erase_view(ViewHandle view) {
  forget_drew(view, views_.at(view));
  views_.erase(view);
}

bool FrameQueue::is_before(const FrameTask::Turn& a, const FrameTask::Turn& b) const {
  if (a.acting == b.acting) return a.ms < b.ms;
  return a.acting == acting_are_next();
}

bool FrameQueue::is_under_way(const FrameTask& task) const {
  return std::ranges::any_of(task.askers,
                             [&](const auto& asker) { return views_.at(asker.view).under_way; });
}

std::optional<ViewHandle> FrameQueue::drawer_of(const Waiting& waiting) const {
  const FrameTask& task = waiting.task;
  if (is_under_way(task)) return std::nullopt;
  const auto has_it = [&](const View& state) {
    return state.drew && state.drew_hash == waiting.hash && same_picture(*state.drew, task.request);
  };
  for (const auto& asker : task.askers)
    if (has_it(views_.at(asker.view))) return asker.view;
  for (auto [entry, end] = drew_.equal_range(waiting.hash); entry != end; ++entry) {
    const View& state = views_.at(entry->second);
    if (!has_it(state)) continue;
    return state.under_way ? std::nullopt : std::optional(entry->second);
  }
  return task.askers.front().view;
}

FrameTask FrameQueue::take_at(Place place, ViewHandle drawer) {
  const FrameTask::Turn turn = turn_of(*place);
  Half& from = half(turn.acting);
  large_under_way_ += place->task.request.large;
  from.now_ms = std::max(from.now_ms, turn.ms);
  now_ms_ = std::max(now_ms_, from.served_ms);
  ++from.under_way;
  remove_turn(place);
  place->task.request.view = drawer;
  place->task.turn = turn;
  for (const auto& asker : place->task.askers) {
    View& state = views_.at(asker.view);
    state.waits.reset();
    state.under_way = true;
  }
  askers_ -= place->task.askers.size();
  View& drawing = views_.at(drawer);
  drawing.under_way = true;
  if (!drawing.gone) set_drew(drawer, drawing, place->task.request, place->hash);
  FrameTask task = std::move(place->task);
  erase(place);
  return task;
}

// Returns the frame of a half whose turn is first: of its rectangles, or also of its whole frames.
std::optional<FrameQueue::Place> FrameQueue::first(bool acting, bool with_wholes) {
  const Sorted& frames = sorted(acting);
  return earlier(frames.parts, frames.parts.begin(), frames.wholes,
                 with_wholes ? frames.wholes.begin() : frames.wholes.end());
}

// Like `first`, for the turns after that of `place`.
std::optional<FrameQueue::Place> FrameQueue::after(Place place, bool acting, bool with_wholes) {
  const Sorted& frames = sorted(acting);
  return earlier(frames.parts, frames.parts.upper_bound(place), frames.wholes,
                 with_wholes ? frames.wholes.upper_bound(place) : frames.wholes.end());
}

std::optional<FrameQueue::Place> FrameQueue::earlier(const Turns& a, Turns::const_iterator in_a,
                                                     const Turns& b, Turns::const_iterator in_b) {
  if (in_a == a.end() && in_b == b.end()) return std::nullopt;
  if (in_b == b.end() || (in_a != a.end() && ByTurn()(*in_a, *in_b))) return *in_a;
  return *in_b;
}

// Returns the next turn of a half, of a frame whose requesters have no other frame in progress.
std::optional<double> FrameQueue::next_turn_ms(bool acting) const {
  std::optional<double> next_ms;
  const Sorted& frames = turns_[acting ? 0 : 1];
  for (const Turns* turns : {&frames.wholes, &frames.parts}) {
    const auto found = std::ranges::find_if(
        *turns, [&](const Place& place) { return !is_under_way(place->task); });
    if (found != turns->end())
      next_ms = std::min(next_ms.value_or((*found)->turn_ms), (*found)->turn_ms);
  }
  return next_ms;
}

std::optional<FrameTask> FrameQueue::take() {
  std::lock_guard lock(mutex_);
  for (const bool acting : {acting_are_next(), !acting_are_next()})
    for (auto next = first(acting, true); next; next = after(*next, acting, true)) {
      if ((*next)->task.request.large && large_under_way_ >= kMaxLarge) continue;
      if (const auto drawer = drawer_of(**next)) return take_at(*next, *drawer);
    }
  return std::nullopt;
}

std::optional<FrameTask> FrameQueue::take_part(std::span<const FrameTask::Turn> under_way) {
  std::lock_guard lock(mutex_);
  // A band of a large image takes longer than most frames, which need not wait for its end.
  const bool only_large =
      !under_way.empty() && std::ranges::all_of(under_way, &FrameTask::Turn::large);
  const auto may_go_before = [&](const FrameTask& task) {
    return task.request.changed.has_value() || (only_large && !task.request.large);
  };
  for (const bool acting : {acting_are_next(), !acting_are_next()}) {
    // The next turn of this half. A rectangle must not use a whole frame's turn to precede the
    // other half. Otherwise rectangles alone could use all the time of their half.
    const auto next_ms = next_turn_ms(acting);
    for (auto next = first(acting, only_large); next; next = after(*next, acting, only_large)) {
      const Place place = *next;
      if (is_under_way(place->task)) continue;
      const auto turn = turn_of(*place);
      // No later turn of this half precedes the frames in progress if this turn does not.
      if (!std::ranges::all_of(under_way, [&](const FrameTask::Turn& one) {
            return is_before(turn, one) && (turn.acting == one.acting || turn.ms <= *next_ms);
          }))
        break;
      if (!may_go_before(place->task)) continue;
      if (const auto drawer = drawer_of(*place)) return take_at(place, *drawer);
    }
    // A rectangle must not use a turn of the other half either.
    if (next_ms) break;
  }
  return std::nullopt;
}

void FrameQueue::view_acts(ViewHandle view) {
  std::lock_guard lock(mutex_);
  const auto found = views_.find(view);
  if (found == views_.end() || !found->second.waits || found->second.acting) return;
  const Place place = *found->second.waits;
  remove_turn(place);
  enter_half(found->second, true, true);
  place->task.request.acting = true;
  sort(place);
}

void FrameQueue::finished(const FrameTask& task, double took_ms, bool is_drawn) {
  std::lock_guard lock(mutex_);
  const auto rests = [&](ViewHandle view, double served_ms) {
    const auto found = views_.find(view);
    if (found == views_.end()) return;
    View& state = found->second;
    state.under_way = false;
    if (state.waits) remove_turn(*state.waits);
    state.served_ms += served_ms;
    if (state.waits) sort(*state.waits);
    // A request that was pushed after `forget` fails, and nothing else would erase its view.
    const bool failed = !is_drawn && view == task.request.view;
    if (failed) forget_drew(view, state);
    if ((state.gone || failed) && !state.waits) erase_view(view);
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
  const auto found = views_.find(view);
  if (found == views_.end()) return;
  View& state = found->second;
  state.gone = true;
  forget_drew(view, state);
  // A waiting request of this view keeps its turn. It then fails because the view does not exist.
  if (!state.waits && !state.under_way) erase_view(view);
}

std::vector<FrameTask> FrameQueue::take_all() {
  std::lock_guard lock(mutex_);
  std::vector<FrameTask> tasks;
  for (Waiting& waiting : waiting_) tasks.push_back(std::move(waiting.task));
  turns_ = {};
  by_content_.clear();
  waiting_.clear();
  drew_.clear();
  views_.clear();
  halves_ = {};
  large_under_way_ = 0;
  now_ms_ = 0;
  askers_ = 0;
  return tasks;
}

}  // namespace strata::render
