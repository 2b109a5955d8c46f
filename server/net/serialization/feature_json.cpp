#include "net/serialization/feature_json.h"

#include <nlohmann/json.hpp>

#include "core/text/bytes.h"
#include "core/text/fixed_number.h"
#include "domain/people/question.h"

namespace strata::net {
namespace {

constexpr std::size_t kPieceBytes = 1u << 16;

void append_place(std::string& text, const glm::dvec3& place, const CoordinateForm& form) {
  for (int axis = 0; axis < form.dimensions; ++axis) {
    text += axis == 0 ? '[' : ',';
    append_fixed(text, place[axis], form.decimals);
  }
  text += ']';
}

void append_path(std::string& text, const query::FlatRing& ring, bool closed,
                 const CoordinateForm& form) {
  for (std::size_t i = 0; i < ring.size() + (closed ? 1 : 0); ++i) {
    text += i == 0 ? '[' : ',';
    append_place(text, ring[i % ring.size()], form);
  }
  text += ']';
}

void append_geometry(std::string& text, app::FeatureKind kind,
                     const std::vector<query::FlatPolygon>& geometry, const CoordinateForm& form) {
  if (geometry.empty()) return void(text += "null");
  if (kind != app::FeatureKind::areas) {
    const query::FlatRing& path = geometry.front().rings.front();
    text += kind == app::FeatureKind::points ? R"({"type":"Point","coordinates":)"
                                             : R"({"type":"LineString","coordinates":)";
    if (kind == app::FeatureKind::points)
      append_place(text, path.front(), form);
    else
      append_path(text, path, false, form);
    return void(text += '}');
  }
  text += R"({"type":"MultiPolygon","coordinates":[)";
  for (const query::FlatPolygon& polygon : geometry) {
    if (&polygon != &geometry.front()) text += ',';
    for (const query::FlatRing& ring : polygon.rings) {
      text += &ring == &polygon.rings.front() ? '[' : ',';
      append_path(text, ring, true, form);
    }
    text += ']';
  }
  text += "]}";
}

nlohmann::json json_of(const app::FeatureValue& value) {
  return std::visit(
      []<class T>(const T& held) -> nlohmann::json {
        if constexpr (std::is_same_v<T, std::monostate>)
          return nullptr;
        else
          return held;
      },
      value);
}

std::string head(const app::FeatureSet& set) {
  nlohmann::json members{
      {"type", "FeatureCollection"}, {"name", set.name}, {"unit", set.unit}, {"axes", set.axes}};
  if (set.epsg != 0)
    members["crs"] = {
        {"type", "name"},
        {"properties", {{"name", "urn:ogc:def:crs:EPSG::" + std::to_string(set.epsg)}}}};
  std::string text = members.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.back() = ',';
  return text + R"("features":[)";
}

bool write(const app::FeatureSet& set, const Response::Sink& sink) {
  std::string text = head(set);
  bool is_first = true;
  for (const app::FeatureTable& table : set.tables)
    for (const app::Feature& feature : table.features) {
      check_question();
      text += is_first ? "\n" : ",\n";
      is_first = false;
      append_feature(text, table, feature, {});
      if (text.size() < kPieceBytes) continue;
      if (!sink(bytes_of(text))) return false;
      text.clear();
    }
  text += "\n]}\n";
  return sink(bytes_of(text));
}

}  // namespace

void append_feature(std::string& text, const app::FeatureTable& table, const app::Feature& feature,
                    const CoordinateForm& form, std::string_view members) {
  nlohmann::json properties = nlohmann::json::object();
  properties["kind"] = table.name;
  for (std::size_t i = 0; i < table.fields.size(); ++i)
    properties[table.fields[i].name] = json_of(feature.values[i]);
  text += R"({"type":"Feature",)";
  text += members;
  text += R"("properties":)";
  text += properties.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text += R"(,"geometry":)";
  append_geometry(text, table.kind, feature.geometry, form);
  text += '}';
}

Response feature_json(app::FeatureSet set) {
  const auto held = std::make_shared<const app::FeatureSet>(std::move(set));
  Response response;
  response.with("Content-Type", kGeoJsonType);
  name_download(response, held->name + ".geojson");
  response.stream =
      Response::Stream{{}, [held](const Response::Sink& sink) { return write(*held, sink); }};
  return response;
}

}  // namespace strata::net
