#pragma once

#include "app/layers/new_layers.h"
#include "jobs/job_queue.h"
#include "net/api/route_help.h"
#include "net/http/job_idempotency.h"
#include "room/room.h"

namespace strata::net {

// Creates and paints layers on the thread of the job. Returns the report of the job, or null for no
// report.
using MakeLayers =
    std::function<Result<nlohmann::json>(app::NewLayers& layers, Progress& progress)>;

// Returns 202 with a job that adds layers to the room. If the job fails or is canceled, it adds no
// layer. With an Idempotency-Key, a repeated call finds the job, even after a restart of the
// server.
Result<Response> start_layer_job(const RouteContext& context, JobIdempotency& book,
                                 const Request& request, const std::shared_ptr<room::Room>& room,
                                 MakeLayers make, jobs::JobKind kind = jobs::JobKind::layers);
// For `replay` of a route. Creates the response from the stored result of a job that succeeded.
Result<Response> repeat_layer_job(const RouteContext& context, JobIdempotency& book,
                                  const Request& request, const nlohmann::json& stored,
                                  jobs::JobKind kind = jobs::JobKind::layers);

}  // namespace strata::net
