#include "protocol/validate.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "protocol/list_limits.h"

namespace strata::protocol {
namespace {

using nlohmann::json;

const json& definitions() {
  static const json parsed = json::parse(schema_bundle()).at("definitions");
  return parsed;
}

const valijson::Schema& built(Schema schema) {
  static std::array<std::once_flag, kSchemaCount> once;
  static std::array<std::unique_ptr<valijson::Schema>, kSchemaCount> schemas;
  const auto index = static_cast<std::size_t>(schema);
  std::call_once(once[index], [&] {
    const json document{{"$ref", "#/definitions/" + std::string(name(schema))},
                        {"definitions", definitions()}};
    auto result = std::make_unique<valijson::Schema>();
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), *result);
    schemas[index] = std::move(result);
  });
  return *schemas[index];
}

const json& resolve(const json& schema) {
  const json* node = &schema;
  while (node->contains("$ref"))
    node = &definitions().at(
        node->at("$ref").get_ref<const std::string&>().substr(sizeof("#/definitions/") - 1));
  return *node;
}

// Returns the part of a schema for a member of `value`, or null. For a choice by `op`, uses the
// branch of the op in `value`.
const json* child_schema(const json& schema, const json& value, const std::string& step) {
  const json& node = resolve(schema);
  if (value.is_array()) return node.contains("items") ? &node["items"] : nullptr;
  if (auto properties = node.find("properties");
      properties != node.end() && properties->contains(step) && !node.contains("allOf"))
    return &properties->at(step);
  if (node.contains("allOf") && value.contains("op"))
    for (const auto& branch : node["allOf"])
      if (branch["if"]["properties"]["op"]["const"] == value["op"])
        return child_schema(branch["then"], value, step);
  if (auto rest = node.find("additionalProperties"); rest != node.end() && rest->is_object())
    return &*rest;
  return nullptr;
}

std::string listed(const json& values) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + value.dump();
  return text;
}

std::string number(const json& value) { return value.dump(); }

// The rule of a schema that allows only numbers or lists of numbers.
struct NumberRule {
  bool is_list = false;
  double least = 0, most = 0;         // of a number, or of a list's length
  std::shared_ptr<NumberRule> items;  // of a list
};

// Returns null if the schema has other rules or allows other types.
std::shared_ptr<NumberRule> number_rule(const json& schema) {
  const json& node = resolve(schema);
  const std::string type = node.value("type", std::string());
  const bool is_list = type == "array";
  if (!is_list && type != "number") return nullptr;
  const std::vector<std::string_view> known =
      is_list ? std::vector<std::string_view>{"type", "minItems", "maxItems", "items"}
              : std::vector<std::string_view>{"type", "minimum", "maximum"};
  auto rule = std::make_shared<NumberRule>();
  for (const auto& [key, said] : node.items())
    if (key != "title" && key != "description" && !key.starts_with("x-") &&
        std::ranges::find(known, key) == known.end())
      return nullptr;
  for (const auto& key : known)
    if (!node.contains(key)) return nullptr;
  rule->is_list = is_list;
  rule->least = node[is_list ? "minItems" : "minimum"].get<double>();
  rule->most = node[is_list ? "maxItems" : "maximum"].get<double>();
  if (is_list) rule->items = number_rule(node["items"]);
  return is_list && !rule->items ? nullptr : rule;
}

bool holds(const NumberRule& rule, const json& value) {
  if (rule.is_list ? !value.is_array() : !value.is_number()) return false;
  const double number = rule.is_list ? static_cast<double>(value.size()) : value.get<double>();
  if (!(number >= rule.least && number <= rule.most)) return false;
  return !rule.is_list ||
         std::ranges::all_of(value, [&](const json& item) { return holds(*rule.items, item); });
}

// Returns a copy of a message in which long, valid lists of numbers contain only their first items.
// Returns nothing if there is no such list. Without this copy, valijson needs more time for a
// hundred thousand points than all other processing.
std::optional<json> without_long_lists(Schema schema, const json& value) {
  constexpr std::size_t kLong = 256;
  if (!value.is_object()) return std::nullopt;
  std::map<std::string, std::size_t> kept;
  for (const auto& [name, member] : value.items()) {
    if (!member.is_array() || member.size() < kLong) continue;
    const json* said =
        child_schema(definitions().at(std::string(protocol::name(schema))), value, name);
    const auto rule = said == nullptr ? nullptr : number_rule(*said);
    if (rule && rule->least < kLong && holds(*rule, member))
      kept[name] = static_cast<std::size_t>(rule->least);
  }
  if (kept.empty()) return std::nullopt;
  json shorter = json::object();
  for (const auto& [name, member] : value.items()) {
    const auto count = kept.find(name);
    if (count == kept.end())
      shorter[name] = member;
    else
      shorter[name] =
          json(member.begin(), member.begin() + static_cast<std::ptrdiff_t>(count->second));
  }
  return shorter;
}

// Describes the values that a schema accepts.
std::string expectation(const json& schema) {
  const json& node = resolve(schema);
  if (node.contains("const")) return "exactly " + node["const"].dump();
  if (node.contains("enum")) return "one of " + listed(node["enum"]);
  if (node.contains("oneOf") && !node.contains("type")) {
    std::string text;
    for (const auto& choice : node["oneOf"])
      text += (text.empty() ? "" : ", or ") + expectation(choice);
    return text;
  }
  std::string type = node.value("type", std::string("value"));
  if (type == "integer" || type == "number") {
    std::string text = type == "integer" ? "a whole number" : "a number";
    if (node.contains("exclusiveMinimum")) text += " above " + number(node["exclusiveMinimum"]);
    if (node.contains("minimum")) text += " from " + number(node["minimum"]);
    if (node.contains("maximum"))
      text += (node.contains("minimum") ? " to " : " up to ") + number(node["maximum"]);
    return text;
  }
  if (type == "string") {
    if (node.value("minLength", 0) == 36 && node.contains("pattern"))
      return "a UUID such as 123e4567-e89b-42d3-a456-426614174000";
    std::string text = "a text of " + std::to_string(node.value("minLength", 0)) + " to " +
                       number(node["maxLength"]) + " characters";
    if (node.contains("examples")) {
      text = "a text such as ";
      for (const auto& example : node["examples"])
        text += (text.ends_with("such as ") ? "" : " or ") + example.get<std::string>();
    } else if (node.contains("pattern")) {
      text += " like " + node["pattern"].get<std::string>();
    }
    return text;
  }
  if (type == "array") {
    const auto least = node["minItems"], most = node["maxItems"];
    const std::string count = least == most ? number(least) : number(least) + " to " + number(most);
    return "a list of " + count + " items, each " + expectation(node["items"]);
  }
  if (type == "boolean") return "true or false";
  if (type == "object") return "an object";
  return type;
}

// Does not limit lists that are nested more deeply, because the limits of their parents apply.
constexpr int kLimitsDeep = 6;

std::shared_ptr<const ListLimits> limits_of(const json& schema, int deep) {
  const json& node = resolve(schema);
  auto limits = std::make_shared<ListLimits>();
  if (deep == 0) return limits;
  if (node.value("type", json()) == "array" && node.contains("maxItems") &&
      node.contains("minItems") && node.contains("items")) {
    limits->most = node["maxItems"].get<std::size_t>();
    limits->wanted = expectation(node);
  }
  if (const auto items = node.find("items"); items != node.end() && items->is_object())
    limits->items = limits_of(*items, deep - 1);
  if (const auto properties = node.find("properties"); properties != node.end())
    for (const auto& [member, said] : properties->items())
      limits->members[member] = limits_of(said, deep - 1);
  return limits;
}

// Returns the member that valijson names at the end of a description. This is the text after
// `before`, without the final "'.".
std::string member_named(const std::string& description, std::string_view before) {
  const auto begin = description.find(before);
  if (begin == std::string::npos) return {};
  std::string member = description.substr(begin + before.size());
  if (member.ends_with("'.")) member.resize(member.size() - 2);
  return member;
}

// Returns the first missing member that a `oneOf` of an object requires in addition to an existing
// one. Returns an empty text if `value` has no such member.
std::string missing_companion(const json& schema, const json& value) {
  for (const auto& choice : resolve(schema).value("oneOf", json::array())) {
    const auto names = choice.value("required", std::vector<std::string>());
    if (names.empty() || !value.contains(names.front())) continue;
    const auto missing = std::find_if(names.begin(), names.end(),
                                      [&](const auto& name) { return !value.contains(name); });
    if (missing != names.end()) return *missing;
  }
  return {};
}

// Returns the names of the members from which a `oneOf` of an object requires exactly one.
std::vector<std::string> exclusive_members(const json* schema) {
  std::vector<std::string> names;
  if (schema == nullptr) return names;
  const json& node = resolve(*schema);
  if (!node.contains("oneOf")) return names;
  for (const auto& choice : node["oneOf"])
    if (choice.contains("required")) names.push_back(choice["required"][0].get<std::string>());
  return names;
}

// Returns the choice of a `oneOf` of an object whose first member exists. Returns null if there is
// no such choice or more than one.
const json* begun_choice(const json* schema, const json* value) {
  if (schema == nullptr || value == nullptr || !value->is_object()) return nullptr;
  const json& node = resolve(*schema);
  if (!node.contains("oneOf")) return nullptr;
  const json* begun = nullptr;
  for (const auto& choice : node["oneOf"]) {
    if (!choice.contains("required") || !value->contains(choice["required"][0])) continue;
    if (begun != nullptr) return nullptr;
    begun = &choice;
  }
  return begun;
}

// Returns the first existing member that a choice forbids, or an empty text.
std::string ruled_out(const json& choice, const json& value) {
  for (const auto& other : choice.value("not", json::object()).value("anyOf", json::array()))
    if (value.contains(other["required"][0])) return other["required"][0].get<std::string>();
  return {};
}

tl::unexpected<Error> explain(Schema schema, const json& whole, const std::string& field,
                              const valijson::ValidationResults::Error& error) {
  std::string path = field;
  const json* value = &whole;
  const json* rule = &definitions().at(std::string(name(schema)));
  auto enter = [&](const std::string& step) {
    path += (path.empty() ? "" : ".") + step.substr(0, 100);
  };
  for (std::size_t i = 1; i < error.context.size() && value != nullptr; ++i) {
    // The first element of the context is "<root>".
    const std::string& bracketed = error.context[i];
    const std::string step = bracketed.substr(1, bracketed.size() - 2);
    if (rule != nullptr) rule = child_schema(*rule, *value, step);
    if (value->is_array()) {
      path += bracketed;
      value = &value->at(static_cast<std::size_t>(std::stoul(step)));
    } else {
      enter(step);
      value = value->contains(step) ? &value->at(step) : nullptr;
    }
  }
  // A choice by `op` is an object to which the rules of the chosen branch apply.
  if (rule != nullptr && value != nullptr && value->is_object() && value->contains("op"))
    if (const json& node = resolve(*rule); node.contains("allOf"))
      for (const auto& branch : node["allOf"])
        if (branch["if"]["properties"]["op"]["const"] == (*value)["op"]) rule = &branch["then"];

  const std::string& said = error.description;
  if (said.starts_with("Missing required")) {
    std::string member = member_named(said, "property '");
    if (rule != nullptr && value != nullptr)
      if (const std::string companion = missing_companion(*rule, *value); !companion.empty())
        member = companion;
    const auto exclusive = exclusive_members(rule);
    if (!exclusive.empty() && member == exclusive.front()) {
      enter(member);
      return fail(ErrorCode::invalid, "Member missing",
                  "Give exactly one of " + listed(json(exclusive)) + ".", path);
    }
    const json* missing = rule == nullptr ? nullptr : child_schema(*rule, *value, member);
    enter(member);
    return fail(ErrorCode::invalid, "Member missing",
                "It must be given" + (missing ? ": " + expectation(*missing) : std::string()) + ".",
                path);
  }
  if (said.starts_with("Failed to validate against exactly one") ||
      said.starts_with("Target should not validate")) {
    if (const json* choice = begun_choice(rule, value))
      if (const std::string member = ruled_out(*choice, *value); !member.empty()) {
        enter(member);
        return fail(ErrorCode::invalid, "Members exclude each other",
                    "It does not go with " + listed((*choice)["required"]) + ".", path);
      }
    const auto exclusive = exclusive_members(rule);
    if (exclusive.size() > 1) {
      const auto sent = std::ranges::find_if(
          exclusive.rbegin(), exclusive.rend(),
          [&](const std::string& member) { return value != nullptr && value->contains(member); });
      enter(sent == exclusive.rend() ? exclusive.back() : *sent);
    }
    return fail(ErrorCode::invalid, "Members exclude each other",
                "Give exactly one of " + listed(json(exclusive)) + ".", path);
  }
  if (said.starts_with("Object contains a property")) {
    enter(member_named(said, "constraints: '"));
    return fail(ErrorCode::invalid, "Unknown member",
                "This object has no such member; check its spelling or leave it out.", path);
  }
  if (said.starts_with("Object should have no fewer"))
    return fail(ErrorCode::invalid, "Nothing given", "Give at least one member.", path);
  if (said.starts_with("Value type"))
    return fail(ErrorCode::invalid, "Wrong type",
                "It must be " + (rule ? expectation(*rule) : std::string("of another type")) + ".",
                path);
  return fail(ErrorCode::invalid, "Value not allowed",
              rule ? "It must be " + expectation(*rule) + "." : said, path);
}

}  // namespace

const ListLimits& list_limits(Schema schema) {
  static std::array<std::once_flag, kSchemaCount> once;
  static std::array<std::shared_ptr<const ListLimits>, kSchemaCount> limits;
  const auto index = static_cast<std::size_t>(schema);
  std::call_once(once[index], [&] {
    limits[index] = limits_of(definitions().at(std::string(name(schema))), kLimitsDeep);
  });
  return *limits[index];
}

Result<void> validate(Schema schema, const json& json, const std::string& field) {
  thread_local valijson::Validator validator;  // caches the compiled patterns
  const auto shorter = without_long_lists(schema, json);
  if (validator.validate(built(schema),
                         valijson::adapters::NlohmannJsonAdapter(shorter ? *shorter : json),
                         nullptr))
    return {};
  valijson::ValidationResults results;
  validator.validate(built(schema), valijson::adapters::NlohmannJsonAdapter(json), &results);
  valijson::ValidationResults::Error first;
  results.popError(first);
  return explain(schema, json, field, first);
}

}  // namespace strata::protocol
