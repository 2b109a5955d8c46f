#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/route_help.h"
#include "store/people/activity.h"

namespace strata::net {

// The events of a model, for scripts. An event is a durable line of the activity that is new or
// extended. Each event has a position in time, and a reconnecting client sends its last position
// (Last-Event-ID). Events near that time may be sent twice.
class ModelEvents {
 public:
  // Starts after `after` or, if it is empty, at the current time.
  ModelEvents(const RouteContext& context, const Request& request, const Model& model,
              const std::optional<store::ActivityPlace>& after);

  // Returns the new events as `text/event-stream`. The text may be empty. Returns nothing if the
  // reader has lost access. Queries the database, so call it on a worker.
  std::optional<std::string> next();

 private:
  using Lines = std::vector<store::Activity>;
  bool is_still_welcome();
  std::optional<Lines> lines_since(std::int64_t time_us);
  void remember(const Lines& lines);
  std::string tell(const Lines& lines);

  const RouteContext& context_;
  const std::string secret_;
  const Role role_;
  const ProjectId project_;
  const ModelId model_;
  // Position after the last known event. Empty until the first call to `next`.
  std::optional<store::ActivityPlace> last_;
  std::map<std::int64_t, std::int64_t> sent_us_;  // time of each sent line, by id
  // The time of the last check of access.
  std::chrono::steady_clock::time_point checked_ = std::chrono::steady_clock::now();
};

}  // namespace strata::net
