#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/stream/crowd_case.h"
#include "bench/stream/live_client.h"
#include "bench/stream/server_process.h"

namespace strata::bench {

using Viewers = std::vector<std::unique_ptr<LiveClient>>;

// What was counted until a moment.
struct CrowdMoment {
  double at_ms = 0;
  ServerProcess::Used server;
  double bench_s = 0;  // of processors, for viewers and links
  std::vector<LiveClient::Counts> active, idle;
  std::uint64_t bytes() const;  // of all messages
};

// The figures of a stretch of time, as README.md describes them: rates of what came within, times
// of what was sent within, whenever it came.
nlohmann::json crowd_figures(const CrowdCase& asked, const Viewers& active, const Viewers& idle,
                             const CrowdMoment& begin, const CrowdMoment& end);

}  // namespace strata::bench
