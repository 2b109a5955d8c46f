#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strata {

// Returns the day number (edtf.h) of YYYY-MM-DD from year 1, the range that databases and
// spreadsheets support. Earlier days can be stored as periods.
std::optional<std::int64_t> day_of(std::string_view text);

// Converts RFC 3339 to UTC with milliseconds. Accepts a space instead of the T, a time without
// seconds, and a day without a time (midnight in UTC). A time without a zone is in UTC. Returns
// nullopt outside the years 1 to 9999.
std::optional<std::string> utc_timestamp(std::string_view text);

// Parses the texts that utc_timestamp accepts. `unzoned` is the zone of a time without a zone: UTC
// or the zone of this machine.
enum class UnzonedTime { utc, local };
std::optional<std::chrono::system_clock::time_point> parse_time(
    std::string_view text, UnzonedTime unzoned = UnzonedTime::utc);

// Formats a time as RFC 3339 in UTC, with milliseconds.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace strata
