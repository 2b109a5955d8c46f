#include "query/maps/geojson.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

namespace strata::query {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 16;

tl::unexpected<Error> refuse(const std::string& where, const std::string& what) {
  return fail(ErrorCode::invalid, "Map cannot be read", what,
              where.empty() ? "body" : "body." + where);
}

std::string inside(const std::string& where, const std::string& member) {
  return where.empty() ? member : where + "." + member;
}

std::string element(const std::string& list, std::size_t i) {
  return list + "[" + std::to_string(i) + "]";
}

class Reader {
 public:
  Result<void> read(const json& node, const std::string& where, int depth = 0) {
    if (!node.is_object() || !node.contains("type") || !node["type"].is_string())
      return refuse(where, "Expected a GeoJSON object with a `type` here.");
    if (depth > 4) return refuse(where, "It is nested too deeply.");
    const auto& type = node["type"].get_ref<const std::string&>();
    if (type == "FeatureCollection") return each(node, "features", where, depth);
    if (type == "GeometryCollection") return each(node, "geometries", where, depth);
    if (type == "Feature") return feature(node, where, depth);
    if (type == "Polygon")
      return polygon(member(node, "coordinates"), inside(where, "coordinates"));
    if (type == "MultiPolygon") return polygons(member(node, "coordinates"), where);
    return refuse(where, "The server can paint only Polygon and MultiPolygon, not " +
                             type.substr(0, 40) + ".");
  }

  FeatureMap take() { return std::move(map_); }

 private:
  static const json& member(const json& node, const char* name) {
    static const json nothing;
    const auto found = node.find(name);
    return found == node.end() ? nothing : *found;
  }

  Result<void> each(const json& node, const char* name, const std::string& where, int depth) {
    const json& list = member(node, name);
    if (!list.is_array()) return refuse(where, "It has no list `" + std::string(name) + "`.");
    for (std::size_t i = 0; i < list.size(); ++i)
      STRATA_TRY(read(list[i], element(inside(where, name), i), depth + 1));
    return {};
  }

  // Returns the current feature, or a feature for the whole text if the text is only a geometry.
  MapFeature& current() {
    if (map_.features.empty()) map_.features.push_back({{}, {}, "body"});
    return map_.features.back();
  }

  Result<void> feature(const json& node, const std::string& where, int depth) {
    if (!node.contains("geometry")) return refuse(where, "A feature must have a `geometry`.");
    if (node["geometry"].is_null()) return {};
    if (map_.features.size() == kMaxMapFeatures)
      return refuse(where, "A map can have at most " + std::to_string(kMaxMapFeatures) +
                               " features. Send the map in parts.");
    map_.features.push_back({{}, {}, "body" + (where.empty() ? "" : "." + where)});
    STRATA_TRY(properties(member(node, "properties"), where));
    return read(node["geometry"], inside(where, "geometry"), depth + 1);
  }

  Result<void> properties(const json& held, const std::string& where) {
    if (!held.is_object()) return {};
    auto& values = current().values;
    for (const auto& [name, value] : held.items()) {
      if (name.size() > kMaxMapColumnLength) continue;
      MapValue read;
      if (value.is_number()) read = value.get<double>();
      if (value.is_boolean()) read = value.get<bool>() ? 1.0 : 0.0;
      if (value.is_string()) read = value.get<std::string>();
      const auto [column, is_new] = columns_.try_emplace(name, map_.columns.size());
      if (is_new && map_.columns.size() == kMaxMapColumns)
        return refuse(where, "A map can have at most " + std::to_string(kMaxMapColumns) +
                                 " different properties.");
      if (is_new) map_.columns.push_back(name);
      if (values.size() <= column->second) {
        cells_ += column->second + 1 - values.size();
        if (cells_ > kMaxMapValues) return refuse(where, too_many_values());
        values.resize(column->second + 1);
      }
      values[column->second] = std::move(read);
    }
    return {};
  }

  Result<void> polygons(const json& list, const std::string& where) {
    if (!list.is_array())
      return refuse(where, "The `coordinates` of a MultiPolygon must be a list of polygons.");
    for (std::size_t i = 0; i < list.size(); ++i)
      STRATA_TRY(polygon(list[i], element(inside(where, "coordinates"), i)));
    return {};
  }

  Result<void> polygon(const json& rings, const std::string& where) {
    if (!rings.is_array() || rings.empty())
      return refuse(where, "A polygon must be a list of rings.");
    MapFeature::Rings read_rings;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      const std::string place = element(where, r);
      if (!rings[r].is_array() || rings[r].size() < 3)
        return refuse(place, "A ring must have at least three points.");
      auto& ring = read_rings.emplace_back();
      for (std::size_t p = 0; p < rings[r].size(); ++p) {
        const json& point = rings[r][p];
        if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number())
          return refuse(element(place, p), "A point must be a list of numbers: x, y.");
        const glm::dvec2 at(point[0].get<double>(), point[1].get<double>());
        if (!std::isfinite(at.x) || !std::isfinite(at.y))
          return refuse(element(place, p), "Coordinates must be finite numbers.");
        if (++points_ > kMaxMapPoints)
          return refuse(place, "A map can have at most " + std::to_string(kMaxMapPoints) +
                                   " points. Send the map in parts.");
        ring.push_back(at);
      }
    }
    current().polygons.push_back(std::move(read_rings));
    return {};
  }

  FeatureMap map_;
  std::unordered_map<std::string, std::size_t> columns_;
  std::size_t points_ = 0, cells_ = 0;
};

}  // namespace

Result<FeatureMap> parse_geojson(std::string_view text) {
  bool too_deep = false;
  const json parsed = json::parse(
      text,
      [&](int depth, json::parse_event_t, const json&) {
        too_deep = too_deep || depth > kMaxDepth;
        return depth <= kMaxDepth;
      },
      false);
  if (too_deep)
    return fail(ErrorCode::invalid, "Map cannot be read", "It is nested too deeply to be GeoJSON.",
                "body");
  if (parsed.is_discarded())
    return fail(ErrorCode::malformed, "Malformed JSON", "The body is not JSON.", "body");
  Reader reader;
  STRATA_TRY(reader.read(parsed, ""));
  return reader.take();
}

}  // namespace strata::query
