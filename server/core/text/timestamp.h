#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strata {

// The number (edtf.h) of YYYY-MM-DD from year 1 on: what calendars of databases and spreadsheets
// have in common. Earlier days are periods.
std::optional<std::int64_t> day_of(std::string_view text);

// RFC 3339 (also with a space for the T, without seconds, and a mere day, which is its midnight in
// UTC) in UTC; milliseconds are kept. Without a zone it is UTC. Nothing where it leaves the years 1
// to 9999.
std::optional<std::string> utc_timestamp(std::string_view text);

// RFC 3339 in UTC, with milliseconds.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace strata
