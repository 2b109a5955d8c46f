#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "domain/tables/table.h"

namespace strata {

inline constexpr std::size_t kMaxTextLength = 100'000;  // bytes of a text
inline constexpr std::size_t kMaxRelated = 10'000;      // keys of a relation
inline constexpr std::size_t kMaxAttached = 1000;       // files in one cell
// the range that every JSON parser represents exactly
inline constexpr std::int64_t kGreatestInteger = 1ll << 53;

// Returns `value` in the column's stored form, or an Error (invalid) that names `field`: another
// JSON type, an invalid date, a number outside the column's limits, an unknown choice. Only a
// required column refuses null, which means no value. Normalizes: timestamps to UTC, keys of a
// relation ascending without repetitions, attachments without repetitions. The store checks that
// keys and attachments exist.
Result<nlohmann::json> check_value(const Column& column, const nlohmann::json& value,
                                   const std::string& field);

// Parses a cell of CSV: an empty one is null, keys of a relation are separated by spaces or
// semicolons, booleans are true/false, yes/no or 1/0. With `decimal_comma`, as for cells separated
// by semicolons, 3,5 is a number, too.
Result<nlohmann::json> parse_value(const Column& column, std::string_view text, bool decimal_comma,
                                   const std::string& field);

// Returns the CSV cell of a value from check_value; parse_value restores the value.
std::string print_value(const Column& column, const nlohmann::json& value);

// Converts a value to another kind of column: through its text, except if the new kind holds less
// (timestamp to date, whole numbers). Error: the value cannot be kept.
Result<nlohmann::json> convert_value(const Column& from, const Column& to,
                                     const nlohmann::json& value, const std::string& field);

}  // namespace strata
