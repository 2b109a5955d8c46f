#include "query/maps/map_features.h"

#include <algorithm>
#include <charconv>

namespace strata::query {
namespace {

constexpr std::size_t kMaxSampleLength = 200;  // longer texts are not names

std::string text_of(const MapValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const auto* number = std::get_if<double>(&value);
  return number ? number_text(*number) : std::string();
}

const MapValue& value_in(const MapFeature& feature, std::size_t column) {
  static const MapValue nothing;
  return column < feature.values.size() ? feature.values[column] : nothing;
}

Result<std::size_t> column_named(const FeatureMap& map, const std::string& name,
                                 const char* field) {
  const auto found = std::find(map.columns.begin(), map.columns.end(), name);
  if (found != map.columns.end()) return static_cast<std::size_t>(found - map.columns.begin());
  std::string known;
  for (const std::string& column : map.columns) known += (known.empty() ? "" : ", ") + column;
  return fail(ErrorCode::invalid, "Attribute not found",
              "The map has no attribute '" + name + "'" +
                  (known.empty() ? ". It has no attributes."
                                 : ". Its attributes are " + known.substr(0, 500) + "."),
              field);
}

tl::unexpected<Error> refuse(const MapFeature& feature, const std::string& what) {
  return fail(ErrorCode::invalid, "Map cannot be read", feature.place + ": " + what, "body");
}

}  // namespace

std::string number_text(double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  return {digits, end};
}

std::string too_many_values() {
  return "A map can have at most " + std::to_string(kMaxMapValues / 1'000'000) +
         " million attribute values. Leave out attributes, or send the map in parts.";
}

std::vector<MapColumn> columns_of(const FeatureMap& map) {
  std::vector<MapColumn> columns;
  for (std::size_t c = 0; c < map.columns.size(); ++c) {
    MapColumn column{map.columns[c], true, true, {}};
    bool any = false;
    for (const MapFeature& feature : map.features) {
      if (feature.polygons.empty()) continue;
      any = true;
      const MapValue& value = value_in(feature, c);
      column.is_number = column.is_number && std::holds_alternative<double>(value);
      const std::string text = text_of(value);
      column.is_text =
          column.is_text && std::holds_alternative<std::string>(value) && !text.empty();
      auto& samples = column.samples;
      if (samples.size() < kMaxSamples && !text.empty() && text.size() <= kMaxSampleLength &&
          std::find(samples.begin(), samples.end(), text) == samples.end())
        samples.push_back(text);
    }
    column.is_number = column.is_number && any;
    column.is_text = column.is_text && any;
    columns.push_back(std::move(column));
  }
  return columns;
}

Result<FlatMap> flat_map(const FeatureMap& map, const MapChoice& choice, KeyNames* keys) {
  std::size_t value_column = 0, name_column = 0;
  if (!choice.attribute.empty()) {
    const auto column = STRATA_TRY(column_named(map, choice.attribute, "attribute"));
    value_column = column;
  }
  if (!choice.names.empty()) {
    const auto column = STRATA_TRY(column_named(map, choice.names, "names"));
    name_column = column;
  }
  std::vector<MapArea> areas;
  for (const MapFeature& feature : map.features) {
    if (feature.polygons.empty()) continue;
    double number = choice.value;
    if (!choice.attribute.empty()) {
      const MapValue& value = value_in(feature, value_column);
      const auto* text = std::get_if<std::string>(&value);
      if (const auto* found = std::get_if<double>(&value))
        number = *found;
      else if (text && !text->empty() && keys)
        number = keys->key_of(*text);
      else if (text && !text->empty())
        return refuse(feature, "the attribute '" + choice.attribute +
                                   "' contains, instead of a number, the text \"" +
                                   text->substr(0, 60) +
                                   "\". To use names, choose a layer with a categorical legend.");
      else
        return refuse(feature,
                      "the attribute '" + choice.attribute + "' does not contain a number.");
    }
    if (!choice.names.empty() && keys)
      if (std::string name = text_of(value_in(feature, name_column)); !name.empty())
        keys->name(number, name);
    for (const MapFeature::Rings& rings : feature.polygons)
      areas.push_back({PolygonArea(rings), number});
  }
  if (areas.empty())
    return fail(ErrorCode::invalid, "No polygons", "The map contains no polygon.", "body");
  return FlatMap(std::move(areas));
}

}  // namespace strata::query
