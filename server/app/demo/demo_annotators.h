#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "app/services.h"
#include "core/ids.h"
#include "domain/scene/model.h"

namespace strata::room {
class Room;
}

namespace strata::app {

// The two demo users. They paint on the demo's pot while a single visitor has it open. This shows
// the visitor how several users work on one surface. Their names show that their strokes are
// recorded. They undo their strokes and leave at the end of the scene, when a second visitor comes,
// or when the visitor leaves.
class DemoAnnotators {
 public:
  struct Pace {
    std::chrono::milliseconds before_first{4000};  // after the arrival of the visitor
    std::chrono::milliseconds per_batch{120};
    std::chrono::milliseconds between_strokes{1500};
    std::chrono::milliseconds before_undo{8000};
    std::chrono::minutes rest{10};  // until they paint on the same model again
  };

  explicit DemoAnnotators(const Services& services) : DemoAnnotators(services, Pace{}) {}
  DemoAnnotators(const Services& services, Pace pace);
  ~DemoAnnotators() { stop(); }
  // Call it when a user has opened a model. Ignores models other than the demo's. Does not wait.
  void visited(const Model& model);
  void stop();  // waits until all strokes are undone

 private:
  struct Scene;

  void run();
  void play(ModelId model_id);
  // Waits. Returns false if the scene must end.
  bool pause(std::chrono::milliseconds time, const room::Room& room);

  const Services services_;
  const Pace pace_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::optional<ModelId> visited_;
  std::map<ModelId, std::chrono::steady_clock::time_point> played_;
  std::thread thread_;
};

}  // namespace strata::app
