#pragma once

#include <list>
#include <mutex>
#include <optional>
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
  double turn_ms = 0;  // what its asker had been served when its turn came
};

// Frames that wait, and whose turn it is. Thread-safe.
//
// 1. A view has one place, where the latest request wins and inherits what the replaced one had to redraw.
// 2. Requests for the same picture of one model (`FrameRequest::model`) wait as one, and are drawn by the view that drew that picture before.
// 3. Turns are fair by what drawing has taken (start-time fair queueing): next is who was served the fewest milliseconds, and who did
//    not ask for a while has no more credit than who waits. So the rectangle of an edit, for someone who only looks, goes before
//    the next whole picture of someone who turns the model, and nobody waits for ever.
class FrameQueue {
 public:
  explicit FrameQueue(std::size_t max_askers) : max_askers_(max_askers) {}

  struct Pushed {
    bool accepted = false;                                   // false: too many wait; the request is in `displaced`
    std::optional<Renderer::Done<SharedFrame>> displaced{};  // of the refused request, or of the one it replaced
  };
  Pushed push(FrameRequest request, Renderer::Done<SharedFrame> done);
  // What is next, except for views with a frame under way; its views are then under way until `finished`.
  std::optional<FrameTask> take();
  // The same, of rectangles only, whose asker was served less than `turn_ms`: they may go before a whole picture that is half done.
  std::optional<FrameTask> take_part(double turn_ms);
  void finished(const FrameTask& task, double took_ms);
  void forget(ViewHandle view);       // it is removed
  std::vector<FrameTask> take_all();  // and nothing is under way or known any more

 private:
  using Place = std::list<FrameTask>::iterator;
  struct View {
    double served_ms = 0;
    std::optional<Place> waits;
    bool under_way = false;
    bool gone = false;                 // removed, but still waited for or under way
    std::optional<FrameRequest> drew;  // the last picture it drew
  };
  void leave(ViewHandle view, View& state);
  double turn_of(const FrameTask& task) const;
  // The view to draw it; none while that one has another frame under way.
  std::optional<ViewHandle> drawer_of(const FrameTask& task) const;
  template <class Wanted>
  std::optional<FrameTask> take_if(const Wanted& wanted);

  const std::size_t max_askers_;
  std::mutex mutex_;
  std::list<FrameTask> waiting_;  // oldest first
  std::unordered_map<ViewHandle, View> views_;
  std::size_t askers_ = 0;  // of `waiting_`
  double now_ms_ = 0;       // what the one whose turn was last had been served
};

}  // namespace strata::render
