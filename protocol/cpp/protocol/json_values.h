#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "domain/scene/model.h"

// Functions for the generated code that reads and writes JSON. The JSON must have passed
// `validate`, which guarantees its types. For other JSON, nlohmann-json throws.
namespace strata::protocol {

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsStringMap : std::false_type {};
template <class T>
struct IsStringMap<std::map<std::string, T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

using IdOrSlug = std::variant<std::int64_t, std::string>;

// Read types of the module core that represent a definition (`x-cpp-type` in the schemas).
void read_core(const nlohmann::json& json, Uuid& value);
void read_core(const nlohmann::json& json, glm::dvec2& value);
void read_core(const nlohmann::json& json, glm::dvec3& value);
void read_core(const nlohmann::json& json, glm::dvec4& value);
void read_core(const nlohmann::json& json, glm::dmat4& value);
void read_core(const nlohmann::json& json, strata::Camera& value);
void read_core(const nlohmann::json& json, strata::PartSet& value);
void read_core(const nlohmann::json& json, strata::LightMode& value);
void read_core(const nlohmann::json& json, strata::Light& value);
void read_core(const nlohmann::json& json, strata::ValueType& value);
void read_core(const nlohmann::json& json, strata::LayerKind& value);
void read_core(const nlohmann::json& json, strata::Unit& value);
void read_core(const nlohmann::json& json, strata::LayerBlend& value);
void read_core(const nlohmann::json& json, strata::Visibility& value);
void read_core(const nlohmann::json& json, IdOrSlug& value);
nlohmann::json write_core(const Uuid& value);
nlohmann::json write_core(const glm::dvec2& value);
nlohmann::json write_core(const glm::dvec3& value);
nlohmann::json write_core(const glm::dvec4& value);
nlohmann::json write_core(const glm::dmat4& value);
nlohmann::json write_core(const strata::Camera& value);
nlohmann::json write_core(const strata::PartSet& value);
nlohmann::json write_core(const strata::LightMode& value);
nlohmann::json write_core(const strata::Light& value);
nlohmann::json write_core(const strata::ValueType& value);
nlohmann::json write_core(const strata::LayerKind& value);
nlohmann::json write_core(const strata::Unit& value);
nlohmann::json write_core(const strata::LayerBlend& value);
nlohmann::json write_core(const strata::Visibility& value);
nlohmann::json write_core(const IdOrSlug& value);

template <class T>
void read_value(const nlohmann::json& json, T& value) {
  if constexpr (std::is_same_v<T, nlohmann::json>) {
    value = json;
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    json.get_to(value);
  } else if constexpr (IsVector<T>::value) {
    value.clear();
    value.reserve(json.size());
    for (const auto& item : json) read_value(item, value.emplace_back());
  } else if constexpr (IsStringMap<T>::value) {
    for (const auto& [key, item] : json.items()) read_value(item, value[key]);
  } else if constexpr (IsOptional<T>::value) {
    if (json.is_null())
      value.reset();
    else
      read_value(json, value.emplace());
  } else if constexpr (requires { read_core(json, value); }) {
    read_core(json, value);
  } else {
    read(json, value);
  }
}

template <class T>
nlohmann::json write_value(const T& value) {
  if constexpr (std::is_same_v<T, nlohmann::json> || std::is_arithmetic_v<T> ||
                std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (IsVector<T>::value) {
    nlohmann::json json = nlohmann::json::array();
    for (const auto& item : value) json.push_back(write_value(item));
    return json;
  } else if constexpr (IsStringMap<T>::value) {
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [key, item] : value) json[key] = write_value(item);
    return json;
  } else if constexpr (IsOptional<T>::value) {
    return value ? write_value(*value) : nlohmann::json(nullptr);
  } else if constexpr (requires { write_core(value); }) {
    return write_core(value);
  } else {
    return to_json(value);
  }
}

template <class T>
void read_member(const nlohmann::json& json, const char* name, T& value) {
  read_value(json.at(name), value);
}

template <class T>
void read_optional_member(const nlohmann::json& json, const char* name, T& value) {
  const auto member = json.find(name);
  if (member == json.end()) return;
  if constexpr (IsOptional<T>::value) {
    if (member->is_null())
      value.reset();
    else
      read_value(*member, value.emplace());
  } else {
    read_value(*member, value);
  }
}

template <class T>
void write_member(nlohmann::json& json, const char* name, const T& value) {
  json[name] = write_value(value);
}

template <class T>
void write_optional_member(nlohmann::json& json, const char* name, const std::optional<T>& value) {
  if (value) json[name] = write_value(*value);
}

inline std::string join_field(const std::string& parent, const std::string& member) {
  return parent.empty() ? member : parent + "." + member;
}

// Adds the path of the surrounding object before the field in the error of a check (".view" or
// "view").
Result<void> named_in_message(Result<void> checked, const std::string& parent);

// Calls `check` for the value of the variant, if its type has one.
template <class Variant>
Result<void> check_alternative(const Variant& variant, const std::string& field) {
  return std::visit(
      [&](const auto& value) -> Result<void> {
        if constexpr (requires { check(value, field); })
          return check(value, field);
        else
          return {};
      },
      variant);
}

}  // namespace strata::protocol
