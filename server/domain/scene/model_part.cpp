#include "domain/scene/model_part.h"

#include <nlohmann/json.hpp>

namespace strata {
namespace {

nlohmann::json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

glm::dvec3 vec3_of(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace

nlohmann::json to_json(const std::vector<ModelPart>& parts, double metres_per_unit) {
  auto json = nlohmann::json::array();
  for (const ModelPart& part : parts)
    json.push_back(
        {{"name", part.name},
         {"folder", part.folder},
         {"triangles", part.triangles},
         {"area_m2", part.area * metres_per_unit * metres_per_unit},
         {"bounds", {{"min", to_json(part.bounds_min)}, {"max", to_json(part.bounds_max)}}}});
  return json;
}

std::vector<ModelPart> model_parts_from_json(const nlohmann::json& json) {
  std::vector<ModelPart> parts;
  if (!json.is_array()) return parts;
  for (const auto& part : json)
    parts.push_back({part.value("name", std::string()), part.value("folder", std::string()),
                     part.value("triangles", std::uint64_t{0}), part.value("area_m2", 0.0),
                     vec3_of(part.at("bounds").at("min")), vec3_of(part.at("bounds").at("max"))});
  return parts;
}

}  // namespace strata
