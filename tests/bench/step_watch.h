#pragma once

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/progress.h"

namespace strata::bench {

// Measures seconds, processor seconds and peak memory of the steps of long work. The progress
// messages of the work separate the steps. A thread reads the messages once a millisecond.
class StepWatch {
 public:
  // Runs `work` and records each message that `progress` shows as a step. `name` is the step before
  // the first message.
  template <class Work>
  auto run(const std::string& name, Progress& progress, Work work) {
    Sampling sampling(*this, name, progress);
    return work();
  }
  // Returns [{step, seconds, cpu_seconds, peak_mib}] in the order of the steps.
  nlohmann::json json() const;
  void print() const;
  double seconds() const;
  double peak_mib() const;
  double cpu_seconds() const;  // of this process, without its PostgreSQL

 private:
  struct Step {
    std::string name;
    double seconds = 0, cpu_seconds = 0, peak_mib = 0;
  };
  class Sampling {
   public:
    Sampling(StepWatch& watch, std::string name, Progress& progress);
    ~Sampling();

   private:
    std::atomic<bool> ended_{false};
    std::jthread thread_;
  };
  std::vector<Step> steps_;
};

// Returns the resident memory of this process in MiB, from /proc: the current size, and the maximum
// since `forget_peak_memory`.
double memory_mib();
double peak_memory_mib();
void forget_peak_memory();

}  // namespace strata::bench
