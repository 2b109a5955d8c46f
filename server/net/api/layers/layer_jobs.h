#pragma once

#include "app/layers/new_layers.h"
#include "net/api/route_help.h"
#include "net/http/job_idempotency.h"
#include "room/room.h"

namespace strata::net {

// Makes and paints layers; returns the job's report (null: none). On the job's thread.
using MakeLayers =
    std::function<Result<nlohmann::json>(app::NewLayers& layers, Progress& progress)>;

// Answers 202 with a job that makes layers of the room: all of them, or no layer if the job fails
// or is canceled. With an Idempotency-Key a repeat finds the job, also after a restart of the
// server.
Result<Response> start_layer_job(const RouteContext& context, JobIdempotency& book,
                                 const Request& request, const std::shared_ptr<room::Room>& room,
                                 MakeLayers make);
// For a route's `replay`: answers from the stored result of a job that succeeded.
Result<Response> repeat_layer_job(const RouteContext& context, JobIdempotency& book,
                                  const Request& request, const nlohmann::json& stored);

}  // namespace strata::net
