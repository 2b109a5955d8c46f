// Figures, which are files with drawings to scale.
#include <boost/algorithm/string/predicate.hpp>

#include "app/figures/rollout_figure.h"
#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "net/api/models/figure_request.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/room.h"

namespace strata::net {
namespace {

// The memory for simultaneous drawings. An A3 drawing at 600 dpi needs 260 MB.
constexpr std::uint64_t kFigureBytes = 320u << 20;

// Preferences are separated by commas (RFC 7240).
bool wants_job(const Request& request) {
  for (std::string preference : split_list(std::string(request.header("prefer")))) {
    preference.erase(0, preference.find_first_not_of(" \t"));
    preference.erase(preference.find_last_not_of(" \t") + 1);
    if (boost::algorithm::iequals(preference, "respond-async")) return true;
  }
  return false;
}

Result<std::shared_ptr<const TemporaryFile>> draw_figure(const RouteContext& context,
                                                         ByteBudget& budget,
                                                         const app::FigureRequest& figure,
                                                         Progress& progress) {
  const auto& folder = context.options.upload_dir;
  return figure.rollout ? app::make_rollout_figure(context, budget, figure, folder, progress)
                        : app::make_figure(context.store, budget, figure, folder, progress);
}

Result<Response> answer(const RouteContext& context, const std::shared_ptr<ByteBudget>& budget,
                        const Request& request) {
  auto figure_request = read_figure_request(context, request);
  if (!figure_request) return tl::unexpected(figure_request.error());
  if (wants_job(request)) {
    const Model model = figure_request->room->model();
    auto job = context.jobs.add(
        model.project_id,
        [&context, budget, figure_request = std::move(*figure_request),
         id = model.id](Progress& progress) -> Result<jobs::JobResult> {
          auto file = STRATA_TRY(draw_figure(context, *budget, figure_request, progress));
          jobs::JobResult result(id);
          result.file = std::move(file);
          return result;
        },
        request.user(), jobs::JobKind::figure);
    if (!job) return tl::unexpected(job.error());
    return std::move(job_response(context, *job).with("Preference-Applied", "respond-async"));
  }
  Progress unwatched;
  auto file = STRATA_TRY(draw_figure(context, *budget, *figure_request, unwatched));
  Response response = file_response(std::move(file));
  add_sequences(response, *figure_request->shown.at,
                figure_request->room->edits().durable_sequence());
  return response;
}

}  // namespace

void add_figure_routes(Router& router, const RouteContext& context) {
  const auto budget = std::make_shared<ByteBudget>(kFigureBytes);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/figures",
              .handler = answering([&context, budget](const Request& request) {
                return answer(context, budget, request);
              }),
              .query = {"lang"},
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
