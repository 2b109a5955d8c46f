#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace strata {

// Returns the days since 1970-01-01 in the proleptic Gregorian calendar with a year 0. (ISO 8601:
// year 0 is 1 BC, year -1 is 2 BC.)
std::int64_t day_number(std::int64_t year, int month, int day);
int days_in_month(std::int64_t year, int month);

// The possible days of an EDTF text, and how certain they are.
struct Period {
  // nullopt if the period is open or unknown on that side.
  std::optional<std::int64_t> first_day, last_day;
  bool approximate = false;  // ~ or %
  bool uncertain = false;    // ? or %
  bool operator==(const Period&) const = default;
};

inline constexpr std::size_t kMaxPeriod = 64;  // bytes

// Parses the Extended Date/Time Format (ISO 8601-2:2019), levels 0 and 1 without times of the day.
// Dates are `1985`, `1985-04`, `1985-04-12`, seasons `2001-21` (spring) … `-24` (December to
// February), longer years `Y-17000`, and `-0043`, `156X`, `1560-XX`, `1560-12-XX`. `?`, `~` or `%`
// may follow a date. Intervals are `A/B`, with `..` for an open end and no text for an unknown end.
// An approximate date has the same days as an exact date, because "circa" has no defined range.
Result<Period> parse_edtf(std::string_view text);

}  // namespace strata
