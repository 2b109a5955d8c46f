// Analyses: several computed layers and statistics, as one job.
#include <chrono>
#include <utility>

#include "app/layers/analysis.h"
#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "net/api/addressed.h"
#include "net/api/layers/create_computed.h"
#include "net/api/layers/layer_jobs.h"
#include "net/api/layers/new_layer.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/job_idempotency.h"
#include "net/serialization/statistics_serialization.h"
#include "net/transport/server_options.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<app::AnalysisStep> compute_step(const RouteContext& context, const Request& request,
                                       const room::Room& room, const protocol::LayerCreate& body,
                                       const app::Analysis& before) {
  if (!body.compute && !body.expression)
    return fail(ErrorCode::invalid, "Layer without computation",
                "Layers of an analysis are computed. Send `expression` or `compute`.");
  app::AnalysisStep::Compute step;
  step.layer = STRATA_TRY(new_layer(body, room.model(), app::layers_after(room, before)));
  step.expression = body.expression.value_or("");
  step.automatic = is_automatic(body.recompute);
  step.has_palette = body.palette.has_value();
  if (body.compute)
    step.recipe = STRATA_TRY(checked_recipe(context, request, room.model(), *body.compute));
  return app::AnalysisStep{std::move(step)};
}

app::AnalysisStep measure_step(const protocol::AnalysisStatistics& body) {
  return {app::AnalysisStep::Measure{protocol::to_ref(body.layer), body.where,
                                     statistics_options(body.include)}};
}

Result<app::Analysis> analysis_of(const RouteContext& context, const Request& request,
                                  const room::Room& room, const protocol::Analysis& body) {
  app::Analysis analysis{body.name};
  bool makes_layer = false;
  for (std::size_t i = 0; i < body.steps.size(); ++i) {
    const protocol::AnalysisStep& part = body.steps[i];
    makes_layer = makes_layer || part.layer;
    auto step = part.layer ? compute_step(context, request, room, *part.layer, analysis)
                           : measure_step(*part.statistics);
    const Result<void> added =
        step ? app::add_step(context, room, request.role(), analysis, std::move(*step))
             : tl::unexpected(step.error());
    if (!added) return app::at_step(added.error(), i, part.layer ? "layer" : "statistics");
  }
  if (!makes_layer)
    return fail(ErrorCode::invalid, "No layer",
                "At least one step must compute a layer. To read only statistics, use "
                "GET …/statistics or POST …/select.",
                "steps");
  return analysis;
}

nlohmann::json result_json(const app::AnalysisStep& step, const app::AnalysisResult& result) {
  nlohmann::json json{
      {"layer", result.layer.id}, {"slug", result.layer.slug}, {"inputs", nlohmann::json::array()}};
  for (const Layer& input : result.inputs)
    json["inputs"].push_back({{"layer", input.id}, {"slug", input.slug}});
  if (result.sequence) json["sequence"] = *result.sequence;
  if (const auto* compute = std::get_if<app::AnalysisStep::Compute>(&step.work)) {
    if (compute->recipe)
      json["recipe"] = jobs::to_json(*compute->recipe);
    else
      json["expression"] = compute->expression;
  } else if (const auto& where = std::get<app::AnalysisStep::Measure>(step.work).where) {
    json["where"] = *where;
  }
  if (result.statistics) json["statistics"] = to_json(*result.statistics);
  return json;
}

Result<nlohmann::json> run(const RouteContext& context, const std::shared_ptr<room::Room>& room,
                           const app::Analysis& analysis, const Author& author,
                           app::NewLayers& layers, Progress& progress) {
  nlohmann::json report{{"name", analysis.name},
                        {"user", author.user},
                        {"time", utc_text(std::chrono::system_clock::now())},
                        {"steps", nlohmann::json::array()}};
  const auto results =
      STRATA_TRY(app::run_analysis(context, room, analysis, author, layers, progress));
  for (std::size_t i = 0; i < results.size(); ++i)
    report["steps"].push_back(result_json(analysis.steps[i], results[i]));
  return report;
}

Result<Response> start_analysis(const RouteContext& context, JobIdempotency& book,
                                const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::Analysis>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  // A repeated call gets its job, although the model now has the layers.
  const auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  auto analysis = STRATA_TRY(analysis_of(context, request, *room, body));
  return start_layer_job(
      context, book, request, room,
      [&context, room, analysis = std::move(analysis), author = request.author()](
          app::NewLayers& layers, Progress& progress) {
        return run(context, room, analysis, author, layers, progress);
      },
      jobs::JobKind::analysis);
}

}  // namespace

void add_analysis_routes(Router& router, const RouteContext& context) {
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/analysis",
              .handler = answering([&context, book](const Request& request) {
                return start_analysis(context, *book, request);
              }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .replay = [&context, book](const Request& request, const nlohmann::json& stored) {
                return repeat_layer_job(context, *book, request, stored, jobs::JobKind::analysis);
              }});
}

}  // namespace strata::net
