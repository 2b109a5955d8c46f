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

struct Limits {
  const ListLimits* lists;  // of this value; null: none
  std::optional<ListTooLong>* too_long;

  Limits of_item() const { return {lists ? lists->items.get() : nullptr, too_long}; }
  Limits of_member(std::string_view name) const {
    if (!lists) return *this;
    const auto member = lists->members.find(name);
    return {member == lists->members.end() ? nullptr : member->second.get(), too_long};
  }
  // Where something below was too long: says that it stands at this step.
  void put_before(const std::string& step) const {
    if (!too_long || !*too_long) return;
    std::string& path = (*too_long)->path;
    path = step + (path.empty() || path.front() == '[' ? "" : ".") + path;
  }
};

// False where the careful reader has to say why, or a list is too long. `depth`: how many objects and lists may still be opened.
bool convert(const element& from, int depth, const Limits& limits, json& to) {
  switch (from.type()) {
    case element_type::ARRAY: {
      if (depth == 0) return false;
      const simdjson::dom::array values = from;
      if (limits.lists && limits.lists->most && values.size() > *limits.lists->most) {
        if (limits.too_long) limits.too_long->emplace(ListTooLong{{}, limits.lists->wanted});
        return false;
      }
      to = json::array();
      auto& list = to.get_ref<json::array_t&>();
      list.reserve(values.size());
      for (const element value : values)
        if (!convert(value, depth - 1, limits.of_item(), list.emplace_back())) {
          limits.put_before("[" + std::to_string(list.size() - 1) + "]");
          return false;
        }
      return true;
    }
    case element_type::OBJECT: {
      if (depth == 0) return false;
      const simdjson::dom::object members = from;
      to = json::object();
      for (const auto& [name, value] : members) {
        const auto [place, is_new] = to.emplace(std::string(name), nullptr);
        if (!is_new || has_nul(name)) return false;
        if (!convert(value, depth - 1, limits.of_member(name), *place)) {
          limits.put_before(std::string(name));
          return false;
        }
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
        to = static_cast<std::uint64_t>(number);  // as nlohmann-json keeps what has no sign
      return true;
    }
    case element_type::UINT64: to = static_cast<std::uint64_t>(from); return true;
    case element_type::DOUBLE: to = static_cast<double>(from); return true;
    case element_type::BOOL: to = static_cast<bool>(from); return true;
    case element_type::NULL_VALUE: to = nullptr; return true;
  }
  return false;
}

}  // namespace

std::optional<json> read_json_fast(std::string_view text, int max_depth, const ListLimits* lists,
                                   std::optional<ListTooLong>* too_long) {
  simdjson::dom::parser parser;
  element root;
  if (parser.parse(text.data(), text.size()).get(root)) return std::nullopt;
  json value;
  if (!convert(root, max_depth, {lists, too_long}, value)) return std::nullopt;
  return value;
}

}  // namespace strata::protocol
