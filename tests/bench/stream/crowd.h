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

// The viewers of one case, on this thread, which also runs their links. Active viewers have
// different directions, close enough that each sees the strokes of all others.
class Crowd {
 public:
  // Returns when each viewer has a picture and no more messages come. Ends the bench if a viewer is
  // refused.
  Crowd(const CrowdCase& crowd, const Stage& stage, const ServerProcess& server);
  ~Crowd();

  // Runs the viewers' actions until each sees its own, for one second more, and then for `seconds`;
  // returns the figures of the latter (results/streaming-method.md explains them).
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
