#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "core/progress.h"
#include "net/routes.h"

namespace strata::net {

// Computes automatic layers again, one after the other, soon after something that they read has changed: an edit, a record, a
// layer that is computed itself. Asks the database once a second, so that nothing is forgotten over a restart. What fails is
// tried again, less and less often.
class Recomputer {
 public:
  explicit Recomputer(const RouteContext& context);  // which must outlive it
  ~Recomputer() { stop(); }
  void stop();  // what is being computed is cancelled; waits

 private:
  struct Failure {
    std::chrono::steady_clock::time_point again;
    std::chrono::seconds pause;
  };
  void run();
  void recompute(const Layer& layer);
  bool is_stopping();

  const RouteContext& context_;
  std::map<std::int64_t, Failure> failures_;  // by layer
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace strata::net
