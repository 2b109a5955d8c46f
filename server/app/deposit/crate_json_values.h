#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

// Values in the JSON of a deposit (crate_json.h).
namespace strata::app::crate {

inline nlohmann::json of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 vec3_of(const nlohmann::json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

// Reads a name with the parser of its type.
template <class Parse>
auto named(const nlohmann::json& value, const Parse& parse) {
  const auto text = value.get<std::string>();
  const auto parsed = parse(text);
  if (!parsed) throw std::domain_error("unknown name `" + text + "`");
  return *parsed;
}

template <class T>
nlohmann::json optional(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

// Reads a member that may be null or missing.
template <class T>
std::optional<T> optional_at(const nlohmann::json& all, const char* member) {
  const auto found = all.find(member);
  if (found == all.end() || found->is_null()) return std::nullopt;
  return found->get<T>();
}

}  // namespace strata::app::crate
