#include "core/text/edtf.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "core/text/utf8.h"

namespace strata {
namespace {

constexpr std::int64_t kMaxYear = 999'999'999;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<std::int64_t> number_of(std::string_view digits) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (digits.empty() || !is_digit(digits[0]) || error != std::errc() ||
      end != digits.data() + digits.size())
    return std::nullopt;
  return number;
}

struct Span {
  std::int64_t first = 0, last = 0;  // both inclusive
};

// Returns the years of a text such as `156X`, where the digits at the right are unknown. At least
// one digit must be known.
std::optional<Span> years_of(std::string_view digits, bool negative) {
  std::size_t known = digits.find('X');
  if (known == std::string_view::npos) known = digits.size();
  if (known == 0 || digits.substr(known).find_first_not_of('X') != std::string_view::npos)
    return std::nullopt;
  const auto head = number_of(digits.substr(0, known));
  if (!head) return std::nullopt;
  Span years{*head, *head};
  for (std::size_t i = known; i < digits.size(); ++i) {
    years.first *= 10;
    years.last = years.last * 10 + 9;
  }
  return negative ? Span{-years.last, -years.first} : years;
}

Span days_of_month(std::int64_t year, int month) {
  return {day_number(year, month, 1), day_number(year, month, days_in_month(year, month))};
}

// Returns the three months that begin with `month`. Winter ends in the next year.
Span days_of_season(std::int64_t year, int month) {
  const bool turns = month > 10;
  return {day_number(year, month, 1),
          days_of_month(year + (turns ? 1 : 0), turns ? month - 10 : month + 2).last};
}

// Returns the days of a date that has no qualifier.
std::optional<Span> days_of_date(std::string_view text) {
  const bool many_digits = text.starts_with('Y');
  if (many_digits) text.remove_prefix(1);
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (many_digits) {
    const auto year = number_of(text);
    if (!year || text.size() < 5 || text[0] == '0' || *year > kMaxYear) return std::nullopt;
    const std::int64_t signed_year = negative ? -*year : *year;
    return Span{day_number(signed_year, 1, 1), day_number(signed_year, 12, 31)};
  }
  if (text.size() < 4) return std::nullopt;
  const auto years = years_of(text.substr(0, 4), negative);
  if (!years || (negative && text.substr(0, 4) == "0000")) return std::nullopt;
  const bool one_year = years->first == years->last;
  text.remove_prefix(4);
  if (text.empty()) return Span{day_number(years->first, 1, 1), day_number(years->last, 12, 31)};
  if (text[0] != '-' || text.size() < 3) return std::nullopt;
  const std::string_view month_text = text.substr(1, 2);
  const std::string_view rest = text.substr(3);
  if (month_text == "XX") {  // 1560-XX, 156X-XX, 1560-XX-XX
    if (!rest.empty() && rest != "-XX") return std::nullopt;
    return Span{day_number(years->first, 1, 1), day_number(years->last, 12, 31)};
  }
  const auto month = number_of(month_text);
  if (!month || !one_year) return std::nullopt;
  const std::int64_t year = years->first;
  if (*month >= 21 && *month <= 24 && rest.empty())
    return days_of_season(year, static_cast<int>(*month - 20) * 3);
  if (*month < 1 || *month > 12) return std::nullopt;
  const Span days = days_of_month(year, static_cast<int>(*month));
  if (rest.empty() || rest == "-XX") return days;
  if (rest.size() != 3 || rest[0] != '-') return std::nullopt;
  const auto day = number_of(rest.substr(1));
  if (!day || *day < 1 || *day > days_in_month(year, static_cast<int>(*month))) return std::nullopt;
  return Span{days.first + *day - 1, days.first + *day - 1};
}

std::optional<Span> read_date(std::string_view text, Period& period) {
  if (text.empty()) return std::nullopt;
  const char mark = text.back();
  if (mark == '?' || mark == '~' || mark == '%') {
    period.uncertain |= mark != '~';
    period.approximate |= mark != '?';
    text.remove_suffix(1);
  }
  return days_of_date(text);
}

}  // namespace

// Source: Howard Hinnant, "chrono-compatible low-level date algorithms". In this algorithm, years
// begin in March, and eras have 400 years.
std::int64_t day_number(std::int64_t year, int month, int day) {
  if (month <= 2) --year;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year -
         719468;
}

int days_in_month(std::int64_t year, int month) {
  if (month == 2) return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
}

Result<Period> parse_edtf(std::string_view text) {
  const auto refuse = [&] {
    return fail(ErrorCode::invalid, "Invalid date",
                "\"" + mended_utf8(text.substr(0, kMaxPeriod)) +
                    "\" is not a valid EDTF date. Valid dates are, for example, 1560, 1560~, 156X, "
                    "1560-04-12, -0043, 1560/1580 or 1560/..",
                {});
  };
  if (text.empty() || text.size() > kMaxPeriod) return refuse();
  Period period;
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) {
    const auto days = read_date(text, period);
    if (!days) return refuse();
    period.first_day = days->first;
    period.last_day = days->last;
    return period;
  }
  const std::string_view begin = text.substr(0, slash), end = text.substr(slash + 1);
  const auto is_missing = [](std::string_view side) { return side.empty() || side == ".."; };
  if (is_missing(begin) && is_missing(end)) return refuse();
  std::optional<Span> first, last;
  if (!is_missing(begin) && !(first = read_date(begin, period))) return refuse();
  if (!is_missing(end) && !(last = read_date(end, period))) return refuse();
  if (first && last && first->first > last->last) return refuse();
  if (first) period.first_day = first->first;
  if (last) period.last_day = last->last;
  return period;
}

}  // namespace strata
