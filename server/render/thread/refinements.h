#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// Returns the Error for a request that a newer request of its view replaced.
Error superseded_error();

// The refinements that views wait for. They are not in the queue of frames and use no turns of
// their views. After a newer request, a view no longer waits for its refinement. A refinement ends
// when no view waits for it. Thread-safe.
class Refinements {
 public:
  using Done = Renderer::Done<SharedFrame>;
  // One frame, and the views that wait for it.
  struct Task {
    FrameRequest request;

   private:
    friend class Refinements;
    struct Asker {
      ViewHandle view;
      std::uint64_t draw;  // the number of the view's other requests before this one
      Done done;
    };
    std::vector<Asker> askers;
    std::optional<std::uint64_t> began_at;  // `changes_` at the start
    bool is_over = false;
  };

  // Returns a new task. Returns null if the request was added to an existing task. Such a task has
  // not started, or no layer has changed since its start.
  std::shared_ptr<Task> push(FrameRequest request, Done done);
  // Notes a change to a layer. Called after the change was posted to the GPU thread.
  void content_changed();
  // Notes that the view requested another frame.
  void overtake(ViewHandle view);
  void forget(ViewHandle view);  // called when the view is removed
  // Starts or continues a task. Requesters with a newer request get the Error `superseded`. Returns
  // false if no other requester is left.
  bool continues(Task& task);
  // Sends the result to all requesters and ends the task.
  void answer(Task& task, const Result<SharedFrame>& frame);

 private:
  std::vector<Done> take_overtaken(Task& task);

  std::mutex mutex_;
  // The number of other requests of each view that requested a refinement.
  std::unordered_map<ViewHandle, std::uint64_t> draws_;
  std::uint64_t changes_ = 0;  // number of changes to layers
  std::list<std::weak_ptr<Task>> tasks_;
};

}  // namespace strata::render
