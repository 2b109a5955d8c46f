#include "mesh/io/gltf/property_table.h"

#include <algorithm>
#include <bit>
#include <set>

#include "core/overloaded.h"

namespace strata::mesh {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr const char* kClass = "feature";
constexpr std::uint16_t kNoChoice = 0xffff;

using Bytes = std::vector<std::uint8_t>;

template <class T>
void append(Bytes& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Creates identifiers that match ^[a-zA-Z_][a-zA-Z0-9_]*$.
class Identifiers {
 public:
  std::string of(const std::string& name) {
    std::string id;
    for (const char c : name) id += is_letter(c) || is_digit(c) ? c : '_';
    if (id.empty() || is_digit(id.front())) id.insert(id.begin(), '_');
    while (!taken_.insert(id).second) id += '_';
    return id;
  }

 private:
  std::set<std::string> taken_;
};

template <class Value>
bool has_any(const std::vector<std::optional<Value>>& values) {
  return std::ranges::any_of(values, [](const auto& value) { return value.has_value(); });
}
template <class Value>
bool has_all(const std::vector<std::optional<Value>>& values) {
  return std::ranges::all_of(values, [](const auto& value) { return value.has_value(); });
}

class TableWriter {
 public:
  TableWriter(const std::string& name, std::size_t count, std::size_t first_view)
      : first_view_(first_view), name_(name), count_(count) {}

  void add(const FeatureProperty& property) {
    std::visit(Overloaded{[&](const FeatureProperty::Numbers& numbers) {
                            if (has_any(numbers)) add_numbers(property, numbers);
                          },
                          [&](const FeatureProperty::Flags& flags) {
                            if (has_any(flags)) add_flags(property, flags);
                          },
                          [&](const FeatureProperty::Texts& texts) {
                            const auto is_empty = [](const auto& text) { return text.empty(); };
                            if (!std::ranges::all_of(texts, is_empty)) add_texts(property, texts);
                          },
                          [&](const FeatureProperty::Choices& choices) {
                            if (has_any(choices.values)) add_choices(property, choices);
                          }},
               property.values);
  }

  PropertyTable finish() {
    PropertyTable table;
    nlohmann::json& schema = table.extension["schema"];
    schema["id"] = "strata";
    schema["classes"][kClass] = {{"name", name_}, {"properties", std::move(described_)}};
    if (!enums_.empty()) schema["enums"] = std::move(enums_);
    table.extension["propertyTables"].push_back({{"name", name_},
                                                 {"class", kClass},
                                                 {"count", count_},
                                                 {"properties", std::move(stored_)}});
    table.views = std::move(views_);
    return table;
  }

 private:
  std::size_t add_view(Bytes bytes) {
    views_.push_back(std::move(bytes));
    return first_view_ + views_.size() - 1;
  }

  static std::string title_of(const FeatureProperty& property, const std::string& id) {
    if (!property.title.empty()) return property.title;
    return id == property.name ? id : property.name + " (" + id + ")";
  }

  std::string describe(const FeatureProperty& property, nlohmann::json description) {
    std::string id = properties_.of(property.name);
    description["name"] = title_of(property, id);
    if (!property.unit.empty()) description["description"] = "Unit: " + property.unit;
    described_[id] = std::move(description);
    return id;
  }

  void add_numbers(const FeatureProperty& property, const FeatureProperty::Numbers& numbers) {
    Bytes bytes;
    for (const auto& number : numbers) append(bytes, number.value_or(kNoNumber));
    nlohmann::json description{{"type", "SCALAR"}, {"componentType", "FLOAT64"}};
    if (has_all(numbers))
      description["required"] = true;
    else
      description["noData"] = kNoNumber;
    const std::string id = describe(property, std::move(description));
    stored_[id] = {{"values", add_view(std::move(bytes))}};
  }

  void add_flags(const FeatureProperty& property, const FeatureProperty::Flags& flags) {
    if (!has_all(flags)) {
      FeatureProperty::Choices choices{{"false", "true"}, {}};
      for (const auto& flag : flags) {
        choices.values.emplace_back();
        if (flag) choices.values.back() = *flag ? 1 : 0;
      }
      return add_choices(property, choices);
    }
    Bytes bytes((flags.size() + 7) / 8);
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (*flags[i]) bytes[i / 8] |= static_cast<std::uint8_t>(1u << (i % 8));
    const std::string id = describe(property, {{"type", "BOOLEAN"}, {"required", true}});
    stored_[id] = {{"values", add_view(std::move(bytes))}};
  }

  void add_texts(const FeatureProperty& property, const FeatureProperty::Texts& texts) {
    std::size_t length = 0;
    for (const std::string& text : texts) length += text.size();
    const bool is_long = length > 0xffffffffu;
    Bytes bytes, offsets;
    bytes.reserve(length);
    const auto append_offset = [&] {
      if (is_long)
        append(offsets, std::uint64_t{bytes.size()});
      else
        append(offsets, static_cast<std::uint32_t>(bytes.size()));
    };
    append_offset();
    for (const std::string& text : texts) {
      bytes.insert(bytes.end(), text.begin(), text.end());
      append_offset();
    }
    const std::string id = describe(property, {{"type", "STRING"}, {"noData", ""}});
    const std::size_t values = add_view(std::move(bytes));
    stored_[id] = {{"values", values},
                   {"stringOffsets", add_view(std::move(offsets))},
                   {"stringOffsetType", is_long ? "UINT64" : "UINT32"}};
  }

  void add_choices(const FeatureProperty& property, const FeatureProperty::Choices& choices) {
    nlohmann::json values = nlohmann::json::array();
    for (std::size_t i = 0; i < choices.names.size(); ++i)
      values.push_back({{"name", choices.names[i]}, {"value", i}});
    nlohmann::json description{{"type", "ENUM"}};
    if (has_all(choices.values)) {
      description["required"] = true;
    } else {
      std::string none = "No data";  // a name may not be empty
      while (std::ranges::find(choices.names, none) != choices.names.end()) none += "_";
      values.push_back({{"name", none}, {"value", kNoChoice}});
      description["noData"] = none;
    }
    const std::string type = enum_types_.of(property.name);
    enums_[type] = {
        {"name", title_of(property, type)}, {"valueType", "UINT16"}, {"values", std::move(values)}};
    description["enumType"] = type;
    Bytes bytes;
    for (const auto& value : choices.values) append(bytes, value.value_or(kNoChoice));
    const std::string id = describe(property, std::move(description));
    stored_[id] = {{"values", add_view(std::move(bytes))}};
  }

  const std::size_t first_view_;
  const std::string name_;
  const std::size_t count_;
  Identifiers properties_, enum_types_;
  nlohmann::json described_ = nlohmann::json::object(), stored_ = nlohmann::json::object(),
                 enums_ = nlohmann::json::object();
  std::vector<Bytes> views_;
};

}  // namespace

std::uint64_t bytes_of(const FeatureProperty& property) {
  return std::visit(Overloaded{[](const FeatureProperty::Texts& texts) {
                                 std::uint64_t bytes = texts.size() * sizeof(std::string);
                                 for (const std::string& text : texts) bytes += text.size();
                                 return bytes;
                               },
                               [](const FeatureProperty::Choices& choices) {
                                 return std::uint64_t{choices.values.size() *
                                                      sizeof(FeatureProperty::Choices::values[0])};
                               },
                               [](const auto& values) {
                                 return std::uint64_t{values.size() * sizeof(values[0])};
                               }},
                    property.values);
}

PropertyTable property_table(const std::string& name, std::size_t count,
                             const std::vector<FeatureProperty>& properties,
                             std::size_t first_view) {
  TableWriter writer(name, count, first_view);
  for (const FeatureProperty& property : properties) writer.add(property);
  return writer.finish();
}

}  // namespace strata::mesh
