#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/messages.h"

namespace strata::bill {

// A rational number without rounding errors, for sums and prices that other programs must be able
// to recompute. The numerator and the denominator have 127 bits. The result of an operation that
// does not fit, or of a division by zero, is not valid. Neither are results that are computed from
// it.
class ExactNumber {
 public:
  constexpr ExactNumber() = default;
  constexpr explicit ExactNumber(std::int64_t value) : numerator_(value) {}

  // Reads a decimal number with a point or a comma: "12,35". Accepts at most 30 digits.
  static std::optional<ExactNumber> parse(std::string_view text);
  // Returns a measured value, rounded to kMeasuredPlaces. Not valid if it is not finite or its
  // amount is 1e15 or more.
  static ExactNumber measured(double value);
  static constexpr int kMeasuredPlaces = 6;

  bool is_valid() const { return denominator_ != 0; }
  bool is_negative() const { return numerator_ < 0; }

  ExactNumber operator-() const;
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) { return a + -b; }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator/(const ExactNumber& a, const ExactNumber& b);
  ExactNumber& operator+=(const ExactNumber& other) { return *this = *this + other; }
  // Numbers that are not valid are equal to each other and less than others.
  friend bool operator==(const ExactNumber& a, const ExactNumber& b) = default;
  friend bool operator<(const ExactNumber& a, const ExactNumber& b);

  // Rounds to a number of decimal places from 0 to 12.
  ExactNumber rounded(int places,
                      protocol::BillRoundingMode mode = protocol::BillRoundingMode::half_up) const;
  // Returns the number with a point and this number of decimal places, rounded half up: "2.50".
  std::string text(int places) const;
  // Returns the number with at most `places` decimal places, without zeros at the end: "2.5".
  std::string short_text(int places = kMeasuredPlaces) const;
  double approximate() const;

 private:
  using Wide = __int128;
  ExactNumber(Wide numerator, Wide denominator);
  static constexpr ExactNumber invalid() {
    ExactNumber number;
    number.denominator_ = 0;
    return number;
  }

  Wide numerator_ = 0, denominator_ = 1;  // without common factors; the denominator is not negative
};

}  // namespace strata::bill
