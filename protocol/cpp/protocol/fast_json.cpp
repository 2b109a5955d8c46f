#include "protocol/fast_json.h"

#include <simdjson.h>

#include <string>
#include <utility>

namespace strata::protocol {
namespace {

using nlohmann::json;
using simdjson::dom::element;
using simdjson::dom::element_type;

bool has_nul(std::string_view text) { return text.find('\0') != std::string_view::npos; }

// Returns false for a value that the strict parser must check and report. `depth` is the number of
// objects and lists that may still be nested.
bool convert(const element& from, int depth, json& to) {
  switch (from.type()) {
    case element_type::ARRAY: {
      if (depth == 0) return false;
      const simdjson::dom::array values = from;
      to = json::array();
      auto& list = to.get_ref<json::array_t&>();
      list.reserve(values.size());
      for (const element value : values)
        if (!convert(value, depth - 1, list.emplace_back())) return false;
      return true;
    }
    case element_type::OBJECT: {
      if (depth == 0) return false;
      const simdjson::dom::object members = from;
      to = json::object();
      for (const auto& [name, value] : members) {
        const auto [place, is_new] = to.emplace(std::string(name), nullptr);
        if (!is_new || has_nul(name) || !convert(value, depth - 1, *place)) return false;
      }
      return true;
    }
    case element_type::STRING: {
      const std::string_view text = from;
      if (has_nul(text)) return false;
      to = std::string(text);
      return true;
    }
    case element_type::INT64: {
      const std::int64_t number = from;
      if (number < 0)
        to = number;
      else
        to = static_cast<std::uint64_t>(number);  // nlohmann-json stores unsigned numbers this way
      return true;
    }
    case element_type::UINT64: to = static_cast<std::uint64_t>(from); return true;
    case element_type::DOUBLE: to = static_cast<double>(from); return true;
    case element_type::BOOL: to = static_cast<bool>(from); return true;
    case element_type::NULL_VALUE: to = nullptr; return true;
  }
  return false;
}

bool says_something(const ListLimits& limits) {
  return limits.most || limits.items || !limits.members.empty();
}

// Returns false if a list was found, or if the text is not JSON.
bool scan(simdjson::ondemand::value value, const ListLimits& limits,
          std::optional<ListTooLong>& found) {
  simdjson::ondemand::json_type type;
  if (value.type().get(type)) return false;
  // Adds `step` before the path of a list that was found in this member or item.
  const auto put_before = [&](const std::string& step) {
    if (!found) return;
    const bool joins = found->path.empty() || found->path.front() == '[';
    found->path = step + (joins ? "" : ".") + found->path;
  };
  if (type == simdjson::ondemand::json_type::array) {
    simdjson::ondemand::array items;
    if (value.get_array().get(items)) return false;
    std::size_t count = 0;
    for (auto each : items) {
      simdjson::ondemand::value item;
      if (each.get(item)) return false;
      if (limits.most && ++count > *limits.most) {
        found = ListTooLong{{}, limits.wanted};
        return false;
      }
      if (limits.items && says_something(*limits.items) && !scan(item, *limits.items, found)) {
        put_before("[" + std::to_string(count - 1) + "]");
        return false;
      }
    }
  } else if (type == simdjson::ondemand::json_type::object) {
    simdjson::ondemand::object members;
    if (value.get_object().get(members)) return false;
    for (auto each : members) {
      simdjson::ondemand::field field;
      std::string_view name;
      if (std::move(each).get(field) || field.unescaped_key().get(name)) return false;
      const auto member = limits.members.find(name);
      if (member == limits.members.end() || !says_something(*member->second)) continue;
      const std::string step(name);
      if (!scan(field.value(), *member->second, found)) {
        put_before(step);
        return false;
      }
    }
  }
  return true;
}

}  // namespace

std::optional<ListTooLong> find_long_list(std::string_view text, const ListLimits& lists) {
  simdjson::ondemand::parser parser;
  const simdjson::padded_string padded(text);
  simdjson::ondemand::document document;
  simdjson::ondemand::value root;
  std::optional<ListTooLong> found;
  if (!parser.iterate(padded).get(document) && !document.get_value().get(root))
    scan(root, lists, found);
  return found;
}

std::optional<json> read_json_fast(std::string_view text, int max_depth) {
  simdjson::dom::parser parser;
  element root;
  if (parser.parse(text.data(), text.size()).get(root)) return std::nullopt;
  json value;
  if (!convert(root, max_depth, value)) return std::nullopt;
  return value;
}

}  // namespace strata::protocol
