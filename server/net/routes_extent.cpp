#include "net/routes.h"
#include "net/wire.h"
#include "room/record_colors.h"

namespace strata::net {
namespace {

// Where the records lie that a person highlights: to fly there, and to tell how much surface they have.
Result<Response> extent(const RouteContext& context, const Request& request) {
  auto asked = body_of<protocol::Highlight>(request);
  if (!asked) return tl::unexpected(asked.error());
  auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return tl::unexpected(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return tl::unexpected(layer.error());
  auto highlight = highlight_of(*asked, *layer, "");
  if (!highlight) return tl::unexpected(highlight.error());
  auto keys = room::highlighted_keys(context.store, *layer->table, request.role(), *highlight, "filter");
  if (!keys) return tl::unexpected(keys.error());
  auto areas = (*room)->key_areas(layer->slug);
  if (!areas) return tl::unexpected(areas.error());
  query::KeyArea all;
  std::size_t painted = 0;
  for (const std::uint32_t key : *keys) {
    const auto area = areas->find(key);
    if (area == areas->end()) continue;
    const query::KeyArea& one = area->second;
    all.bounds_min = painted ? glm::min(all.bounds_min, one.bounds_min) : one.bounds_min;
    all.bounds_max = painted ? glm::max(all.bounds_max, one.bounds_max) : one.bounds_max;
    all.texels += one.texels;
    all.area_m2 += one.area_m2;
    ++painted;
  }
  nlohmann::json json{
      {"records", keys->size()}, {"painted", painted}, {"texels", all.texels}, {"area_m2", all.area_m2}};
  if (painted > 0) json["bounds"] = bounds_json(all.bounds_min, all.bounds_max);
  return json_response(json);
}

}  // namespace

void add_extent_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/layers/{layer}/extent",
              .handler = answering([&context](const Request& request) { return extent(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
}

}  // namespace strata::net
