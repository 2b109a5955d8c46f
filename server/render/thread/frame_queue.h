#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// One frame, and all its requesters.
struct FrameTask {
  struct Asker {
    ViewHandle view = 0;
    Renderer::Done<SharedFrame> done;
    Renderer::LateChanges late_changes;  // may be empty
  };
  FrameRequest request;  // `request.view` draws the frame and need not be a requester
  std::vector<Asker> askers;
  struct Turn {
    bool acting = false;
    double ms = 0;  // the requester's served time at the frame's turn
    bool large = false;
  } turn;

  // Adds the changes since the requests, which the frame then shows. Further calls do nothing.
  void add_late_changes();
};

// Returns whether both requests show the same frame, except for changes on the surface.
bool same_picture(const FrameRequest& a, const FrameRequest& b);

// The waiting frame requests and the order of their turns. Thread-safe.
//
// 1. Each view has at most one waiting request. A newer request replaces it and also redraws its
//    area.
// 2. Requests for the same frame of one model (`FrameRequest::model`) are combined. The view that
//    has drawn this frame before draws it again.
// 3. Turns are fair by drawing time (start-time fair queueing): the view with the shortest served
//    time is next. A view without requests gains no advantage over waiting views. So an edit's
//    rectangle for a viewer precedes the next whole frame of a user who rotates the model, and no
//    request waits forever.
// 4. If both wait, acting users and onlookers (`FrameRequest::acting`) get half of the time each,
//    by rule 3. A hundred onlookers do not delay a user who paints, but still see the edits.
// 5. Bands of large images (`FrameRequest::large`) wait for their turns like all other requests.
//    Only a few of them are in progress at a time. Between their drawing steps, smaller frames
//    whose turns come first can be drawn.
//
// The GPU thread asks for a rectangle before each of its steps, so this takes the same time for one
// waiting view and for a thousand: the frames are sorted by their turns and found by their content.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t max_askers) : max_askers_(max_askers) {}

  struct Pushed {
    // False: the queue is full, and `displaced` contains the callback of the request.
    bool accepted = false;
    // The callback of the rejected or replaced request.
    std::optional<Renderer::Done<SharedFrame>> displaced{};
  };
  Pushed push(FrameRequest request, Renderer::Done<SharedFrame> done,
              Renderer::LateChanges late_changes = {});
  // Returns the next frame, but skips views with a frame in progress. The frame's views are then in
  // progress until `finished`.
  std::optional<FrameTask> take();
  // Like `take`, but returns only rectangles whose turn precedes all turns in `under_way`, so they
  // may precede whole frames in progress. If only bands of large images are in progress, it also
  // returns smaller whole frames.
  std::optional<FrameTask> take_part(std::span<const FrameTask::Turn> under_way);
  // The user of this view acts now. A waiting request of the view gets the turn of an acting user.
  void view_acts(ViewHandle view);
  // After a failure, the view that should have drawn the frame is not preferred for it any longer,
  // because it may have been removed.
  void finished(const FrameTask& task, double took_ms, bool is_drawn = true);
  void forget(ViewHandle view);       // called when the view is removed
  std::vector<FrameTask> take_all();  // also forgets the frames in progress and all views

 private:
  struct Waiting {
    FrameTask task;
    double turn_ms = 0;        // place in `turns_`
    std::uint64_t number = 0;  // a lower number waits longer
    std::size_t hash = 0;      // of the frame's content
  };
  using Place = std::list<Waiting>::iterator;
  struct View {
    bool acting = false;
    double served_ms = 0;  // compared with other views of its half
    std::optional<Place> waits;
    bool under_way = false;
    bool gone = false;                 // removed, but with a frame that waits or is in progress
    std::optional<FrameRequest> drew;  // the last frame that the view drew
    std::size_t drew_hash = 0;
  };
  // The state of acting users or of onlookers.
  struct Half {
    double served_ms = 0;
    double now_ms = 0;  // served time of the view with the last turn
    std::size_t under_way = 0;
  };
  // Frames with equal turns are sorted by the time of their arrival.
  struct ByTurn {
    bool operator()(const Place& a, const Place& b) const {
      return a->turn_ms < b->turn_ms || (a->turn_ms == b->turn_ms && a->number < b->number);
    }
  };
  using Turns = std::set<Place, ByTurn>;
  // The frames of one half. Rectangles are searched without a look at each whole frame.
  struct Sorted {
    Turns wholes, parts;
    bool empty() const { return wholes.empty() && parts.empty(); }
  };

  void leave(ViewHandle view, View& state);
  Half& half(bool acting) { return halves_[acting ? 0 : 1]; }
  const Half& half(bool acting) const { return halves_[acting ? 0 : 1]; }
  Sorted& sorted(bool acting) { return turns_[acting ? 0 : 1]; }
  Turns& turns(const FrameTask& task) {
    Sorted& frames = sorted(task.turn.acting);
    return task.request.changed ? frames.parts : frames.wholes;
  }
  void enter_half(View& state, bool acting, bool waited);
  bool is_acting(const FrameTask& task) const;     // any requester acts
  bool is_under_way(const FrameTask& task) const;  // a requester has another frame in progress
  bool is_before(const FrameTask::Turn& a, const FrameTask::Turn& b) const;
  bool acting_are_next() const { return half(true).served_ms <= half(false).served_ms; }
  static FrameTask::Turn turn_of(const Waiting& waiting) {
    return {waiting.task.turn.acting, waiting.turn_ms, waiting.task.request.large};
  }
  // Sorts a frame again after a change to its requesters or their served times.
  void sort(Place place);
  void remove_turn(Place place) { turns(place->task).erase(place); }
  void erase(Place place);  // from `waiting_` and the indexes
  // Returns the waiting frame with the same content, and the same choice of whole frame or part.
  std::optional<Place> find_same(const FrameRequest& request, std::size_t hash) const;
  void set_drew(ViewHandle view, View& state, const FrameRequest& request, std::size_t hash);
  void forget_drew(ViewHandle view, View& state);
  void erase_view(ViewHandle view);
  // Returns the view that will draw the frame, or nothing while that view has a frame in progress.
  std::optional<ViewHandle> drawer_of(const Waiting& waiting) const;
  std::optional<Place> first(bool acting, bool with_wholes);
  std::optional<Place> after(Place place, bool acting, bool with_wholes);
  static std::optional<Place> earlier(const Turns& a, Turns::const_iterator in_a, const Turns& b,
                                      Turns::const_iterator in_b);
  std::optional<double> next_turn_ms(bool acting) const;
  FrameTask take_at(Place place, ViewHandle drawer);

  const std::size_t max_askers_;
  std::mutex mutex_;
  std::list<Waiting> waiting_;   // oldest first
  std::array<Sorted, 2> turns_;  // the frames of `waiting_`: of acting users, of onlookers
  std::unordered_multimap<std::size_t, Place> by_content_;  // the frames of `waiting_`
  std::unordered_map<ViewHandle, View> views_;
  std::unordered_multimap<std::size_t, ViewHandle> drew_;  // the views by `View::drew`
  std::uint64_t numbers_ = 0;
  std::size_t askers_ = 0;  // requesters of the frames in `waiting_`
  std::array<Half, 2> halves_;
  std::size_t large_under_way_ = 0;
  double now_ms_ = 0;  // served time of the half with the last turn
};

}  // namespace strata::render
