// The features of collections (OGC API Features, parts 1 and 2).
#include <algorithm>
#include <limits>

#include "app/layers/layer_features.h"
#include "core/no_such.h"
#include "core/text/bytes.h"
#include "core/text/percent.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/ogc/ogc_request.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/entity_tags.h"
#include "net/http/origin.h"
#include "net/serialization/as_of.h"
#include "net/serialization/feature_json.h"
#include "net/transport/server_options.h"
#include "query/maps/flat_area.h"
#include "room/layers.h"
#include "room/room.h"

namespace strata::net {
namespace {

constexpr std::int64_t kUsualItems = 1000, kMostItems = 10'000;
constexpr int kDecimalsOfDegrees = 9;  // a tenth of a millimeter on the ground

// The features of a collection and the plane of their coordinates.
struct Items {
  app::FeatureTable table;  // coordinates: world coordinates in the plane
  app::GisPlane plane;
  Model model;
};

Result<Items> items_of(const RouteContext& context, const Request& request) {
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  const auto at = STRATA_TRY(find_sequence(context, *room, STRATA_TRY(datetime_of(request))));
  auto plane = STRATA_TRY(plane_of(request, room->model()));
  const auto column = request.params.find("column");
  const bool is_column = column != request.params.end();
  auto set = STRATA_TRY(app::layer_features(
      context.store,
      {room, layer, at, plane.outline(), request.role(), {}, !is_column, is_column}));
  for (app::FeatureTable& table : set.tables)
    if (!is_column || table.name == "lines_" + column->second ||
        table.name == "points_" + column->second)
      return Items{std::move(table), std::move(plane), room->model()};
  return no_such("column", column->second);
}

// Returns the geometry in a system, and no geometry if the system cannot express a part of it.
std::vector<query::FlatPolygon> in_system(const std::vector<query::FlatPolygon>& geometry,
                                          const app::GisPlane& plane, app::GisSystem system) {
  std::vector<query::FlatPolygon> converted = geometry;
  for (query::FlatPolygon& polygon : converted)
    for (query::FlatRing& ring : polygon.rings)
      for (glm::dvec3& corner : ring) {
        const auto place = plane.write({corner.x, corner.y}, system);
        if (!place) return {};
        corner = {*place, 0};
      }
  return converted;
}

// Returns whether a segment has a point in the box (Liang and Barsky 1984).
bool crosses(const glm::dvec2& from, const glm::dvec2& to, const GisBox& box) {
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = to[axis] - from[axis];
    if (step == 0) {
      if (from[axis] < box.low[axis] || from[axis] > box.high[axis]) return false;
      continue;
    }
    const double one = (box.low[axis] - from[axis]) / step,
                 other = (box.high[axis] - from[axis]) / step;
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  return begin <= end;
}

// Returns whether a polygon that no side of crosses the box contains the box.
bool contains_box(const query::FlatPolygon& polygon, const GisBox& box) {
  std::vector<std::vector<glm::dvec2>> rings;
  for (const query::FlatRing& ring : polygon.rings) {
    rings.emplace_back();
    for (const glm::dvec3& corner : ring) rings.back().emplace_back(corner);
  }
  return PolygonArea(rings).contains((box.low + box.high) / 2.0);
}

bool intersects(const std::vector<query::FlatPolygon>& geometry, app::FeatureKind kind,
                const GisBox& box) {
  for (const query::FlatPolygon& polygon : geometry) {
    for (const query::FlatRing& ring : polygon.rings) {
      const std::size_t sides =
          kind == app::FeatureKind::areas ? ring.size() : std::max<std::size_t>(ring.size(), 2) - 1;
      for (std::size_t i = 0; i < sides; ++i)
        if (crosses(glm::dvec2(ring[i]), glm::dvec2(ring[(i + 1) % ring.size()]), box)) return true;
    }
    if (kind == app::FeatureKind::areas && contains_box(polygon, box)) return true;
  }
  return false;
}

Result<std::int64_t> count_of(const Request& request, const std::string& name, std::int64_t least,
                              std::int64_t usual) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return usual;
  const auto count =
      parse_integer(found->second, least, std::numeric_limits<std::int32_t>::max(), name);
  if (!count) return tl::unexpected(as_malformed(count.error()));
  return *count;
}

std::string id_member(const app::Feature& feature) {
  return "\"id\":" + nlohmann::json(feature.id).dump() + ",";
}

CoordinateForm form_of(app::GisSystem system) {
  return {2, system == app::GisSystem::degrees ? kDecimalsOfDegrees : CoordinateForm().decimals};
}

// Returns the address of another page with the parameters of this request.
std::string page_address(const RouteContext& context, const Request& request, std::int64_t offset) {
  std::string query;
  for (const auto& [name, value] : request.query)
    if (name != "offset") query += (query.empty() ? "?" : "&") + name + "=" + percent_encode(value);
  if (offset > 0) query += (query.empty() ? "?" : "&") + ("offset=" + std::to_string(offset));
  return own_origin(request, context.options.allowed_origins) + request.path + query;
}

nlohmann::json collection_link(const RouteContext& context, const Request& request) {
  return ogc_link(with_query(ogc_base(context, request) + "/collections/" + request.segments.at(2),
                             along_query(request)),
                  "collection", "application/json", "The collection");
}

Response geojson(std::string text, const app::GisPlane& plane, const Model& model,
                 const std::string& base, app::GisSystem system) {
  Response response = text_response(std::move(text), kGeoJsonType);
  response.with(
      "Content-Crs",
      "<" + (system == app::GisSystem::degrees ? std::string(kCrs84) : uri_of(plane, model, base)) +
          ">");
  return response;
}

Result<Response> items(const RouteContext& context, const Request& request) {
  STRATA_TRY(check_format(request, {"json", "geojson"}));
  const auto box = STRATA_TRY(bbox_of(request));
  const auto limit = std::min(STRATA_TRY(count_of(request, "limit", 1, kUsualItems)), kMostItems);
  const auto offset = STRATA_TRY(count_of(request, "offset", 0, 0));
  auto [table, plane, model] = STRATA_TRY(items_of(context, request));
  const std::string base = ogc_base(context, request);
  const auto system = STRATA_TRY(system_of(request, "crs", plane, model, base));
  const auto of_box = STRATA_TRY(system_of(request, "bbox-crs", plane, model, base));
  if (box)
    std::erase_if(table.features, [&](const app::Feature& feature) {
      check_question();
      return !intersects(in_system(feature.geometry, plane, of_box), table.kind, *box);
    });
  const auto matched = static_cast<std::int64_t>(table.features.size());
  const std::int64_t end = std::min(matched, offset + limit);
  nlohmann::json links{
      ogc_link(page_address(context, request, offset), "self", kGeoJsonType, "This page"),
      collection_link(context, request)};
  if (end < matched)
    links.push_back(
        ogc_link(page_address(context, request, end), "next", kGeoJsonType, "The next page"));
  if (offset > 0)
    links.push_back(
        ogc_link(page_address(context, request, std::max(offset - limit, std::int64_t{0})), "prev",
                 kGeoJsonType, "The previous page"));
  nlohmann::json head{{"type", "FeatureCollection"},
                      {"numberMatched", matched},
                      {"numberReturned", std::max(end - offset, std::int64_t{0})},
                      {"links", std::move(links)}};
  std::string text = head.dump();
  text.back() = ',';
  text += R"("features":[)";
  for (std::int64_t i = offset; i < end; ++i) {
    check_question();
    app::Feature& feature = table.features[static_cast<std::size_t>(i)];
    feature.geometry = in_system(feature.geometry, plane, system);
    text += i == offset ? "\n" : ",\n";
    append_feature(text, table, feature, form_of(system), id_member(feature));
  }
  text += "\n]}\n";
  Response response = geojson(std::move(text), plane, model, base, system);
  // The first page counts as an export in the audit log.
  if (offset == 0) name_download(response, request.segments.at(2) + ".geojson");
  return response;
}

Result<Response> item(const RouteContext& context, const Request& request) {
  STRATA_TRY(check_format(request, {"json", "geojson"}));
  auto [table, plane, model] = STRATA_TRY(items_of(context, request));
  const std::string base = ogc_base(context, request);
  const auto system = STRATA_TRY(system_of(request, "crs", plane, model, base));
  const auto found = std::ranges::find(table.features, request.param("feature"), &app::Feature::id);
  if (found == table.features.end()) return no_such("feature", request.param("feature"));
  found->geometry = in_system(found->geometry, plane, system);
  const nlohmann::json links{
      ogc_link(page_address(context, request, 0), "self", kGeoJsonType, "This feature"),
      collection_link(context, request)};
  std::string text;
  append_feature(text, table, *found, form_of(system),
                 id_member(*found) + "\"links\":" + links.dump() + ",");
  return geojson(std::move(text), plane, model, base, system);
}

}  // namespace

void add_ogc_item_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](const std::string& pattern, Answer answer, std::vector<std::string> query) {
    router.add({.method = Method::get,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .query = std::move(query),
                .is_question = true,
                .state = state_of_model(context)});
  };
  for (const char* id : {"{model}.{layer}.{column}", "{model}.{layer}"}) {
    const std::string pattern = std::string("/ogc/collections/") + id + "/items";
    add(pattern, items, {"f", "bbox", "bbox-crs", "crs", "datetime", "limit", "offset", "along"});
    add(pattern + "/{feature}", item, {"f", "crs", "datetime", "along"});
  }
}

}  // namespace strata::net
