#include "net/api/layers/layer_jobs.h"

#include "app/edits.h"
#include "domain/layers/layer.h"
#include "net/api/addressed.h"
#include "net/http/idempotency_store.h"
#include "room/room.h"
#include "store/content/idempotent_response.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<jobs::JobResult> run(room::Room& room, app::NewLayers& layers, const MakeLayers& make,
                            const std::string& key, const std::string& print, Progress& progress) {
  auto report = STRATA_TRY(make(layers, progress));
  if (progress.cancelled()) return cancelled_problem();
  jobs::JobResult result(room.model().id);
  result.layers = layers.ids();
  result.report = std::move(report);
  const store::IdempotentResponse<Layer> answer{key,
                                                [&](const Layer&) {
                                                  return nlohmann::json{{"request", print},
                                                                        {"model", result.model},
                                                                        {"layers", result.layers},
                                                                        {"report", result.report}};
                                                },
                                                {},
                                                progress.job()};
  STRATA_TRY(layers.show(answer));
  return result;
}

}  // namespace

Result<Response> start_layer_job(const RouteContext& context, JobIdempotency& book,
                                 const Request& request, const std::shared_ptr<room::Room>& room,
                                 MakeLayers make, jobs::JobKind kind) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  auto job = context.jobs.add(
      room->model().project_id,
      [&edits = context.edits, room, make = std::move(make), author = request.author(),
       key = scoped_key(request),
       print = fingerprint(request)](Progress& progress) -> Result<jobs::JobResult> {
        app::NewLayers layers(room, edits, author);
        auto done = run(*room, layers, make, key, print, progress);
        if (!done) layers.take_back();
        return done;
      },
      {}, kind);
  if (!job) return tl::unexpected(job.error());
  book.started(request, *job);
  return job_response(context, *job);
}

Result<Response> repeat_layer_job(const RouteContext& context, JobIdempotency& book,
                                  const Request& request, const nlohmann::json& stored,
                                  jobs::JobKind kind) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return job_response(context, *known);
  jobs::JobResult result(stored.at("model").get<ModelId>());
  result.layers = stored.at("layers").get<std::vector<LayerId>>();
  result.report = stored.at("report");
  const auto model = STRATA_TRY(stored_model(context, request));
  auto job = STRATA_TRY(book.finished(request, model.project_id, std::move(result), kind));
  return job_response(context, job);
}

}  // namespace strata::net
