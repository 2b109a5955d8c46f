#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/stream/crowd_case.h"
#include "bench/stream/live_client.h"
#include "bench/stream/server_process.h"

namespace strata::bench {

using Viewers = std::vector<std::unique_ptr<LiveClient>>;

// The counters at one moment.
struct CrowdMoment {
  double at_ms = 0;
  ServerProcess::Used server;
  double bench_s = 0;  // processor seconds for viewers and links
  std::vector<LiveClient::Counts> active, idle;
  std::uint64_t bytes() const;  // of all messages
};

// Returns the figures of a period, as results/streaming-method.md describes them. Rates count the
// frames that arrived within the period. Times are measured for the messages that were sent within
// the period, even if the reply arrived later.
nlohmann::json crowd_figures(const CrowdCase& crowd, const Viewers& active, const Viewers& idle,
                             const CrowdMoment& begin, const CrowdMoment& end);

}  // namespace strata::bench
