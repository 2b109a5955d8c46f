#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::query {

constexpr std::size_t kMaxPointMeasurements = 100'000;

// A value measured at a place.
struct PointMeasurement {
  glm::dvec3 position;  // world
  double value = 0;
  int line = 0;  // of the text, from 1
};

// Reads a table of measurements. The first line names the columns: x, y, z and value, in any order
// and case; others are skipped. Columns are separated by commas, semicolons or tabs, numbers have a
// decimal point; quotes around a field are removed; empty lines are skipped. Refused (invalid with
// the line): a missing column, a field that is not a finite number, lines with another number of
// fields, no measurement at all, more than kMaxPointMeasurements.
Result<std::vector<PointMeasurement>> parse_point_measurements(std::string_view csv);

}  // namespace strata::query
