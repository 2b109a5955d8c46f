#include "query/flat_map.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace strata::query {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 16;

tl::unexpected<Problem> refuse(const std::string& where, const std::string& what) {
  return fail(422, "Map not understood", what, where.empty() ? "body" : "body." + where);
}

std::string inside(const std::string& where, const std::string& member) {
  return where.empty() ? member : where + "." + member;
}

class AreaReader {
 public:
  AreaReader(const std::string& attribute, double value) : attribute_(attribute), value_(value) {}

  Result<void> read(const json& node, const std::string& where, int depth = 0) {
    if (!node.is_object() || !node.contains("type") || !node["type"].is_string())
      return refuse(where, "A GeoJSON object with a `type` is expected here.");
    if (depth > 4) return refuse(where, "It is nested too deeply.");
    const auto& type = node["type"].get_ref<const std::string&>();
    if (type == "FeatureCollection") return each(node, "features", where, depth);
    if (type == "GeometryCollection") return each(node, "geometries", where, depth);
    if (type == "Feature") return feature(node, where, depth);
    if (type == "Polygon") return polygon(node.value("coordinates", json()), inside(where, "coordinates"));
    if (type == "MultiPolygon") {
      const json polygons = node.value("coordinates", json());
      if (!polygons.is_array()) return refuse(where, "A MultiPolygon has a list of polygons as `coordinates`.");
      for (std::size_t i = 0; i < polygons.size(); ++i)
        if (auto read = polygon(polygons[i], inside(where, "coordinates[" + std::to_string(i) + "]")); !read)
          return read;
      return {};
    }
    return refuse(where, "Only Polygon and MultiPolygon are painted, not " + type.substr(0, 40) + ".");
  }

  std::vector<MapArea> take() { return std::move(areas_); }

 private:
  Result<void> each(const json& node, const char* member, const std::string& where, int depth) {
    if (!node.contains(member) || !node[member].is_array())
      return refuse(where, "It lacks the list `" + std::string(member) + "`.");
    for (std::size_t i = 0; i < node[member].size(); ++i) {
      const std::string place = inside(where, std::string(member) + "[" + std::to_string(i) + "]");
      if (auto done = read(node[member][i], place, depth + 1); !done) return done;
    }
    return {};
  }

  Result<void> feature(const json& node, const std::string& where, int depth) {
    if (!node.contains("geometry")) return refuse(where, "A feature has a `geometry`.");
    if (node["geometry"].is_null()) return {};
    if (!attribute_.empty()) {
      const json properties = node.value("properties", json());
      const json found = properties.is_object() ? properties.value(attribute_, json()) : json();
      if (!found.is_number())
        return refuse(inside(where, "properties"), "The property '" + attribute_ + "' holds no number.");
      value_ = found.get<double>();
    }
    return read(node["geometry"], inside(where, "geometry"), depth + 1);
  }

  Result<void> polygon(const json& rings, const std::string& where) {
    if (!rings.is_array() || rings.empty()) return refuse(where, "A polygon is a list of rings.");
    std::vector<std::vector<glm::dvec2>> read_rings;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      const std::string place = where + "[" + std::to_string(r) + "]";
      if (!rings[r].is_array() || rings[r].size() < 3) return refuse(place, "A ring has at least three points.");
      auto& ring = read_rings.emplace_back();
      for (std::size_t p = 0; p < rings[r].size(); ++p) {
        const json& point = rings[r][p];
        if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number())
          return refuse(place + "[" + std::to_string(p) + "]", "A point is a list of numbers: x, y.");
        const glm::dvec2 at(point[0].get<double>(), point[1].get<double>());
        if (!std::isfinite(at.x) || !std::isfinite(at.y))
          return refuse(place + "[" + std::to_string(p) + "]", "Coordinates are finite numbers.");
        if (++points_ > kMaxMapPoints)
          return refuse(place, "A map has at most " + std::to_string(kMaxMapPoints) + " points; send it in parts.");
        ring.push_back(at);
      }
    }
    areas_.push_back({PolygonArea(read_rings), value_});
    return {};
  }

  const std::string& attribute_;
  double value_;
  std::vector<MapArea> areas_;
  std::size_t points_ = 0;
};

}  // namespace

Result<std::vector<MapArea>> parse_map_areas(std::string_view geojson, const std::string& attribute, double value) {
  bool too_deep = false;
  const json parsed = json::parse(
      geojson,
      [&](int depth, json::parse_event_t, const json&) {
        too_deep = too_deep || depth > kMaxDepth;
        return depth <= kMaxDepth;
      },
      false);
  if (too_deep) return fail(422, "Map not understood", "It is nested too deeply to be GeoJSON.", "body");
  if (parsed.is_discarded()) return fail(400, "Malformed JSON", "The body is no JSON text.", "body");
  AreaReader reader(attribute, value);
  if (auto read = reader.read(parsed, ""); !read) return tl::unexpected(read.error());
  auto areas = reader.take();
  if (areas.empty()) return fail(422, "No polygons", "The map holds no polygon.", "body");
  return areas;
}

std::optional<double> value_at(const std::vector<MapArea>& areas, const glm::dvec2& point) {
  for (auto area = areas.rbegin(); area != areas.rend(); ++area)
    if (area->area.contains(point)) return area->value;
  return std::nullopt;
}

Result<WorldFile> parse_world_file(std::string_view text, const std::string& field) {
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  const auto wrong = [&] {
    return fail(422, "World file not understood",
                "Give its six numbers: width and turn of a pixel in x and y, then the centre of the first pixel.",
                field);
  };
  const auto is_gap = [](char c) { return c == ',' || c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  for (std::size_t at = 0; at < text.size();) {
    if (is_gap(text[at])) {
      ++at;
      continue;
    }
    if (count == numbers.size()) return wrong();
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), numbers[count]);
    if (error != std::errc() || !std::isfinite(numbers[count])) return wrong();
    ++count;
    at = static_cast<std::size_t>(end - text.data());
    if (at < text.size() && !is_gap(text[at])) return wrong();
  }
  if (count != numbers.size()) return wrong();
  const WorldFile world{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
  const double area = world.x_per_column * world.y_per_row - world.x_per_row * world.y_per_column;
  if (!std::isnormal(area)) return fail(422, "World file not understood", "Its pixels have no area.", field);
  return world;
}

PlacedPicture::PlacedPicture(Picture picture, const WorldFile& world)
    : picture_(std::move(picture)),
      pixel_from_plane_(
          glm::inverse(glm::dmat2(world.x_per_column, world.y_per_column, world.x_per_row, world.y_per_row))),
      first_centre_(world.x, world.y) {}

std::optional<int> PlacedPicture::luminance_at(const glm::dvec2& point) const {
  const glm::dvec2 pixel = pixel_from_plane_ * (point - first_centre_) + 0.5;
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < picture_.width && pixel.y < picture_.height)) return std::nullopt;
  const std::uint8_t* rgba =
      picture_.rgba.data() + 4 * (static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(picture_.width) +
                                  static_cast<std::size_t>(pixel.x));
  if (rgba[3] < 128) return std::nullopt;
  return static_cast<int>(std::lround(0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2]));
}

}  // namespace strata::query
