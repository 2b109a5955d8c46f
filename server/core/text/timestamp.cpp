#include "core/text/timestamp.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "core/text/edtf.h"

namespace strata {
namespace {

std::optional<int> two_digits(std::string_view text, std::size_t at) {
  if (at + 2 > text.size()) return std::nullopt;
  const char tens = text[at], ones = text[at + 1];
  if (tens < '0' || tens > '9' || ones < '0' || ones > '9') return std::nullopt;
  return (tens - '0') * 10 + ones - '0';
}

struct CivilDate {
  int year = 0, month = 0, day = 0;
};
// The inverse of day_number by Howard Hinnant, for days from year 0.
CivilDate civil_date(std::int64_t day) {
  day += 719468;
  const std::int64_t era = day / 146097;
  const std::int64_t of_era = day - era * 146097;
  const std::int64_t year_of_era =
      (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  const std::int64_t of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t shifted = (5 * of_year + 2) / 153;
  const int month = static_cast<int>(shifted < 10 ? shifted + 3 : shifted - 9);
  return {static_cast<int>(year_of_era + era * 400 + (month <= 2 ? 1 : 0)), month,
          static_cast<int>(of_year - (153 * shifted + 2) / 5 + 1)};
}

}  // namespace

std::optional<std::int64_t> day_of(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return std::nullopt;
  const auto century = two_digits(text, 0), of_century = two_digits(text, 2),
             month = two_digits(text, 5), day = two_digits(text, 8);
  if (!century || !of_century || !month || !day) return std::nullopt;
  const int year = *century * 100 + *of_century;
  if (year < 1 || *month < 1 || *month > 12 || *day < 1 || *day > days_in_month(year, *month))
    return std::nullopt;
  return day_number(year, *month, *day);
}

std::optional<std::string> utc_timestamp(std::string_view text) {
  const auto day = day_of(text.substr(0, 10));
  if (!day) return std::nullopt;
  std::int64_t milliseconds = *day * 86'400'000;
  text.remove_prefix(10);
  if (!text.empty()) {
    const auto hour = two_digits(text, 1), minute = two_digits(text, 4);
    if ((text[0] != 'T' && text[0] != 't' && text[0] != ' ') || !hour || !minute ||
        text[3] != ':' || *hour > 23 || *minute > 59)
      return std::nullopt;
    milliseconds += (*hour * 60 + *minute) * 60'000;
    text.remove_prefix(6);
    if (text.starts_with(':')) {
      const auto second = two_digits(text, 1);
      if (!second || *second > 59) return std::nullopt;
      milliseconds += *second * 1000;
      text.remove_prefix(3);
      if (text.starts_with('.')) {
        text.remove_prefix(1);
        int worth = 100;
        std::size_t digits = 0;
        for (; digits < text.size() && text[digits] >= '0' && text[digits] <= '9';
             ++digits, worth /= 10)
          milliseconds += (text[digits] - '0') * worth;
        if (digits == 0 || digits > 9) return std::nullopt;
        text.remove_prefix(digits);
      }
    }
    if (text.starts_with('+') || text.starts_with('-')) {
      const auto hours = two_digits(text, 1), minutes = two_digits(text, 4);
      if (text.size() != 6 || text[3] != ':' || !hours || !minutes || *hours > 23 || *minutes > 59)
        return std::nullopt;
      milliseconds -= (text[0] == '+' ? 1 : -1) * (*hours * 60 + *minutes) * 60'000;
    } else if (!text.empty() && text != "Z" && text != "z") {
      return std::nullopt;
    }
  }
  const std::int64_t first = day_number(1, 1, 1) * 86'400'000,
                     end = day_number(10000, 1, 1) * 86'400'000;
  if (milliseconds < first || milliseconds >= end) return std::nullopt;
  const std::int64_t since = milliseconds - first;  // not negative
  const CivilDate date = civil_date(since / 86'400'000 + first / 86'400'000);
  const int of_day = static_cast<int>(since % 86'400'000);
  char out[40];
  std::snprintf(out, sizeof out, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", date.year, date.month,
                date.day, of_day / 3'600'000, of_day / 60'000 % 60, of_day / 1000 % 60,
                of_day % 1000);
  return out;
}

std::optional<std::chrono::system_clock::time_point> parse_time(std::string_view text,
                                                                UnzonedTime unzoned) {
  const auto utc = utc_timestamp(text);
  if (!utc) return std::nullopt;
  std::tm civil{};
  int milliseconds = 0;
  std::sscanf(utc->c_str(), "%d-%d-%dT%d:%d:%d.%dZ", &civil.tm_year, &civil.tm_mon, &civil.tm_mday,
              &civil.tm_hour, &civil.tm_min, &civil.tm_sec, &milliseconds);
  civil.tm_year -= 1900;
  civil.tm_mon -= 1;
  civil.tm_isdst = -1;  // mktime determines whether daylight saving time applies
  const bool has_zone = text.size() > 10 && text.find_first_of("Zz+-", 10) != text.npos;
  const std::time_t seconds =
      has_zone || unzoned == UnzonedTime::utc ? timegm(&civil) : std::mktime(&civil);
  using Clock = std::chrono::system_clock;
  // The clock counts nanoseconds, and cannot represent times before 1678 and after 2261. Such
  // times are clamped to this range.
  constexpr auto kLast = std::chrono::floor<std::chrono::seconds>(Clock::time_point::max());
  constexpr auto kFirst = std::chrono::ceil<std::chrono::seconds>(Clock::time_point::min());
  const auto time = std::clamp(std::chrono::sys_seconds(std::chrono::seconds(seconds)), kFirst,
                               kLast - std::chrono::seconds(1));
  return time + std::chrono::milliseconds(milliseconds);
}

std::string utc_text(std::chrono::system_clock::time_point time) {
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  const std::time_t seconds = static_cast<std::time_t>(
      milliseconds >= 0 ? milliseconds / 1000 : (milliseconds - 999) / 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[40];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text + length, sizeof text - length, ".%03dZ",
                static_cast<int>(milliseconds - std::int64_t{seconds} * 1000));
  return text;
}

}  // namespace strata
