#include "domain/tables/surface_feature.h"

#include <charconv>
#include <cmath>

#include "core/text/csv.h"

namespace strata {
namespace {

using nlohmann::json;

bool is_place(const json& value) {
  if (!value.is_array() || value.size() != 3) return false;
  for (const json& number : value)
    if (!number.is_number() || !(std::abs(number.get<double>()) <= kMaxFeatureCoordinate))
      return false;
  return true;
}
glm::dvec3 place_of(const json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}
json to_json(const glm::dvec3& place) { return {place.x, place.y, place.z}; }

bool fits(const std::vector<SurfaceFeature>& features, bool lines) {
  std::size_t places = 0;
  for (const SurfaceFeature& feature : features) {
    places += feature.places.size();
    if (feature.model < 1 ||
        (lines ? feature.places.size() < 2 || length_of(feature) == 0 : feature.places.size() != 1))
      return false;
  }
  return features.size() <= kMaxFeatures && places <= kMaxFeaturePlaces;
}

// Parses the output of print_features, and accepts additional spaces.
class FeatureReader {
 public:
  FeatureReader(std::string_view text, bool lines) : rest_(text), lines_(lines) {}

  std::optional<std::vector<SurfaceFeature>> read() {
    std::vector<SurfaceFeature> features;
    do {
      skip_blank();
      if (rest_.empty() && !features.empty()) break;  // allows a semicolon at the end
      SurfaceFeature feature;
      std::int64_t model = 0;
      if (features.size() == kMaxFeatures || !number(model) ||
          !word(lines_ ? "LINESTRING" : "POINT") || !word("Z") || !sign('('))
        return std::nullopt;
      feature.model = ModelId(model);
      do {
        glm::dvec3 place(0);
        if (!number(place.x) || !number(place.y) || !number(place.z) ||
            feature.places.size() == kMaxFeaturePlaces)
          return std::nullopt;
        feature.places.push_back(place);
      } while (sign(','));
      if (!sign(')')) return std::nullopt;
      features.push_back(std::move(feature));
    } while (sign(';'));
    if (!rest_.empty()) return std::nullopt;
    return features;
  }

 private:
  void skip_blank() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' ||
                              rest_.front() == '\n' || rest_.front() == '\r'))
      rest_.remove_prefix(1);
  }
  bool sign(char expected) {
    skip_blank();
    if (rest_.empty() || rest_.front() != expected) return false;
    rest_.remove_prefix(1);
    skip_blank();
    return true;
  }
  bool word(std::string_view expected) {
    skip_blank();
    if (rest_.size() < expected.size()) return false;
    for (std::size_t i = 0; i < expected.size(); ++i)
      if ((rest_[i] & ~0x20) != expected[i]) return false;
    rest_.remove_prefix(expected.size());
    return true;
  }
  template <class Number>
  bool number(Number& value) {
    skip_blank();
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }

  std::string_view rest_;
  const bool lines_;
};

}  // namespace

std::optional<std::vector<SurfaceFeature>> read_features(const json& value, bool lines) {
  if (!value.is_array() || value.size() > kMaxFeatures) return std::nullopt;
  std::vector<SurfaceFeature> features;
  for (const json& item : value) {
    if (!item.is_object() || item.size() != 2) return std::nullopt;
    const auto model = item.find("model"), coordinates = item.find("coordinates");
    if (model == item.end() || coordinates == item.end() || !model->is_number_integer() ||
        !coordinates->is_array() || coordinates->size() > kMaxFeaturePlaces)
      return std::nullopt;
    SurfaceFeature feature{model->get<ModelId>(), {}};
    for (const json& place : *coordinates) {
      if (!is_place(place)) return std::nullopt;
      feature.places.push_back(place_of(place));
    }
    features.push_back(std::move(feature));
  }
  if (!fits(features, lines)) return std::nullopt;
  return features;
}

std::vector<SurfaceFeature> features_of(const Record& record, const Column& column) {
  const auto cell = record.values.find(column.id);
  if (cell == record.values.end()) return {};
  return read_features(cell->second, column.kind == ColumnKind::line)
      .value_or(std::vector<SurfaceFeature>());
}

json to_json(std::span<const SurfaceFeature> features) {
  json list = json::array();
  for (const SurfaceFeature& feature : features) {
    json coordinates = json::array();
    for (const glm::dvec3& place : feature.places) coordinates.push_back(to_json(place));
    list.push_back({{"model", feature.model}, {"coordinates", std::move(coordinates)}});
  }
  return list;
}

std::string print_features(std::span<const SurfaceFeature> features, bool lines) {
  std::string text;
  for (const SurfaceFeature& feature : features) {
    text += (text.empty() ? "" : "; ") + to_string(feature.model) +
            (lines ? " LINESTRING Z (" : " POINT Z (");
    for (std::size_t i = 0; i < feature.places.size(); ++i) {
      if (i > 0) text += ", ";
      for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0) text += ' ';
        text += csv_number(feature.places[i][axis], ',');
      }
    }
    text += ')';
  }
  return text;
}

std::optional<std::vector<SurfaceFeature>> parse_features(std::string_view text, bool lines) {
  auto features = FeatureReader(text, lines).read();
  if (!features || !fits(*features, lines)) return std::nullopt;
  for (const SurfaceFeature& feature : *features)
    for (const glm::dvec3& place : feature.places)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(place[axis]) <= kMaxFeatureCoordinate)) return std::nullopt;
  return features;
}

double length_of(const SurfaceFeature& feature) {
  double length = 0;
  for (std::size_t i = 1; i < feature.places.size(); ++i)
    length += glm::distance(feature.places[i - 1], feature.places[i]);
  return length;
}

}  // namespace strata
