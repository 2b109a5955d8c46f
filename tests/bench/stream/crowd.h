#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "bench/stream/crowd_figures.h"
#include "bench/stream/hands.h"
#include "bench/stream/link.h"

namespace strata::bench {

// The viewers of one case. They run on this thread, as do their links. Active viewers have
// different directions, near enough to each other that each one sees the strokes of all others.
class Crowd {
 public:
  // Returns when each viewer has a frame and no more messages arrive. Ends the bench if the server
  // refuses a viewer.
  Crowd(const CrowdCase& crowd, const Stage& stage, const ServerProcess& server);
  ~Crowd();

  // Runs the actions until each viewer sees the effect of its actions, then for one second, and
  // then for `seconds`. Returns the figures of the last period (results/streaming-method.md).
  nlohmann::json measure(double seconds);

 private:
  LiveClient& add(Viewers& to);
  void open(std::vector<std::pair<LiveClient*, Camera>> clients);
  void settle(double quiet_s);
  void run_for(double seconds);
  void run_until(const std::function<bool()>& condition, double limit_s);
  void start_hands();
  bool all_see_what_they_do() const;
  bool has_painted_since(double begin_ms) const;
  void finish_strokes();
  void check_nobody_is_lost() const;
  CrowdMoment now() const;

  const CrowdCase case_;
  const Stage stage_;
  const ServerProcess& server_;
  boost::asio::io_context context_{1};
  std::optional<Link> link_;
  Viewers active_, idle_, stalled_;
  bool stop_ = false;
};

}  // namespace strata::bench
