#include "bill/exact_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace strata::bill {
namespace {

using Mode = protocol::BillRoundingMode;

ExactNumber number(std::string_view text) { return ExactNumber::parse(text).value(); }

TEST(ExactNumber, reads_decimal_numbers_with_a_point_or_a_comma) {
  EXPECT_EQ(number("12,35").text(2), "12.35");
  EXPECT_EQ(number("-0.5").text(1), "-0.5");
  EXPECT_EQ(number("007").short_text(), "7");
  for (const char* wrong : {"", "-", ".", ",5", "5,", "1.2.3", "1,2.3", "1e3", " 1", "+1", "abc"})
    EXPECT_FALSE(ExactNumber::parse(wrong)) << wrong;
}

TEST(ExactNumber, sums_have_no_binary_error) {
  ExactNumber sum;
  for (int i = 0; i < 10'000; ++i) sum += number("0.1");
  EXPECT_EQ(sum, ExactNumber(1000));
}

TEST(ExactNumber, rounds_halves_away_from_zero) {
  EXPECT_EQ(number("2.345").rounded(2).text(2), "2.35");
  EXPECT_EQ(number("-2.345").rounded(2).text(2), "-2.35");
  EXPECT_EQ(number("2.3449").rounded(2).text(2), "2.34");
  EXPECT_EQ(number("1.005").rounded(2).text(2), "1.01");  // 1.00 in binary
}

TEST(ExactNumber, rounds_the_amount_up_or_down) {
  EXPECT_EQ(number("2.301").rounded(1, Mode::up).text(1), "2.4");
  EXPECT_EQ(number("2.3").rounded(1, Mode::up).text(1), "2.3");
  EXPECT_EQ(number("-2.301").rounded(1, Mode::up).text(1), "-2.4");
  EXPECT_EQ(number("2.399").rounded(1, Mode::down).text(1), "2.3");
  EXPECT_EQ(number("-2.399").rounded(1, Mode::down).text(1), "-2.3");
}

TEST(ExactNumber, divides_without_rounding) {
  const ExactNumber third = ExactNumber(1) / ExactNumber(3);
  EXPECT_EQ(third + third + third, ExactNumber(1));
  EXPECT_EQ(third.text(6), "0.333333");
}

TEST(ExactNumber, results_that_do_not_fit_are_not_valid) {
  EXPECT_FALSE((ExactNumber(1) / ExactNumber(0)).is_valid());
  ExactNumber large(1'000'000'000'000);
  large = large * large * large * large;
  EXPECT_FALSE(large.is_valid());
  EXPECT_FALSE((large + ExactNumber(1)).is_valid());
  EXPECT_FALSE((-large).is_valid());
  EXPECT_FALSE(large.rounded(2).is_valid());
  EXPECT_FALSE(ExactNumber::measured(std::nan("")).is_valid());
  EXPECT_FALSE(ExactNumber::measured(std::numeric_limits<double>::infinity()).is_valid());
}

TEST(ExactNumber, measured_values_have_six_places) {
  EXPECT_EQ(ExactNumber::measured(0.1).short_text(), "0.1");
  EXPECT_EQ(ExactNumber::measured(1.23456789).text(8), "1.23456800");
  EXPECT_EQ(ExactNumber::measured(0), ExactNumber(0));
}

TEST(ExactNumber, compares_by_value) {
  EXPECT_EQ(number("2.50"), number("2.5"));
  EXPECT_TRUE(number("2.49") < number("2.5"));
  EXPECT_FALSE(number("2.5") < number("2.5"));
  EXPECT_TRUE(number("-1") < number("0"));
}

}  // namespace
}  // namespace strata::bill
