#include "protocol/json_values.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

namespace strata::protocol {
namespace {

constexpr std::array<std::string_view, 4> kLightModes{"museum", "headlight", "raking",
                                                      "unlit"};  // in the order of LightMode

template <int n>
void read_numbers(const nlohmann::json& json, double* numbers) {
  for (int i = 0; i < n; ++i) numbers[i] = json.at(static_cast<std::size_t>(i)).get<double>();
}

template <int n>
nlohmann::json write_numbers(const double* numbers) {
  nlohmann::json json = nlohmann::json::array();
  for (int i = 0; i < n; ++i) json.push_back(numbers[i]);
  return json;
}

}  // namespace

void read_core(const nlohmann::json& json, Uuid& value) {
  if (auto uuid = parse_uuid(json.get_ref<const std::string&>())) value = *uuid;
}
void read_core(const nlohmann::json& json, glm::dvec2& value) {
  read_numbers<2>(json, glm::value_ptr(value));
}
void read_core(const nlohmann::json& json, glm::dvec3& value) {
  read_numbers<3>(json, glm::value_ptr(value));
}
void read_core(const nlohmann::json& json, glm::dvec4& value) {
  read_numbers<4>(json, glm::value_ptr(value));
}
void read_core(const nlohmann::json& json, glm::dmat4& value) {
  read_numbers<16>(json, glm::value_ptr(value));
}
void read_core(const nlohmann::json& json, strata::Camera& value) {
  read_core(json.at("view"), value.view);
  read_core(json.at("projection"), value.projection);
  json.at("width").get_to(value.width);
  json.at("height").get_to(value.height);
  value.section.clear();
  if (const auto section = json.find("section"); section != json.end())
    read_value(*section, value.section);
  value.hidden_parts.reset();
  if (const auto hidden = json.find("hidden_parts"); hidden != json.end())
    read_core(*hidden, value.hidden_parts);
}
void read_core(const nlohmann::json& json, strata::PartSet& value) {
  value.reset();
  for (const auto& part : json)
    if (const auto number = part.get<std::size_t>(); number < value.size()) value.set(number);
}
void read_core(const nlohmann::json& json, strata::LightMode& value) {
  const auto found = std::ranges::find(kLightModes, json.get_ref<const std::string&>());
  value = found == kLightModes.end() ? LightMode::museum
                                     : static_cast<LightMode>(found - kLightModes.begin());
}
void read_core(const nlohmann::json& json, strata::Light& value) {
  value = {};
  read_core(json.at("mode"), value.mode);
  if (const auto direction = json.find("direction"); direction != json.end())
    read_core(*direction, value.direction);
  value.exposure_ev = json.value("exposure", value.exposure_ev);
  value.fill = json.value("fill", value.fill);
  value.layer_opacity = json.value("layer_opacity", value.layer_opacity);
}
void read_core(const nlohmann::json& json, strata::ValueType& value) {
  if (auto type = parse_value_type(json.get_ref<const std::string&>())) value = *type;
}
void read_core(const nlohmann::json& json, strata::LayerKind& value) {
  value =
      json.get_ref<const std::string&>() == "database" ? LayerKind::database : LayerKind::numeric;
}
void read_core(const nlohmann::json& json, strata::Unit& value) {
  if (auto unit = parse_unit(json.get_ref<const std::string&>())) value = *unit;
}
void read_core(const nlohmann::json& json, strata::LayerBlend& value) {
  if (auto blend = parse_layer_blend(json.get_ref<const std::string&>())) value = *blend;
}
void read_core(const nlohmann::json& json, strata::Visibility& value) {
  if (auto visibility = parse_visibility(json.get_ref<const std::string&>())) value = *visibility;
}
void read_core(const nlohmann::json& json, IdOrSlug& value) {
  if (json.is_string())
    value = json.get<std::string>();
  else
    value = json.get<std::int64_t>();
}

nlohmann::json write_core(const Uuid& value) { return to_string(value); }
nlohmann::json write_core(const glm::dvec2& value) {
  return write_numbers<2>(glm::value_ptr(value));
}
nlohmann::json write_core(const glm::dvec3& value) {
  return write_numbers<3>(glm::value_ptr(value));
}
nlohmann::json write_core(const glm::dvec4& value) {
  return write_numbers<4>(glm::value_ptr(value));
}
nlohmann::json write_core(const glm::dmat4& value) {
  return write_numbers<16>(glm::value_ptr(value));
}
nlohmann::json write_core(const strata::Camera& value) {
  nlohmann::json json{{"view", write_core(value.view)},
                      {"projection", write_core(value.projection)},
                      {"width", value.width},
                      {"height", value.height}};
  if (!value.section.empty()) json["section"] = write_value(value.section);
  if (value.hidden_parts.any()) json["hidden_parts"] = write_core(value.hidden_parts);
  return json;
}
nlohmann::json write_core(const strata::PartSet& value) {
  nlohmann::json json = nlohmann::json::array();
  for (std::size_t part = 0; part < value.size(); ++part)
    if (value.test(part)) json.push_back(part);
  return json;
}
nlohmann::json write_core(const strata::LightMode& value) {
  return kLightModes.at(static_cast<std::size_t>(value));
}
nlohmann::json write_core(const strata::Light& value) {
  const strata::Light plain;
  nlohmann::json json{{"mode", write_core(value.mode)}, {"direction", write_core(value.direction)}};
  if (value.exposure_ev != plain.exposure_ev) json["exposure"] = value.exposure_ev;
  if (value.fill != plain.fill) json["fill"] = value.fill;
  if (value.layer_opacity != plain.layer_opacity) json["layer_opacity"] = value.layer_opacity;
  return json;
}
nlohmann::json write_core(const strata::ValueType& value) { return name(value); }
nlohmann::json write_core(const strata::LayerKind& value) {
  return value == LayerKind::database ? "database" : "numeric";
}
nlohmann::json write_core(const strata::Unit& value) { return name(value); }
nlohmann::json write_core(const strata::LayerBlend& value) { return name(value); }
nlohmann::json write_core(const strata::Visibility& value) { return name(value); }
nlohmann::json write_core(const IdOrSlug& value) {
  return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

Result<void> named_in_message(Result<void> checked, const std::string& parent) {
  if (checked) return checked;
  Error problem = checked.error();
  if (problem.field.starts_with('.')) problem.field.erase(0, 1);
  problem.field = join_field(parent, problem.field);
  return tl::unexpected<Error>(std::move(problem));
}

}  // namespace strata::protocol
