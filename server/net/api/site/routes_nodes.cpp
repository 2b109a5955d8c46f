// The nodes of the site, for administrators.
#include <algorithm>
#include <chrono>

#include "app/nodes/node_lease.h"
#include "core/text/timestamp.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/page.h"
#include "net/transport/server_options.h"
#include "store/nodes/nodes.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr int kMaxModelsListed = 100;  // of each node

nlohmann::json node_json(const store::Node& node, const store::Ownership& ownership) {
  const double left_s = std::chrono::duration<double>(node.lease_until - ownership.now).count();
  nlohmann::json models = nlohmann::json::array();
  std::int64_t total = 0;
  if (const auto owned = ownership.by_node.find(node.id); owned != ownership.by_node.end()) {
    total = owned->second.total;
    for (const auto& [id, model] : owned->second.models)
      models.push_back({{"id", id}, {"name", model}});
  }
  const char* state = !node.lives ? "lost" : node.draining ? "draining" : "ready";
  return {{"id", to_string(node.id)},
          {"url", node.url},
          {"state", state},
          {"started", utc_text(node.started)},
          {"lease_s", std::max(0.0, left_s)},
          {"draining", node.draining},
          {"version", node.version},
          {"gpu", node.gpu},
          {"open_models", node.load.open_models},
          {"participants", node.load.participants},
          {"cores_used", node.load.processor_share},
          {"models", std::move(models)},
          {"models_total", total}};
}

Result<Response> list_nodes(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto nodes = STRATA_TRY(context.store.nodes().all());
  const auto ownership = STRATA_TRY(context.store.nodes().ownership(kMaxModelsListed));
  // The entries are sorted by the time of the start. Two nodes can start at the same time, so the
  // sort key also contains the id.
  const auto part = STRATA_TRY(slice_by(page, nodes, [](const store::Node& node) -> NumberKey {
    NumberKey key = {
        std::chrono::duration_cast<std::chrono::microseconds>(node.started.time_since_epoch())
            .count()};
    for (std::size_t i = 0; i < node.id.bytes.size(); i += 4) {
      std::int64_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) word = word << 8 | node.id.bytes[i + k];
      key.push_back(word);
    }
    return key;
  }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i)
    list.push_back(node_json(nodes[i], ownership));
  nlohmann::json body = {{"nodes", std::move(list)}, {"total", nodes.size()}};
  if (const app::NodeLease* lease = context.options.lease)
    body["this_node"] = to_string(lease->node().id);
  Response response = json_response(body);
  add_page_links(response, request, page, part.last);
  return response;
}

}  // namespace

void add_node_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/nodes",
              .handler = answering(
                  [&context](const Request& request) { return list_nodes(context, request); }),
              .role = Role::administrator,
              .query = {"limit", "offset", "after"}});
}

}  // namespace strata::net
