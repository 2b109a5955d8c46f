#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "domain/tables/table.h"

namespace strata {

inline constexpr std::size_t kMaxTextLength = 100'000;  // bytes of a text
inline constexpr std::size_t kMaxRelated = 10'000;      // keys of a relation
inline constexpr std::size_t kMaxAttached = 1000;       // files in one cell
// Every JSON parser represents the whole numbers up to this limit exactly.
inline constexpr std::int64_t kGreatestInteger = 1ll << 53;

// Returns `value` in the stored form of the column. Returns an error (invalid, at `field`) for
// another JSON type, an invalid date, a number outside the limits of the column, or an unknown
// choice. Null means no value, and only a required column refuses it. Normalizes timestamps to UTC,
// sorts the keys of a relation, and removes repeated keys and attachments. The store checks that
// the keys and attachments exist.
Result<nlohmann::json> check_value(const Column& column, const nlohmann::json& value,
                                   const std::string& field);

// Parses a CSV cell. An empty cell is null. The keys of a relation are separated by spaces or
// semicolons. Booleans are true/false, yes/no or 1/0. With `decimal_comma`, as in files with
// semicolons between the cells, 3,5 is also a number.
Result<nlohmann::json> parse_value(const Column& column, std::string_view text, bool decimal_comma,
                                   const std::string& field);

// Returns the CSV cell for a value from check_value. parse_value restores the value.
std::string print_value(const Column& column, const nlohmann::json& value);

// Converts a value to another kind of column through its text. The time of day of a timestamp is
// dropped for a date or a period. Returns an error if the text is not valid for the new kind.
Result<nlohmann::json> convert_value(const Column& from, const Column& to,
                                     const nlohmann::json& value, const std::string& field);

}  // namespace strata
