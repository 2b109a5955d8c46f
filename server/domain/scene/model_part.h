#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace strata {

constexpr std::size_t kMaxModelParts = 256;
// Numbers of parts. Numbers that no part has are ignored.
using PartSet = std::bitset<kMaxModelParts>;

// A part of a model that was imported from several scans: the surface of one of them. A part has a
// number, which is its index in `Model::parts`. Parts share no point of the surface.
struct ModelPart {
  std::string name;
  // The folders of the scan, outermost first and separated by "/". They form a tree. Empty: none.
  std::string folder;
  std::uint64_t triangles = 0;
  double area = 0;                          // unit²
  glm::dvec3 bounds_min{0}, bounds_max{0};  // in world coordinates
};
nlohmann::json to_json(const std::vector<ModelPart>& parts, double metres_per_unit);
// Reads the stored form, where metres_per_unit is 1. Null: no parts.
std::vector<ModelPart> model_parts_from_json(const nlohmann::json& json);

}  // namespace strata
