#include "query/maps/point_measurements.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "core/text/ascii.h"

namespace strata::query {
namespace {

constexpr std::array<std::string_view, 4> kColumns{"x", "y", "z", "value"};

std::string_view cell_of(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const auto end = line.find(separator, begin);
    fields.push_back(cell_of(line.substr(begin, end - begin)));
    if (end == std::string_view::npos) return fields;
    begin = end + 1;
  }
}

tl::unexpected<Error> refuse(int line, const std::string& what) {
  return fail(ErrorCode::invalid, "Readings cannot be read",
              "Line " + std::to_string(line) + ": " + what, "body");
}

// Returns the separator in the line with the column names.
char separator_of(std::string_view names) {
  for (const char separator : {'\t', ';', ','})
    if (names.find(separator) != std::string_view::npos) return separator;
  return ',';
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

}  // namespace

Result<std::vector<PointMeasurement>> parse_point_measurements(std::string_view csv) {
  if (csv.starts_with("\xef\xbb\xbf")) csv.remove_prefix(3);
  std::vector<PointMeasurement> measurements;
  std::array<std::size_t, kColumns.size()> column{};
  std::size_t columns = 0;  // 0 until the column names are read
  char separator = ',';
  int line_number = 0;
  for (std::size_t begin = 0; begin < csv.size();) {
    const auto end = std::min(csv.find('\n', begin), csv.size());
    const std::string_view line = csv.substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    if (trimmed(line).empty()) continue;
    if (columns == 0) {
      separator = separator_of(line);
      const auto names = fields_of(line, separator);
      columns = names.size();
      for (std::size_t i = 0; i < kColumns.size(); ++i) {
        const auto found = std::find_if(names.begin(), names.end(),
                                        [&](auto name) { return to_lower(name) == kColumns[i]; });
        if (found == names.end())
          return refuse(line_number,
                        "there is no column '" + std::string(kColumns[i]) +
                            "'. The first line must name the columns x, y, z and value.");
        column[i] = static_cast<std::size_t>(found - names.begin());
      }
      continue;
    }
    const auto fields = fields_of(line, separator);
    if (fields.size() != columns)
      return refuse(line_number, "it has " + std::to_string(fields.size()) +
                                     " fields, but the first line has " + std::to_string(columns) +
                                     ".");
    std::array<double, kColumns.size()> numbers{};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto number = number_of(fields[column[i]]);
      if (!number)
        return refuse(line_number,
                      "the column '" + std::string(kColumns[i]) + "' does not contain a number.");
      numbers[i] = *number;
    }
    if (measurements.size() == kMaxPointMeasurements)
      return refuse(line_number, "there are more than " + std::to_string(kMaxPointMeasurements) +
                                     " readings. Send them in parts.");
    measurements.push_back({{numbers[0], numbers[1], numbers[2]}, numbers[3], line_number});
  }
  if (measurements.empty())
    return fail(ErrorCode::invalid, "No readings",
                "The body contains no readings. Send a first line with the column names x, y, "
                "z and value, and then one line for each reading.",
                "body");
  return measurements;
}

}  // namespace strata::query
