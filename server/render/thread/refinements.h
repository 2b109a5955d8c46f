#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "render/renderer.h"

namespace strata::render {

// Of a request whose view made a newer one.
Error superseded_error();

// The refinements that views wait for, apart from the queue of frames: a refinement takes no turn
// of its views. A newer request of a view ends its part in a refinement; a refinement that no view
// waits for ends. Thread-safe.
class Refinements {
 public:
  using Done = Renderer::Done<SharedFrame>;
  // One picture, and the views that wait for it.
  struct Task {
    FrameRequest request;

   private:
    friend class Refinements;
    struct Asker {
      ViewHandle view;
      std::uint64_t draw;  // the number of the view's newest other request at that time
      Done done;
    };
    std::vector<Asker> askers;
    bool started = false;  // it may show an older state than a new request would
  };

  // A new task that waits to be drawn; null if the request joins a task that was not started.
  std::shared_ptr<Task> push(FrameRequest request, Done done);
  // The view requests another picture.
  void overtake(ViewHandle view);
  void forget(ViewHandle view);  // it is removed
  // Starts or continues a task: answers askers that requested something newer. False if none is
  // left.
  bool continues(Task& task);
  // Answers all askers; the task is over.
  void answer(Task& task, const Result<SharedFrame>& frame);

 private:
  std::vector<Done> take_overtaken(Task& task);

  std::mutex mutex_;
  std::unordered_map<ViewHandle, std::uint64_t> draws_;  // of views that asked for a refinement
  std::list<std::weak_ptr<Task>> waiting_;
};

}  // namespace strata::render
