#include "net/api/ogc/ogc_collections.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "net/api/ogc/ogc_request.h"
#include "net/serialization/feature_json.h"

namespace strata::net {
namespace {

constexpr std::string_view kRelations = "http://www.opengis.net/def/rel/ogc/1.0/";

nlohmann::json box_list(const std::optional<app::GisPlane::Box>& box) {
  nlohmann::json boxes = nlohmann::json::array();
  if (box) boxes.push_back({box->low.x, box->low.y, box->high.x, box->high.y});
  return boxes;
}

nlohmann::json extent_of(const Model& model, const app::GisPlane& plane, const std::string& base) {
  const auto box = plane.write_box(bounds_of(model, plane), plane.usual_system());
  return {{"spatial", {{"bbox", box_list(box)}, {"crs", systems_of(plane, model, base).front()}}}};
}

nlohmann::json collection(const OgcPlace& place, const std::string& id, const std::string& title,
                          std::string description, const Model& model, const app::GisPlane& plane) {
  if (!description.empty()) description += " ";
  description += "Seen along " + plane.along() + ", with " + plane.axes() + " in meters.";
  nlohmann::json json{{"id", id},
                      {"title", title},
                      {"description", std::move(description)},
                      {"extent", extent_of(model, plane, place.base)},
                      {"crs", systems_of(plane, model, place.base)},
                      {"storageCrs", uri_of(plane, model, place.base)}};
  json["links"].push_back(ogc_link(place.of(id), "self", "application/json", title));
  return json;
}

void add_features(nlohmann::json& json, const OgcPlace& place, const std::string& id) {
  json["itemType"] = "feature";
  json["links"].push_back(
      ogc_link(place.of(id, "/items"), "items", kGeoJsonType, "The features as GeoJSON"));
}

void add_query(nlohmann::json& json, const OgcPlace& place, const std::string& id,
               const std::string& type, const std::string& title) {
  nlohmann::json link = ogc_link(place.of(id, "/" + type), "data", kCoverageJsonType, title);
  link["variables"] = {{"title", title},
                       {"query_type", type},
                       {"output_formats", nlohmann::json::array({"CoverageJSON"})},
                       {"default_output_format", "CoverageJSON"}};
  json["data_queries"][type] = {{"link", link}};
  json["links"].push_back(std::move(link));
}

}  // namespace

std::string OgcPlace::of(const std::string& collection, const std::string& part,
                         std::string_view query) const {
  return with_query(with_query(base + "/collections/" + collection + part, query), along);
}

app::GisPlane::Box bounds_of(const Model& model, const app::GisPlane& plane) {
  return {plane.axis().on_map(model.bounds_min), plane.axis().on_map(model.bounds_max)};
}

double cell_of(const Model& model, const Layer& layer) {
  const double area = app::texel_area(model, layer.resolution);
  return area > 0 ? std::sqrt(area) : 1;
}

glm::dvec2 cells_of(const app::GisPlane::Box& window, double cell) {
  return glm::max(glm::round((window.high - window.low) / cell), 1.0);
}

glm::dvec2 limited(const glm::dvec2& size, double most_cells) {
  const double cells = size.x * size.y;
  if (cells <= most_cells) return size;
  const glm::dvec2 smaller = glm::max(glm::floor(size * std::sqrt(most_cells / cells)), 1.0);
  return glm::min(smaller, most_cells);
}

nlohmann::json model_collection(const OgcPlace& place, const Model& model,
                                const std::vector<Layer>& layers, const app::GisPlane& plane) {
  nlohmann::json json =
      collection(place, model.slug, model.name, "The values of all layers.", model, plane);
  json["links"].push_back(ogc_link(place.of(model.slug), "collection", "application/json",
                                   "The queries for the values of the layers"));
  add_query(json, place, model.slug, "position", "The values at a position");
  add_query(json, place, model.slug, "trajectory", "The values along a line");
  add_query(json, place, model.slug, "area", "The values in an area");
  // A grid has square cells only on the plane.
  json["data_queries"]["area"]["link"]["variables"]["crs_details"] = nlohmann::json::array(
      {{{"crs", uri_of(plane, model, place.base)}, {"wkt", plane.wkt(model.name)}}});
  for (const Layer& layer : layers) {
    const std::string id = model.slug + "." + layer.slug;
    json["links"].push_back(
        ogc_link(place.of(id), "related", "application/json", "The layer " + layer.name));
  }
  json["output_formats"] = nlohmann::json::array({"CoverageJSON"});
  // EDR describes parameters with plain texts, unlike CoverageJSON.
  json["parameter_names"] = nlohmann::json::object();
  for (const Layer& layer : layers) {
    nlohmann::json parameter{{"type", "Parameter"},
                             {"id", layer.slug},
                             {"data-type", is_float(layer.type) ? "float" : "integer"},
                             {"observedProperty", {{"label", layer.name}}}};
    if (!layer.description.empty()) parameter["description"] = layer.description;
    if (!layer.unit.empty()) parameter["unit"] = {{"label", layer.unit}, {"symbol", layer.unit}};
    json["parameter_names"][layer.slug] = std::move(parameter);
  }
  return json;
}

nlohmann::json layer_collection(const OgcPlace& place, const Model& model, const Layer& layer,
                                const app::GisPlane& plane) {
  const std::string id = model.slug + "." + layer.slug;
  nlohmann::json json =
      collection(place, id, layer.name + " (" + model.name + ")", layer.description, model, plane);
  add_features(json, place, id);
  const std::string coverage(std::string(kRelations) + "coverage");
  json["links"].push_back(ogc_link(place.of(id, "/coverage", "f=tiff"), coverage, kGeoTiffType,
                                   "The values as GeoTIFF"));
  json["links"].push_back(ogc_link(place.of(id, "/coverage", "f=covjson"), coverage,
                                   kCoverageJsonType, "The values as CoverageJSON"));
  json["links"].push_back(ogc_link(place.of(id, "/schema"), std::string(kRelations) + "schema",
                                   "application/schema+json", "The meaning of the values"));
  const app::GisPlane::Box bounds = bounds_of(model, plane);
  const glm::dvec2 size = limited(cells_of(bounds, cell_of(model, layer)), kMostFileCells);
  nlohmann::json grid = nlohmann::json::array();
  for (int axis = 0; axis < 2; ++axis)
    grid.push_back(
        {{"cellsCount", static_cast<std::int64_t>(size[axis])},
         {"resolution", plane.metres() * (bounds.high[axis] - bounds.low[axis]) / size[axis]}});
  // The axes of the grid have the order of the coordinates.
  if (plane.crs() && plane.crs()->is_north_first()) std::swap(grid[0], grid[1]);
  json["extent"]["spatial"]["storageCrsBbox"] =
      box_list(plane.write_box(bounds, app::GisSystem::plane));
  json["extent"]["spatial"]["grid"] = std::move(grid);
  return json;
}

nlohmann::json column_collection(const OgcPlace& place, const Model& model, const Layer& layer,
                                 const Column& column, const app::GisPlane& plane) {
  const std::string id = model.slug + "." + layer.slug + "." + column.slug;
  nlohmann::json json =
      collection(place, id, column.name + " – " + layer.name + " (" + model.name + ")",
                 column.comment, model, plane);
  add_features(json, place, id);
  return json;
}

}  // namespace strata::net
