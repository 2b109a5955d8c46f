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

// One picture, and all requesters of it.
struct FrameTask {
  struct Asker {
    ViewHandle view = 0;
    Renderer::Done<SharedFrame> done;
  };
  FrameRequest request;  // its view draws; it need not be a requester's view
  std::vector<Asker> askers;
  struct Turn {
    bool acting = false;
    double ms = 0;  // served time of its requester when its turn came
    bool large = false;
  } turn;
};

// Whether both requests show the same picture, except for changes on the surface.
bool same_picture(const FrameRequest& a, const FrameRequest& b);

// The waiting frames, and the order of their turns. Thread-safe.
//
// 1. A view has one place, where the latest request replaces the one before and inherits its area
//    to redraw.
// 2. Requests for the same picture of one model (`FrameRequest::model`) wait as one, and the view
//    that drew that picture before draws it.
// 3. Turns are fair by drawing time (start-time fair queueing): the next view is the one that was
//    served the fewest milliseconds. A view that had no requests for a while does not gain credit
//    over waiting views. So the rectangle of an edit, for a viewer, precedes the next whole picture
//    of a person who rotates the model, and no request waits without limit.
// 4. People who act and viewers (`FrameRequest::acting`) get half of the time each, if both wait,
//    by the same rule: a hundred viewers do not delay a person who paints, and still see the edits.
// 5. Bands of large pictures (`FrameRequest::large`) wait as all other requests do; only a few are
//    in progress at a time, and smaller pictures whose turn it is precede them at each of their
//    steps.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t max_askers) : max_askers_(max_askers) {}

  struct Pushed {
    // false: the queue is full; the request is in `displaced`
    bool accepted = false;
    // of the refused or the replaced request
    std::optional<Renderer::Done<SharedFrame>> displaced{};
  };
  Pushed push(FrameRequest request, Renderer::Done<SharedFrame> done);
  // Returns the next frame, except for views with a frame in progress; its views are then in
  // progress until `finished`.
  std::optional<FrameTask> take();
  // The same, for rectangles only, whose turn precedes all of these: they may precede whole
  // pictures in progress. If only bands of large pictures are in progress, any smaller picture may.
  std::optional<FrameTask> take_part(std::span<const FrameTask::Turn> under_way);
  void finished(const FrameTask& task, double took_ms);
  void forget(ViewHandle view);       // the view is removed
  std::vector<FrameTask> take_all();  // also clears frames in progress and all views

 private:
  using Place = std::list<FrameTask>::iterator;
  struct View {
    bool acting = false;
    double served_ms = 0;  // compared with views of its half
    std::optional<Place> waits;
    bool under_way = false;
    bool gone = false;                 // removed, but waiting or in progress
    std::optional<FrameRequest> drew;  // the last picture it drew
  };
  // people who act, or viewers
  struct Half {
    double served_ms = 0;
    double now_ms = 0;  // served time of the view whose turn was last
    std::size_t under_way = 0;
  };
  void leave(ViewHandle view, View& state);
  Half& half(bool acting) { return halves_[acting ? 0 : 1]; }
  const Half& half(bool acting) const { return halves_[acting ? 0 : 1]; }
  void enter_half(View& state, bool acting, bool waited);
  bool is_acting(const FrameTask& task) const;     // any of its askers
  bool is_under_way(const FrameTask& task) const;  // one of its askers has another in progress
  bool is_before(const FrameTask::Turn& a, const FrameTask::Turn& b) const;
  FrameTask::Turn turn_of(const FrameTask& task) const;
  // The view that will draw it; nothing while that view has another frame in progress.
  std::optional<ViewHandle> drawer_of(const FrameTask& task) const;
  template <class Predicate>
  std::optional<FrameTask> take_if(const Predicate& predicate);

  const std::size_t max_askers_;
  std::mutex mutex_;
  std::list<FrameTask> waiting_;  // oldest first
  std::unordered_map<ViewHandle, View> views_;
  std::size_t askers_ = 0;  // of `waiting_`
  std::array<Half, 2> halves_;
  std::size_t large_under_way_ = 0;
  double now_ms_ = 0;  // served time of the half whose turn was last
};

}  // namespace strata::render
