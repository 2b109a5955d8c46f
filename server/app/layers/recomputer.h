#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "app/services.h"
#include "core/ids.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "room/room.h"

namespace strata::app {

// Computes automatic layers again, one after the other, after something that they read has changed:
// an edit, a record, a layer that is computed itself. Edits of the model wait meanwhile, so it lets
// a second pass in which nobody paints, but ten at most. Asks the database once a second, so that
// nothing is forgotten over a restart. What fails is tried again, less and less often. Layers whose
// surface was never counted for the database (store::Layers::to_sum), as those of older versions,
// are counted likewise.
class Recomputer {
 public:
  explicit Recomputer(const Services& services);
  ~Recomputer() { stop(); }
  void stop();  // what is being computed is cancelled; waits

 private:
  struct Failure {
    std::chrono::steady_clock::time_point again;
    std::chrono::seconds pause;
  };
  struct Wait {
    std::int64_t sequence = -1;  // of the model when it was looked at last
    int checks = 0;
  };
  void run();
  bool is_quiet(const room::Room& room, LayerId layer_id);
  // `work` opens the room and does what is behind; what fails is told once.
  void attempt(const Layer& layer, const char* what,
               const std::function<Result<void>(const std::shared_ptr<room::Room>&)>& work);
  void recompute(const Layer& layer);
  bool is_stopping();

  const Services services_;
  std::map<LayerId, Failure> failures_;  // by layer
  std::map<LayerId, Wait> waits_;        // the same
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace strata::app
