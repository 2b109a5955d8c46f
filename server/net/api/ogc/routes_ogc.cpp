// The landing page, the conformance classes and the collections of the OGC APIs.
#include <map>

#include "core/no_such.h"

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "net/api/ogc/ogc_collections.h"
#include "net/api/ogc/ogc_request.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/entity_tags.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

// The server has no class for OpenAPI 3.0, because its description is OpenAPI 3.1.
constexpr const char* kClasses[] = {
    "http://www.opengis.net/spec/ogcapi-common-1/1.0/conf/core",
    "http://www.opengis.net/spec/ogcapi-common-1/1.0/conf/landing-page",
    "http://www.opengis.net/spec/ogcapi-common-1/1.0/conf/html",
    "http://www.opengis.net/spec/ogcapi-common-1/1.0/conf/json",
    "http://www.opengis.net/spec/ogcapi-common-2/1.0/conf/collections",
    "http://www.opengis.net/spec/ogcapi-common-2/1.0/conf/html",
    "http://www.opengis.net/spec/ogcapi-common-2/1.0/conf/json",
    "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/core",
    "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/geojson",
    "http://www.opengis.net/spec/ogcapi-features-2/1.0/conf/crs",
    "http://www.opengis.net/spec/ogcapi-coverages-1/1.0/conf/core",
    "http://www.opengis.net/spec/ogcapi-coverages-1/1.0/conf/subsetting",
    "http://www.opengis.net/spec/ogcapi-coverages-1/1.0/conf/scaling",
    "http://www.opengis.net/spec/ogcapi-coverages-1/1.0/conf/geotiff",
    "http://www.opengis.net/spec/ogcapi-coverages-1/1.0/conf/coveragejson",
    "http://www.opengis.net/spec/ogcapi-edr-1/1.1/conf/core",
    "http://www.opengis.net/spec/ogcapi-edr-1/1.1/conf/collections",
    "http://www.opengis.net/spec/ogcapi-edr-1/1.1/conf/covjson",
    "http://www.opengis.net/spec/ogcapi-edr-1/1.1/conf/json"};

OgcPlace place_of(const RouteContext& context, const Request& request) {
  return {ogc_base(context, request), along_query(request)};
}

Result<Response> landing(const RouteContext& context, const Request& request) {
  const std::string base = ogc_base(context, request);
  nlohmann::json json{
      {"title", "Strata for GIS programs"},
      {"description",
       "The layers of all models as features, coverages and values at places (OGC API Features, "
       "Coverages and Environmental Data Retrieval). Sign in, or send a token as Authorization: "
       "Bearer TOKEN."}};
  const std::string site = base.substr(0, base.size() - std::string_view("/ogc").size());
  json["links"] = {
      ogc_link(with_query(base + "/collections", along_query(request)), "data", "application/json",
               "The collections"),
      ogc_link(base + "/conformance", "conformance", "application/json",
               "The parts of the standards that the server implements"),
      ogc_link(site + "/api/v1/openapi.json", "service-desc",
               "application/vnd.oai.openapi+json;version=3.1", "The definition of the API"),
      ogc_link(site + "/docs", "service-doc", "text/html", "The documentation of the API")};
  return ogc_document(context, request, std::move(json));
}

Result<Response> conformance(const RouteContext& context, const Request& request) {
  return ogc_document(
      context, request,
      {{"title", "Conformance"},
       {"description", "The parts of the OGC standards that the server implements."},
       {"conformsTo", kClasses}});
}

// Reads each table once for a list of collections.
class Tables {
 public:
  Tables(const RouteContext& context, Role role) : context_(context), role_(role) {}

  // Returns the columns with lines or points of the table of a layer.
  Result<std::vector<Column>> columns_of(const Layer& layer) {
    if (!layer.table) return std::vector<Column>();
    if (const auto found = known_.find(*layer.table); found != known_.end()) return found->second;
    const auto table = STRATA_TRY(context_.store.tables().find(to_string(*layer.table), role_));
    std::vector<Column>& columns = known_[*layer.table];
    for (const Column& column : table.columns)
      if (holds_features(column.kind)) columns.push_back(column);
    return columns;
  }

 private:
  const RouteContext& context_;
  const Role role_;
  std::map<TableId, std::vector<Column>> known_;
};

Result<void> add_collections(const RouteContext& context, const OgcPlace& place, const Model& model,
                             const app::GisPlane& plane, Role role, nlohmann::json& list) {
  const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, role));
  list.push_back(model_collection(place, model, layers, plane));
  Tables tables(context, role);
  for (const Layer& layer : layers) {
    list.push_back(layer_collection(place, model, layer, plane));
    const auto columns = STRATA_TRY(tables.columns_of(layer));
    for (const Column& column : columns)
      list.push_back(column_collection(place, model, layer, column, plane));
  }
  return {};
}

Result<Response> collections(const RouteContext& context, const Request& request) {
  const auto place = place_of(context, request);
  const auto models = STRATA_TRY(context.store.models().all());
  nlohmann::json list = nlohmann::json::array();
  for (const Model& model : models) {
    if (!request.principal->sees(model.project_id)) continue;
    const auto plane = STRATA_TRY(plane_of(request, model));
    const std::size_t before = list.size();
    const auto added = add_collections(context, place, model, plane,
                                       request.principal->roles.in(model.project_id), list);
    if (added) continue;
    if (added.error().code != ErrorCode::not_found) return tl::unexpected(added.error());
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(before),
               list.end());  // deleted since the models were read
  }
  return ogc_document(context, request,
                      {{"title", "Collections"},
                       {"description",
                        "A collection for each model, for each of its layers, and for each column "
                        "of lines or points."},
                       {"collections", std::move(list)}});
}

Result<Response> collection(const RouteContext& context, const Request& request) {
  const auto place = place_of(context, request);
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto plane = STRATA_TRY(plane_of(request, model));
  if (!request.params.contains("layer")) {
    const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
    return ogc_document(context, request, model_collection(place, model, layers, plane));
  }
  const auto layer = STRATA_TRY(stored_layer(context, request));
  if (!request.params.contains("column"))
    return ogc_document(context, request, layer_collection(place, model, layer, plane));
  const auto columns = STRATA_TRY(Tables(context, request.role()).columns_of(layer));
  for (const Column& column : columns)
    if (column.slug == request.param("column"))
      return ogc_document(context, request, column_collection(place, model, layer, column, plane));
  return no_such("column", request.param("column"));
}

// The JSON Schema of the values of a coverage (OGC 23-058).
Result<Response> schema(const RouteContext& context, const Request& request) {
  const auto layer = STRATA_TRY(stored_layer(context, request));
  nlohmann::json value{{"title", layer.name},
                       {"type", is_float(layer.type) ? "number" : "integer"},
                       {"x-ogc-propertySeq", 1}};
  if (!layer.description.empty()) value["description"] = layer.description;
  if (!layer.unit.empty()) value["x-ogc-unit"] = layer.unit;
  Response response = json_response(
      {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
       {"$id", ogc_base(context, request) + "/collections/" + request.segments.at(2) + "/schema"},
       {"title", layer.name},
       {"type", "object"},
       {"properties", {{layer.slug, std::move(value)}}}});
  response.headers = {{"Content-Type", "application/schema+json"}};
  return response;
}

Result<Response> local_system(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const std::string& name = request.param("plane");
  for (const char* along : {"-x", "+y", "-z"}) {
    const app::GisPlane plane(model, app::parse_map_axis(along).value());
    if (plane.name() == name)
      return text_response(plane.wkt(model.name), "text/plain; charset=utf-8");
  }
  return fail(ErrorCode::not_found, "Unknown plane", "The planes are xy, xz and yz.", "plane");
}

}  // namespace

void add_ogc_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](const std::string& pattern, Answer answer, std::vector<std::string> query,
                       Role least = Role::viewer) {
    router.add({.method = Method::get,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = least,
                .query = std::move(query)});
  };
  // A client that begins with a direction sends it with each request. A guest may be a member of
  // some projects, and sees only their collections.
  add("/ogc", landing, {"f", "along"}, Role::guest);
  add("/ogc/conformance", conformance, {"f", "along"}, Role::guest);
  add("/ogc/collections", collections, {"f", "along"}, Role::guest);
  // The longer patterns are first, because the id of a collection matches the shorter ones, too.
  for (const char* id : {"{model}.{layer}.{column}", "{model}.{layer}", "{model}"})
    add(std::string("/ogc/collections/") + id, collection, {"f", "along"});
  add("/ogc/collections/{model}.{layer}/schema", schema, {});
  add("/ogc/crs/{model}/{plane}", local_system, {});
}

}  // namespace strata::net
