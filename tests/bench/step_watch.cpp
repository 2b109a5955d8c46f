#include "bench/step_watch.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "bench/processes.h"

namespace strata::bench {
namespace {

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
}

}  // namespace

double memory_mib() { return resident_mib(getpid()); }
double peak_memory_mib() { return peak_resident_mib(getpid()); }
void forget_peak_memory() { forget_peak(getpid()); }

StepWatch::Sampling::Sampling(StepWatch& watch, std::string name, Progress& progress) {
  const std::string before = progress.message();
  thread_ = std::jthread([this, &watch, &progress, name = std::move(name), before] {
    using Clock = std::chrono::steady_clock;
    std::string shown = before;
    auto start = Clock::now();
    double cpu_start = process_cpu_seconds();
    watch.steps_.push_back({name});
    forget_peak_memory();
    const auto finish_step = [&] {
      watch.steps_.back().seconds = std::chrono::duration<double>(Clock::now() - start).count();
      watch.steps_.back().cpu_seconds = process_cpu_seconds() - cpu_start;
      watch.steps_.back().peak_mib = peak_memory_mib();
    };
    while (!ended_) {
      if (const std::string now = progress.message(); now != shown) {
        finish_step();
        shown = now;
        start = Clock::now();
        cpu_start = process_cpu_seconds();
        watch.steps_.push_back({name + ": " + now});
        forget_peak_memory();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    finish_step();
  });
}

StepWatch::Sampling::~Sampling() {
  ended_ = true;
  thread_.join();
}

double StepWatch::peak_mib() const {
  double peak = 0;
  for (const Step& step : steps_) peak = std::max(peak, step.peak_mib);
  return peak;
}

double StepWatch::seconds() const {
  double sum = 0;
  for (const Step& step : steps_) sum += step.seconds;
  return sum;
}

double StepWatch::cpu_seconds() const {
  double sum = 0;
  for (const Step& step : steps_) sum += step.cpu_seconds;
  return sum;
}

void StepWatch::print() const {
  for (const Step& step : steps_)
    std::printf("  %-60s %7.2f s  %7.2f s of processor  %6.0f MiB\n", step.name.c_str(),
                step.seconds, step.cpu_seconds, step.peak_mib);
}

nlohmann::json StepWatch::json() const {
  nlohmann::json steps = nlohmann::json::array();
  for (const Step& step : steps_)
    steps.push_back({{"step", step.name},
                     {"seconds", step.seconds},
                     {"cpu_seconds", step.cpu_seconds},
                     {"peak_mib", step.peak_mib}});
  return steps;
}

}  // namespace strata::bench
