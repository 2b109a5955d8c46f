#include "bill/formula.h"

#include <gtest/gtest.h>

namespace strata::bill {
namespace {

std::string result_of(std::string_view formula) {
  const auto value = compute_formula(formula, "formula");
  return value ? value->short_text(6) : "error: " + value.error().title;
}

TEST(Formula, computes_lines_of_a_measurement_sheet) {
  EXPECT_EQ(result_of("2 * 1,20 * 0,85"), "2.04");
  EXPECT_EQ(result_of("2*1.20*0.85="), "2.04");
  EXPECT_EQ(result_of("(3,50 + 2,25) x 2,40 - 1,01 × 2,01"), "11.7699");
  EXPECT_EQ(result_of("1/2 : 4"), "0.125");
  EXPECT_EQ(result_of("3,5² * 2"), "24.5");
  EXPECT_EQ(result_of("2^3 - 2³"), "0");
  EXPECT_EQ(result_of("-(1 - 3)"), "2");
  EXPECT_EQ(result_of("--4"), "4");
  EXPECT_EQ(result_of("12,5"), "12.5");
  EXPECT_EQ(result_of("2 - 1 - 1"), "0");
  EXPECT_EQ(result_of("1/3 + 1/3 + 1/3"), "1");
}

TEST(Formula, names_the_place_of_a_mistake) {
  const auto value = compute_formula("2 * (1,20 + ) * 2", "items[0].formula");
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().code, ErrorCode::invalid);
  EXPECT_EQ(value.error().field, "items[0].formula");
  EXPECT_EQ(value.error().offset, 12U);
}

TEST(Formula, refuses_everything_else) {
  for (const char* wrong : {"", "=", "2 *", "(2", "2)", "1.200,50", "sqrt(2)", "2 2", "A1", "2^-1",
                            "2^99", "=2", "1;2", "2**3"})
    EXPECT_TRUE(result_of(wrong).starts_with("error: Formula not readable")) << wrong;
  EXPECT_EQ(result_of("1/0"), "error: Formula has no exact result");
  EXPECT_EQ(result_of("9999999999^9"), "error: Formula has no exact result");
  EXPECT_EQ(result_of(std::string(501, '1')), "error: Formula too long");
  EXPECT_TRUE(result_of(std::string(200, '(') + "1").starts_with("error"));
  EXPECT_TRUE(result_of(std::string(400, '-') + "1").starts_with("error"));
}

}  // namespace
}  // namespace strata::bill
