#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace strata::mesh {

// The values of one property of features in a glTF file, one value for each feature.
struct FeatureProperty {
  using Numbers = std::vector<std::optional<double>>;  // finite
  using Flags = std::vector<std::optional<bool>>;
  using Texts = std::vector<std::string>;  // UTF-8; empty: no value
  struct Choices {
    std::vector<std::string> names;  // different, and not empty; at most kMaxNames
    std::vector<std::optional<std::uint16_t>> values;  // indices of `names`
    static constexpr std::size_t kMaxNames = 65535;
  };
  std::string name;  // such as "area_m2"
  std::variant<Numbers, Flags, Texts, Choices> values;
  // For people; empty: none. Properties may have equal titles.
  std::string title{}, unit{};
};

// Returns about the memory in bytes that the values need.
std::uint64_t bytes_of(const FeatureProperty& property);

// A property table of EXT_structural_metadata, with its schema (CesiumGS, 3D Metadata
// Specification: binary table format).
struct PropertyTable {
  nlohmann::json extension;  // EXT_structural_metadata of the file
  // The contents of the buffer views that the extension uses. The first has the index `first_view`.
  std::vector<std::vector<std::uint8_t>> views;
};

// Creates the property table of `count` features, which is at least 1. All properties have `count`
// values.
//
// - Numbers are FLOAT64. A missing number is kNoNumber, the `noData` of the property.
// - Flags are BOOLEAN. If one is missing, they are an ENUM of `false` and `true`.
// - Texts are STRING. A missing text is empty, the `noData` of the property.
// - Choices are an ENUM. The name of the value for a missing choice is "No data", the `noData` of
//   the property.
//
// A property without any value is omitted. Names become valid and unique identifiers. The readable
// name of a property is its title. Without a title, it is the name, with the identifier if that
// differs. The description contains the unit.
PropertyTable property_table(const std::string& name, std::size_t count,
                             const std::vector<FeatureProperty>& properties,
                             std::size_t first_view);

constexpr double kNoNumber = -1.7976931348623157e308;  // the lowest double

}  // namespace strata::mesh
