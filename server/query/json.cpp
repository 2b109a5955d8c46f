#include "query/json.h"

#include <cmath>
#include <cstdint>

namespace strata::query {
namespace {

using nlohmann::json;

template <class Vector>
json array3(const Vector& v) {
  return json::array({v.x, v.y, v.z});
}

// Keys and classes read as 3, not 3.0.
json number(double value) {
  constexpr double kExactIntegers = 9007199254740992.0;
  if (value == std::floor(value) && std::abs(value) < kExactIntegers) return static_cast<std::int64_t>(value);
  return value;
}

}  // namespace

json to_json(const SurfacePoint& point) {
  if (!point.hit) return {{"hit", false}};
  json values = json::object();
  for (const auto& value : point.values) values[value.layer] = {{"valid", value.valid}, {"value", number(value.value)}};
  return {{"hit", true},
          {"position", array3(point.position)},
          {"normal", array3(point.normal)},
          {"distance", point.distance},
          {"uv", json::array({point.uv.x, point.uv.y})},
          {"values", values}};
}

json to_json(const Statistics& statistics) {
  json histogram = json::array();
  for (const auto& bin : statistics.histogram)
    histogram.push_back({{"from", number(bin.from)}, {"to", number(bin.to)}, {"texels", bin.texels}, {"area_m2", bin.area_m2}});
  json keys = json::array();
  for (const auto& [key, of] : statistics.keys)
    keys.push_back({{"key", number(key)},
                    {"texels", of.texels},
                    {"area_m2", of.area_m2},
                    {"centroid", array3(of.centroid)},
                    {"bounds", {{"min", array3(of.bounds_min)}, {"max", array3(of.bounds_max)}}}});
  json out{{"texels", statistics.texels}, {"area_m2", statistics.area_m2}, {"histogram", std::move(histogram)}};
  if (statistics.texels > 0) {
    out["min"] = number(statistics.min);
    out["max"] = number(statistics.max);
    out["mean"] = number(statistics.mean);
    out["std"] = number(statistics.std);
  }
  if (!statistics.keys.empty()) out["keys"] = std::move(keys);
  return out;
}

}  // namespace strata::query
