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

// The events of a model, for scripts: lines of the activity that are made or extended, once they
// are durable. Each has a place in time, which a reconnecting reader names (Last-Event-ID); events
// near that time may be sent twice.
class ModelEvents {
 public:
  // Begins after `after`, or now.
  ModelEvents(const RouteContext& context, const Request& request, const Model& model,
              const std::optional<store::ActivityPlace>& after);

  // Returns the new events as `text/event-stream`; may be empty. Nothing: the reader has lost
  // access. Queries the database: call on a worker.
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
  // end of the known events; nothing: `next` was not called yet
  std::optional<store::ActivityPlace> last_;
  std::map<std::int64_t, std::int64_t> sent_us_;  // sent lines by id, with their time
  // time of the last check of access
  std::chrono::steady_clock::time_point checked_ = std::chrono::steady_clock::now();
};

}  // namespace strata::net
