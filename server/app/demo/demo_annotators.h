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

// The two people of the demo's story, who paint while somebody looks at its pot alone: so a first
// visitor sees how several people work on one surface. Their names say that they are recorded. When
// the scene is over, when a second person comes, or when the visitor leaves, they take back what
// they painted and leave, too.
class DemoAnnotators {
 public:
  struct Pace {
    std::chrono::milliseconds before_first{4000};  // after the visitor came
    std::chrono::milliseconds per_batch{120};
    std::chrono::milliseconds between_strokes{1500};
    std::chrono::milliseconds before_undo{8000};
    std::chrono::minutes rest{10};  // until they come to the same model again
  };

  explicit DemoAnnotators(const Services& services) : DemoAnnotators(services, Pace{}) {}
  DemoAnnotators(const Services& services, Pace pace);
  ~DemoAnnotators() { stop(); }
  // Somebody has opened the model, which may be another one than the demo's. Returns at once.
  void visited(const Model& model);
  void stop();  // waits until they have taken back their strokes

 private:
  struct Scene;

  void run();
  void play(ModelId model_id);
  // Returns false if the scene has to end.
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
