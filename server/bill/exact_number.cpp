#include "bill/exact_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace strata::bill {
namespace {

using Wide = __int128;
constexpr double kMaxMeasured = 1e15;
constexpr int kMaxDigits = 30;
constexpr int kMaxPlaces = 12;

Wide amount(Wide value) { return value < 0 ? -value : value; }

Wide common_factor(Wide a, Wide b) {
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

Wide power_of_ten(int exponent) {
  Wide power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

bool multiplied(Wide a, Wide b, Wide& product) { return !__builtin_mul_overflow(a, b, &product); }

}  // namespace

ExactNumber::ExactNumber(Wide numerator, Wide denominator) {
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  const Wide factor = denominator == 0 ? 1 : common_factor(amount(numerator), denominator);
  numerator_ = denominator == 0 ? 0 : numerator / factor;
  denominator_ = denominator / factor;
}

std::optional<ExactNumber> ExactNumber::parse(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  Wide digits = 0;
  int count = 0, places = -1;
  for (const char c : text) {
    if (c == '.' || c == ',') {
      if (places >= 0 || count == 0) return std::nullopt;
      places = 0;
      continue;
    }
    if (c < '0' || c > '9' || ++count > kMaxDigits) return std::nullopt;
    digits = digits * 10 + (c - '0');
    if (places >= 0) ++places;
  }
  if (count == 0 || places == 0) return std::nullopt;
  return ExactNumber(is_negative ? -digits : digits, power_of_ten(std::max(places, 0)));
}

ExactNumber ExactNumber::measured(double value) {
  if (!std::isfinite(value) || std::abs(value) >= kMaxMeasured) return invalid();
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", kMeasuredPlaces, value);
  return parse(text.data()).value_or(invalid());
}

ExactNumber ExactNumber::operator-() const {
  ExactNumber number = *this;
  number.numerator_ = -numerator_;
  return number;
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
  if (!a.is_valid() || !b.is_valid()) return ExactNumber::invalid();
  const Wide factor = common_factor(a.denominator_, b.denominator_);
  Wide left = 0, right = 0, sum = 0, denominator = 0;
  if (!multiplied(a.numerator_, b.denominator_ / factor, left) ||
      !multiplied(b.numerator_, a.denominator_ / factor, right) ||
      !multiplied(a.denominator_, b.denominator_ / factor, denominator) ||
      __builtin_add_overflow(left, right, &sum))
    return ExactNumber::invalid();
  return {sum, denominator};
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
  if (!a.is_valid() || !b.is_valid()) return ExactNumber::invalid();
  const Wide one = common_factor(amount(a.numerator_), b.denominator_),
             other = common_factor(amount(b.numerator_), a.denominator_);
  Wide numerator = 0, denominator = 0;
  if (!multiplied(a.numerator_ / one, b.numerator_ / other, numerator) ||
      !multiplied(a.denominator_ / other, b.denominator_ / one, denominator))
    return ExactNumber::invalid();
  return {numerator, denominator};
}

ExactNumber operator/(const ExactNumber& a, const ExactNumber& b) {
  if (!b.is_valid() || b.numerator_ == 0) return ExactNumber::invalid();
  return a * ExactNumber(b.denominator_, b.numerator_);
}

bool operator<(const ExactNumber& a, const ExactNumber& b) {
  if (!a.is_valid() || !b.is_valid()) return !a.is_valid() && b.is_valid();
  const ExactNumber difference = a - b;
  if (difference.is_valid()) return difference.is_negative();
  return a.approximate() < b.approximate();
}

ExactNumber ExactNumber::rounded(int places, protocol::BillRoundingMode mode) const {
  if (!is_valid()) return *this;
  const Wide scale = power_of_ten(std::clamp(places, 0, kMaxPlaces));
  Wide scaled = 0;
  if (!multiplied(amount(numerator_), scale, scaled)) return invalid();
  Wide units = scaled / denominator_;
  const Wide rest = scaled % denominator_;
  using Mode = protocol::BillRoundingMode;
  const bool is_up =
      mode == Mode::up ? rest > 0 : mode == Mode::half_up && rest >= denominator_ - rest;
  if (is_up) ++units;
  return {numerator_ < 0 ? -units : units, scale};
}

std::string ExactNumber::text(int places) const {
  const ExactNumber number = rounded(places);
  if (!number.is_valid()) return "?";
  const Wide scale = power_of_ten(std::clamp(places, 0, kMaxPlaces));
  Wide units = amount(number.numerator_) * (scale / number.denominator_);
  std::string digits;
  for (int i = 0; units > 0 || i <= places; ++i) {
    if (i == places && places > 0) digits += '.';
    digits += static_cast<char>('0' + static_cast<int>(units % 10));
    units /= 10;
  }
  if (number.is_negative()) digits += '-';
  std::ranges::reverse(digits);
  return digits;
}

std::string ExactNumber::short_text(int places) const {
  std::string shown = text(places);
  if (shown.find('.') == std::string::npos) return shown;
  shown.erase(shown.find_last_not_of('0') + 1);
  if (shown.ends_with('.')) shown.pop_back();
  return shown;
}

double ExactNumber::approximate() const {
  return is_valid() ? static_cast<double>(numerator_) / static_cast<double>(denominator_)
                    : std::nan("");
}

}  // namespace strata::bill
