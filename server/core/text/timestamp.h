#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strata {

// Returns the day number (edtf.h) of YYYY-MM-DD from year 1 on, the common range of databases and
// spreadsheets. Earlier days are periods.
std::optional<std::int64_t> day_of(std::string_view text);

// Converts RFC 3339 to UTC with milliseconds. Accepts a space instead of the T, absent seconds, and
// a day alone, which means its midnight in UTC. Without a zone the time is UTC. Returns nothing
// outside the years 1 to 9999.
std::optional<std::string> utc_timestamp(std::string_view text);

// RFC 3339 in UTC, with milliseconds.
std::string utc_text(std::chrono::system_clock::time_point time);

}  // namespace strata
