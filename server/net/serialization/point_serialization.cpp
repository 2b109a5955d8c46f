#include "net/serialization/point_serialization.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/text/csv.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "mesh/parallel.h"
#include "query/sampling/profile.h"
#include "query/sampling/values.h"

namespace strata::net {

protocol::SurfacePoint to_protocol(const query::SurfacePoint& point) {
  protocol::SurfacePoint out;
  out.hit = point.hit;
  if (!point.hit) return out;
  out.position = point.position;
  out.normal = glm::dvec3(point.normal);
  out.uv = glm::dvec2(point.uv);
  // The maximum in the API. A camera may be farther from the surface.
  out.distance = std::clamp(point.distance, 0.0, 1e15);
  out.values.emplace();
  for (const auto& value : point.values) {
    protocol::SurfaceValue& entry = (*out.values)[value.layer];
    entry.valid = value.valid;
    // An imported raster can contain values that JSON cannot represent. Such a texel is valid in
    // the response but has no value.
    if (value.valid && std::isfinite(value.value)) entry.value = value.value;
  }
  return out;
}

protocol::Picked to_picked(const query::SurfacePoint& point, const std::optional<std::string>& id) {
  protocol::SurfacePoint surface = to_protocol(point);
  protocol::Picked picked;
  picked.id = id;
  picked.hit = surface.hit;
  picked.position = surface.position;
  picked.normal = surface.normal;
  picked.uv = surface.uv;
  picked.distance = surface.distance;
  picked.values = std::move(surface.values);
  return picked;
}

namespace {

std::string point_header(const std::vector<std::string>& layers) {
  std::vector<std::string> cells{"hit",      "x",        "y",        "z", "normal_x",
                                 "normal_y", "normal_z", "distance", "u", "v"};
  cells.insert(cells.end(), layers.begin(), layers.end());
  return csv_line(cells, ',');
}

// Writes each row into a buffer and then appends the buffer to the text. This is fast enough for
// hundreds of thousands of rows with ten numbers each.
class RowWriter {
 public:
  // Writes a float with only as many digits as a float needs.
  template <class Number>
  void number(Number value) {
    end_ = std::to_chars(end_, digits_.data() + digits_.size(), value).ptr;
  }
  void comma() { *end_++ = ','; }
  // Call it before the buffer can overflow.
  void move_to(std::string& text) {
    text.append(digits_.data(), end_);
    end_ = digits_.data();
  }

 private:
  std::array<char, 512> digits_;
  char* end_ = digits_.data();
};

void append_point(const query::SurfacePoint& point, const std::vector<std::string>& layers,
                  std::string& text) {
  if (!point.hit) {
    text += "false" + std::string(9 + layers.size(), ',') + "\r\n";
    return;
  }
  text += "true";
  RowWriter row;
  const auto add = [&](auto value) {
    row.comma();
    row.number(value);
  };
  for (int axis = 0; axis < 3; ++axis) add(point.position[axis]);
  for (int axis = 0; axis < 3; ++axis) add(point.normal[axis]);
  add(static_cast<float>(point.distance));
  add(point.uv.x);
  add(point.uv.y);
  row.move_to(text);
  for (const auto& layer : layers) {
    row.comma();
    for (const auto& value : point.values)
      if (value.layer == layer && value.valid) row.number(value.value);
    row.move_to(text);
  }
  text += "\r\n";
}

}  // namespace

std::string points_csv(const std::vector<query::SurfacePoint>& points,
                       const std::vector<std::string>& layers) {
  constexpr std::size_t kPointsAtOnce = 4096;
  std::vector<std::string> parts((points.size() + kPointsAtOnce - 1) / kPointsAtOnce);
  mesh::parallel_for(mesh::background_threads(), static_cast<int>(parts.size()), [&](int number) {
    const auto part = static_cast<std::size_t>(number);
    for (std::size_t i = part * kPointsAtOnce;
         i < std::min(points.size(), (part + 1) * kPointsAtOnce); ++i)
      append_point(points[i], layers, parts[part]);
  });
  std::string text = point_header(layers);
  std::size_t size = text.size();
  for (const std::string& part : parts) size += part.size();
  text.reserve(size);
  for (const std::string& part : parts) text += part;
  return text;
}

std::string profile_csv(const query::Profile& profile, Unit unit,
                        const std::vector<std::string>& layers) {
  std::string text = "along_mm," + point_header(layers);
  for (const auto& sample : profile.samples) {
    text += csv_number(in_millimetres(sample.along, unit), ',') + ",";
    append_point(sample.point, layers, text);
  }
  return text;
}

nlohmann::json to_json(const query::Profile& profile, Unit unit) {
  nlohmann::json samples = nlohmann::json::array();
  for (const auto& sample : profile.samples)
    samples.push_back({{"along_mm", in_millimetres(sample.along, unit)},
                       {"point", protocol::to_json(to_protocol(sample.point))}});
  return {{"length_mm", in_millimetres(profile.length, unit)}, {"samples", std::move(samples)}};
}

nlohmann::json coverage_parameters(const std::vector<Layer>& layers) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const auto& layer : layers) {
    nlohmann::json parameter{{"type", "Parameter"},
                             {"observedProperty", {{"label", {{"en", layer.name}}}}}};
    if (!layer.description.empty()) parameter["description"] = {{"en", layer.description}};
    if (!layer.unit.empty()) parameter["unit"] = {{"symbol", layer.unit}};
    parameters[layer.slug] = std::move(parameter);
  }
  return parameters;
}

nlohmann::json point_coverage(const query::SurfacePoint& point, const std::vector<Layer>& layers,
                              const Model& model) {
  nlohmann::json ranges = nlohmann::json::object();
  for (const auto& layer : layers) {
    nlohmann::json value;
    for (const auto& entry : point.values)
      if (entry.layer == layer.slug && entry.valid) value = entry.value;
    ranges[layer.slug] = {{"type", "NdArray"},
                          {"dataType", is_float(layer.type) ? "float" : "integer"},
                          {"values", {value}}};
  }
  nlohmann::json system{{"type", "GeographicCRS"}};
  if (model.crs.starts_with("EPSG:"))
    system["id"] = "http://www.opengis.net/def/crs/EPSG/0/" + model.crs.substr(5);
  auto axis = [&](double value) { return nlohmann::json{{"values", {value}}}; };
  return {{"type", "Coverage"},
          {"domain",
           {{"type", "Domain"},
            {"domainType", "Point"},
            {"axes",
             {{"x", axis(point.position.x)},
              {"y", axis(point.position.y)},
              {"z", axis(point.position.z)}}},
            {"referencing", {{{"coordinates", {"x", "y", "z"}}, {"system", system}}}}}},
          {"parameters", coverage_parameters(layers)},
          {"ranges", ranges}};
}

}  // namespace strata::net
