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

// Computes automatic layers again when their inputs have changed. Inputs are edits, records and
// other computed layers. Computes one layer after the other. A computation blocks edits of the
// model, so `attempt` first waits for a second without edits. It waits at most ten times. Polls the
// database once a second, so a restart loses no change. Retries failures at increasing intervals.
// Also sums the areas of the values of a layer if they were never summed (store::Layers::to_sum),
// as in layers from older versions.
class Recomputer {
 public:
  explicit Recomputer(const Services& services);
  ~Recomputer() { stop(); }
  void stop();  // cancels the running computation and waits for it

 private:
  struct Failure {
    std::chrono::steady_clock::time_point again;
    std::chrono::seconds pause;
  };
  struct Wait {
    std::int64_t sequence = -1;  // sequence of the model at the last check
    int checks = 0;
  };
  void run();
  bool is_quiet(const room::Room& room, LayerId layer_id);
  // `work` updates the layer in the opened room. Logs a repeated failure only once.
  void attempt(const Layer& layer, const char* what,
               const std::function<Result<void>(const std::shared_ptr<room::Room>&)>& work);
  void recompute(const Layer& layer);
  bool is_stopping();

  const Services services_;
  std::map<LayerId, Failure> failures_;  // by layer
  std::map<LayerId, Wait> waits_;        // by layer
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace strata::app
