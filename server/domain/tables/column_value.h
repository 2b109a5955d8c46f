#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "domain/tables/table.h"

namespace strata {

inline constexpr std::size_t kMaxTextLength = 100'000;  // bytes of a text
inline constexpr std::size_t kMaxRelated = 10'000;      // keys of a relation
inline constexpr std::size_t kMaxAttached = 1000;       // files in one cell
// what every reader of JSON keeps exactly
inline constexpr std::int64_t kGreatestInteger = 1ll << 53;

// `value` as the column keeps it, or an Error (invalid) that names `field`: another type of JSON, a
// date that is none, a number outside of the column's limits, what is no choice. Null is no value,
// which only a required column refuses. Forms are made one: timestamps come out in UTC, keys of a
// relation ascending and once, attachments once. Whether keys have records, and ids attachments, is
// the store's to say.
Result<nlohmann::json> check_value(const Column& column, const nlohmann::json& value,
                                   const std::string& field);

// The value that a text means, as cells of CSV have it: empty is none, keys of a relation stand
// with spaces or semicolons between them, booleans are true/false, yes/no or 1/0. With
// `decimal_comma`, as where semicolons separate the cells, 3,5 is a number, too.
Result<nlohmann::json> parse_value(const Column& column, std::string_view text, bool decimal_comma,
                                   const std::string& field);

// The cell of CSV for a value that check_value gave; parse_value makes the same value of it.
std::string print_value(const Column& column, const nlohmann::json& value);

// The value of a column in another kind's column: by its text, except where one has less to say
// (timestamp to date, whole numbers). An Error where it cannot be kept.
Result<nlohmann::json> convert_value(const Column& from, const Column& to,
                                     const nlohmann::json& value, const std::string& field);

}  // namespace strata
