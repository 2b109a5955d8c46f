#include <fstream>
#include <sstream>

#include "app/nodes/node_lease.h"
#include "core/version.h"
#include "net/api/metrics.h"
#include "net/api/problems_page.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/question_desk.h"
#include "net/http/worker_pool.h"
#include "net/transport/server_options.h"
#include "render/renderer.h"
#include "room/rooms.h"
#include "store/store.h"

namespace strata::net {
namespace {

Response readiness(const RouteContext& context) {
  nlohmann::json reasons = nlohmann::json::array();
  if (!context.store.ready()) reasons.push_back("The database does not answer.");
  if (!context.renderer.ready())
    reasons.push_back("The server lost the graphics context and cannot restore it yet.");
  if (const app::NodeLease* lease = context.options.lease) {
    if (lease->draining()) reasons.push_back("The node is stopping.");
    if (!lease->holds())
      reasons.push_back("The node has no lease, because it cannot renew it in the database.");
  }
  const bool ready = reasons.empty();
  return json_response({{"ready", ready}, {"reasons", reasons}}, ready ? 200 : 503);
}

std::optional<NodeGauges> node_gauges(const RouteContext& context) {
  if (!context.options.lease) return std::nullopt;
  return NodeGauges{
      std::chrono::duration<double>(context.options.lease->left()).count(),
      context.rooms.models_moved(),
  };
}

// Adds a tag with a hash of the response's bytes. Returns 304 to a client that already has them.
Response revalidated(Response response, const Request& request) {
  const auto tag = tag_of_body(response).value_or("");
  response.with("ETag", tag).with("Cache-Control", "no-cache");
  return names_tag(request.header("if-none-match"), tag) ? not_modified(response)
                                                         : std::move(response);
}

Result<Response> contract(const RouteContext& context, const Request& request) {
  std::ifstream file(context.options.protocol_dir / "openapi.json", std::ios::binary);
  if (!file)
    return fail(ErrorCode::unavailable, "API description missing",
                "This installation does not contain openapi.json.");
  std::ostringstream text;
  text << file.rdbuf();
  return revalidated(text_response(std::move(text).str(), "application/json"), request);
}

}  // namespace

void add_system_routes(Router& router, const RouteContext& context) {
  auto open = [&](std::string pattern, std::function<Result<Response>(const Request&)> answer) {
    router.add({.method = Method::get,
                .pattern = std::move(pattern),
                .handler = answering(std::move(answer)),
                .role = std::nullopt});
  };
  open("/livez", [](const Request&) -> Result<Response> {
    return text_response("ok\n", "text/plain; charset=utf-8");
  });
  open("/readyz", [&context](const Request&) -> Result<Response> { return readiness(context); });
  open("/api/v1/version", [](const Request& request) -> Result<Response> {
    return revalidated(json_response({{"version", version()}}), request);
  });
  open("/metrics", [&context](const Request&) -> Result<Response> {
    return text_response(
        metrics_text(context.metrics,
                     {context.rooms.open_rooms(), context.renderer.gpu_bytes_used(),
                      context.rooms.memory_bytes_used(), context.workers.waiting(),
                      context.questions.waiting(), context.questions.under_way(),
                      context.questions.steps(), node_gauges(context)}),
        "text/plain; version=0.0.4; charset=utf-8");
  });
  open("/api/v1/openapi.json",
       [&context](const Request& request) { return contract(context, request); });
  open("/problems", [](const Request&) -> Result<Response> {
    return text_response(problems_html(), "text/html; charset=utf-8");
  });
}

}  // namespace strata::net
