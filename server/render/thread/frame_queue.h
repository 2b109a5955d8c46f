#pragma once

#include <array>
#include <list>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// One picture, and all who asked for it.
struct FrameTask {
  struct Asker {
    ViewHandle view = 0;
    Renderer::Done<SharedFrame> done;
  };
  FrameRequest request;  // its view is the one that draws, and need not be an asker's
  std::vector<Asker> askers;
  struct Turn {
    bool acting = false;
    double ms = 0;  // what its asker had been served when its turn came
    bool large = false;
  } turn;
};

// Frames that wait, and whose turn it is. Thread-safe.
//
// 1. A view has one place, where the latest request wins and inherits what the replaced one had to
// redraw.
// 2. Requests for the same picture of one model (`FrameRequest::model`) wait as one, and are drawn
// by the view that drew that picture before.
// 3. Turns are fair by what drawing has taken (start-time fair queueing): next is who was served
// the fewest milliseconds, and who did
//    not ask for a while has no more credit than who waits. So the rectangle of an edit, for
//    someone who only looks, goes before the next whole picture of someone who turns the model, and
//    nobody waits for ever.
// 4. Those who act and those who look on (`FrameRequest::acting`) have half of the time each, where
// both wait, by the same rule: a
//    hundred onlookers do not hold up one who paints, and see what is painted nevertheless.
// 5. Bands of large pictures (`FrameRequest::large`) wait as all others do, a few are under way at
// a time, and what is smaller and whose turn
//    it is goes before them at each of their steps.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t max_askers) : max_askers_(max_askers) {}

  struct Pushed {
    // false: too many wait; the request is in `displaced`
    bool accepted = false;
    // of the refused request, or of the one it replaced
    std::optional<Renderer::Done<SharedFrame>> displaced{};
  };
  Pushed push(FrameRequest request, Renderer::Done<SharedFrame> done);
  // What is next, except for views with a frame under way; its views are then under way until
  // `finished`.
  std::optional<FrameTask> take();
  // The same, of rectangles only, whose turn is before all of these: they may go before whole
  // pictures that are half done. Before bands of large pictures alone any smaller picture may.
  std::optional<FrameTask> take_part(std::span<const FrameTask::Turn> under_way);
  void finished(const FrameTask& task, double took_ms);
  void forget(ViewHandle view);       // it is removed
  std::vector<FrameTask> take_all();  // and nothing is under way or known any more

 private:
  using Place = std::list<FrameTask>::iterator;
  struct View {
    bool acting = false;
    double served_ms = 0;  // among those of its half
    std::optional<Place> waits;
    bool under_way = false;
    bool gone = false;                 // removed, but still waited for or under way
    std::optional<FrameRequest> drew;  // the last picture it drew
  };
  struct Half {  // those who act, or those who look on
    double served_ms = 0;
    double now_ms = 0;  // what the one whose turn was last had been served
    std::size_t under_way = 0;
  };
  void leave(ViewHandle view, View& state);
  Half& half(bool acting) { return halves_[acting ? 0 : 1]; }
  const Half& half(bool acting) const { return halves_[acting ? 0 : 1]; }
  void enter_half(View& state, bool acting, bool waited);
  bool is_acting(const FrameTask& task) const;     // any of its askers
  bool is_under_way(const FrameTask& task) const;  // another frame of one of its askers is
  bool is_before(const FrameTask::Turn& a, const FrameTask::Turn& b) const;
  FrameTask::Turn turn_of(const FrameTask& task) const;
  // The view to draw it; none while that one has another frame under way.
  std::optional<ViewHandle> drawer_of(const FrameTask& task) const;
  template <class Wanted>
  std::optional<FrameTask> take_if(const Wanted& wanted);

  const std::size_t max_askers_;
  std::mutex mutex_;
  std::list<FrameTask> waiting_;  // oldest first
  std::unordered_map<ViewHandle, View> views_;
  std::size_t askers_ = 0;  // of `waiting_`
  std::array<Half, 2> halves_;
  std::size_t large_under_way_ = 0;
  double now_ms_ = 0;  // what the half whose turn was last had been served
};

}  // namespace strata::render
