#pragma once

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/progress.h"

namespace strata::bench {

// Measures seconds, processor seconds and peak memory of the steps of long work. Its progress
// messages separate the steps; a thread samples them once a millisecond.
class StepWatch {
 public:
  // Runs `work`, and records each message that `progress` shows as a step; `name` is the step
  // before the first message.
  template <class Work>
  auto run(const std::string& name, Progress& progress, Work work) {
    Sampling sampling(*this, name, progress);
    return work();
  }
  // [{step, seconds, cpu_seconds, peak_mib}] in the order they began.
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

// Resident memory of this process now, and the maximum since `forget_peak_memory`, in MiB; from
// /proc.
double memory_mib();
double peak_memory_mib();
void forget_peak_memory();

}  // namespace strata::bench
