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
    std::optional<std::uint64_t> began_at;  // `changes_` then
    bool is_over = false;
  };

  // A new task that waits to be drawn; null if the request joins a task: one that was not started,
  // or since whose start no layer changed.
  std::shared_ptr<Task> push(FrameRequest request, Done done);
  // Layers change: called after the change was posted to the GPU thread.
  void content_changed();
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
  std::uint64_t changes_ = 0;                            // of layers
  std::list<std::weak_ptr<Task>> tasks_;
};

}  // namespace strata::render
