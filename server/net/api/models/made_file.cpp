#include "net/api/models/made_file.h"

#include <boost/algorithm/string/predicate.hpp>

#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "room/edits.h"
#include "room/room.h"

namespace strata::net {
namespace {

// Preferences are separated by commas (RFC 7240).
bool wants_job(const Request& request) {
  for (std::string preference : split_list(std::string(request.header("prefer")))) {
    preference.erase(0, preference.find_first_not_of(" \t"));
    preference.erase(preference.find_last_not_of(" \t") + 1);
    if (boost::algorithm::iequals(preference, "respond-async")) return true;
  }
  return false;
}

}  // namespace

Result<Response> respond_with_file(const RouteContext& context, const Request& request,
                                   const room::Room& room, std::int64_t sequence, MakeFile make) {
  if (wants_job(request)) {
    const Model model = room.model();
    auto job = context.jobs.add(
        model.project_id,
        [make = std::move(make), id = model.id](Progress& progress) -> Result<jobs::JobResult> {
          auto file = STRATA_TRY(make(progress));
          jobs::JobResult result(id);
          result.file = std::move(file);
          return result;
        },
        request.user(), jobs::JobKind::figure);
    if (!job) return tl::unexpected(job.error());
    return std::move(job_response(context, *job).with("Preference-Applied", "respond-async"));
  }
  Progress unwatched;
  auto file = STRATA_TRY(make(unwatched));
  Response response = file_response(std::move(file));
  add_sequences(response, sequence, room.edits().durable_sequence());
  return response;
}

}  // namespace strata::net
