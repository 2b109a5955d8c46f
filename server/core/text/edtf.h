#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace strata {

// Days since 1970-01-01 in the proleptic Gregorian calendar with a year 0 (ISO 8601: year 0 is 1
// BC, -1 is 2 BC).
std::int64_t day_number(std::int64_t year, int month, int day);
int days_in_month(std::int64_t year, int month);

// The meaning of an EDTF text: the possible days, and how certain they are.
struct Period {
  std::optional<std::int64_t> first_day, last_day;  // nothing: open or unknown on that side
  bool approximate = false;                         // ~ or %
  bool uncertain = false;                           // ? or %
  bool operator==(const Period&) const = default;
};

inline constexpr std::size_t kMaxPeriod = 64;  // bytes

// Extended Date/Time Format (ISO 8601-2:2019), levels 0 and 1 without times of the day: `1985`,
// `1985-04`, `1985-04-12`, seasons `2001-21` (spring) … `-24` (December to February), years of more
// digits `Y-17000`, `-0043`, `156X`, `1560-XX`, `1560-12-XX`, each optionally followed by `?`, `~`
// or `%`; and intervals `A/B` of them, with `..` for an open end and an empty one for an unknown
// end. An approximate date has the days that it names, since the reach of "circa" is undefined.
Result<Period> parse_edtf(std::string_view text);

}  // namespace strata
