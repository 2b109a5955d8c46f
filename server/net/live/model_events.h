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

// What happens to a model, for scripts: lines of the activity as they are made or go on, once they
// are durable. Each has the place in time that a reader who comes back names (Last-Event-ID); what
// was said near it may come twice.
class ModelEvents {
 public:
  // From `after` on, or from now.
  ModelEvents(const RouteContext& context, const Request& request, const Model& model,
              const std::optional<store::ActivityPlace>& after);

  // As `text/event-stream`, empty where nothing is new. Nothing: who listens may no longer. Asks
  // the database: on a worker.
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
  // up to where is known; nothing: nobody has asked yet
  std::optional<store::ActivityPlace> last_;
  std::map<std::int64_t, std::int64_t> told_us_;  // lines by id, as they were told: their time
  // that they are welcome
  std::chrono::steady_clock::time_point checked_ = std::chrono::steady_clock::now();
};

}  // namespace strata::net
