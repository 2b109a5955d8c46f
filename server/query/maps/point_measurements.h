#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::query {

constexpr std::size_t kMaxPointMeasurements = 100'000;

// A value measured at a point.
struct PointMeasurement {
  glm::dvec3 position;  // world
  double value = 0;
  int line = 0;  // line number in the text, from 1
};

// Reads a table of measurements. The first line names the columns x, y, z and value, in any order
// and any case; other columns are skipped. Columns are separated by commas, semicolons or tabs.
// Numbers have a decimal point. Quotes around a field are removed, and empty lines are skipped.
// Returns an `invalid` error with the line for a missing column, for a field that is not a finite
// number, and for a line with more or fewer fields than the first line. A text without
// measurements, or with more than kMaxPointMeasurements, is `invalid`, too.
Result<std::vector<PointMeasurement>> parse_point_measurements(std::string_view csv);

}  // namespace strata::query
