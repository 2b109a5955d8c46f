#include <set>

#include "core/compensated_sum.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/statistics_serialization.h"
#include "net/serialization/view_settings_serialization.h"
#include "net/transport/server_options.h"
#include "query/statistics/key_areas.h"
#include "room/caches/record_colors.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::net {
namespace {

// Returns the extent of the highlighted records, including their painted texels, lines and points.
// The page moves the camera there and shows the area of the records.
Result<Response> extent(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::Highlight>(request));
  auto room = open_room(context, request);
  if (!room) return tl::unexpected(room.error());
  auto layer = STRATA_TRY((*room)->layers().find(request.param("layer")));
  auto highlight = STRATA_TRY(highlight_of(body, layer, ""));
  auto keys =
      room::highlighted_keys(context.store, *layer.table, request.role(), highlight, "filter");
  if (!keys) return tl::unexpected(keys.error());
  auto areas = STRATA_TRY((*room)->queries().key_areas(layer.slug));
  const auto features =
      context.store.records().features(*layer.table, request.role(), (*room)->model().id);
  if (!features) return tl::unexpected(features.error());
  query::KeyArea all;
  CompensatedSum area_m2;
  bool is_somewhere = false;
  const auto add_bounds = [&](const glm::dvec3& low, const glm::dvec3& high) {
    all.bounds_min = is_somewhere ? glm::min(all.bounds_min, low) : low;
    all.bounds_max = is_somewhere ? glm::max(all.bounds_max, high) : high;
    is_somewhere = true;
  };
  std::size_t painted = 0;
  for (const std::uint32_t key : *keys) {
    const auto area = areas.find(key);
    if (area == areas.end()) continue;
    const query::KeyArea& one = area->second;
    add_bounds(one.bounds_min, one.bounds_max);
    all.texels += one.texels;
    area_m2 += one.area_m2;
    ++painted;
  }
  const std::set<std::int64_t> requested_keys(keys->begin(), keys->end());
  std::set<std::int64_t> marked;
  for (const auto& [key, feature, part] : *features) {
    if (!requested_keys.contains(key)) continue;
    marked.insert(key);
    for (const glm::dvec3& place : feature.places) add_bounds(place, place);
  }
  nlohmann::json json{{"records", keys->size()},
                      {"painted", painted},
                      {"marked", marked.size()},
                      {"texels", all.texels},
                      {"area_m2", area_m2.value()}};
  if (is_somewhere) json["bounds"] = bounds_json(all.bounds_min, all.bounds_max);
  return json_response(json);
}

}  // namespace

void add_extent_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/layers/{layer}/extent",
              .handler = answering(
                  [&context](const Request& request) { return extent(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
