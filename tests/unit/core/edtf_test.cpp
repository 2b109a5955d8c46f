// Periods: the days of EDTF texts, compared with days that are counted one by one.
#include <gtest/gtest.h>

#include "core/text/edtf.h"

namespace strata {
namespace {

Period period(std::string_view text) {
  const auto parsed = parse_edtf(text);
  EXPECT_TRUE(parsed.has_value()) << text;
  return parsed.value_or(Period{});
}

void expect_days(std::string_view text, std::int64_t first, std::int64_t last) {
  const Period got = period(text);
  EXPECT_EQ(got.first_day, first) << text;
  EXPECT_EQ(got.last_day, last) << text;
}

TEST(Edtf, day_numbers_count_the_days_of_the_calendar) {
  EXPECT_EQ(day_number(1970, 1, 1), 0);
  EXPECT_EQ(day_number(2000, 3, 1), 11017);
  EXPECT_EQ(day_number(1, 1, 1), -719162);
  std::int64_t expected = day_number(-401, 1, 1);
  for (std::int64_t year = -401; year <= 401; ++year)
    for (int month = 1; month <= 12; ++month)
      for (int day = 1; day <= days_in_month(year, month); ++day)
        ASSERT_EQ(day_number(year, month, day), expected++);
}

TEST(Edtf, a_date_means_all_of_its_days) {
  expect_days("1985", day_number(1985, 1, 1), day_number(1985, 12, 31));
  expect_days("1984-02", day_number(1984, 2, 1), day_number(1984, 2, 29));
  expect_days("1985-04-12", day_number(1985, 4, 12), day_number(1985, 4, 12));
  expect_days("-0043-03-15", day_number(-43, 3, 15), day_number(-43, 3, 15));
  expect_days("0000", day_number(0, 1, 1), day_number(0, 12, 31));
  expect_days("Y-17000", day_number(-17000, 1, 1), day_number(-17000, 12, 31));
  expect_days("Y170002", day_number(170002, 1, 1), day_number(170002, 12, 31));
}

TEST(Edtf, seasons_are_three_months) {
  expect_days("2001-21", day_number(2001, 3, 1), day_number(2001, 5, 31));
  expect_days("2001-23", day_number(2001, 9, 1), day_number(2001, 11, 30));
  expect_days("2003-24", day_number(2003, 12, 1), day_number(2004, 2, 29));
}

TEST(Edtf, unknown_digits_widen_a_date) {
  expect_days("156X", day_number(1560, 1, 1), day_number(1569, 12, 31));
  expect_days("15XX", day_number(1500, 1, 1), day_number(1599, 12, 31));
  expect_days("-01XX", day_number(-199, 1, 1), day_number(-100, 12, 31));
  expect_days("1560-XX", day_number(1560, 1, 1), day_number(1560, 12, 31));
  expect_days("1560-02-XX", day_number(1560, 2, 1), day_number(1560, 2, 29));
  expect_days("1560-XX-XX", day_number(1560, 1, 1), day_number(1560, 12, 31));
}

TEST(Edtf, marks_tell_how_sure_a_date_is) {
  EXPECT_TRUE(period("1560~").approximate);
  EXPECT_FALSE(period("1560~").uncertain);
  EXPECT_TRUE(period("1560?").uncertain);
  EXPECT_TRUE(period("1560-04%").approximate && period("1560-04%").uncertain);
  expect_days("1560~", day_number(1560, 1, 1), day_number(1560, 12, 31));
  EXPECT_TRUE(period("1560/1580~").approximate);
}

TEST(Edtf, intervals_may_be_open_or_unknown_at_an_end) {
  expect_days("1560/1580-06", day_number(1560, 1, 1), day_number(1580, 6, 30));
  expect_days("-0200~/0100", day_number(-200, 1, 1), day_number(100, 12, 31));
  EXPECT_EQ(period("1560/.."), (Period{day_number(1560, 1, 1), {}}));
  EXPECT_EQ(period("1560/"), (Period{day_number(1560, 1, 1), {}}));
  EXPECT_EQ(period("../1560"), (Period{{}, day_number(1560, 12, 31)}));
  EXPECT_EQ(period("/1560"), (Period{{}, day_number(1560, 12, 31)}));
  expect_days("1560/1560", day_number(1560, 1, 1), day_number(1560, 12, 31));
}

TEST(Edtf, what_is_no_period_is_refused_with_examples) {
  for (const char* text : {"",           " ",         "circa 1560",  "156",
                           "15600",      "1560-13",   "1560-00",     "1561-02-29",
                           "1560-4",     "1560-04-1", "1560-04-31",  "X560",
                           "1X60",       "XXXX",      "156X-04",     "-0000",
                           "Y1560",      "Y0001560",  "Y9999999999", "1580/1560",
                           "/",          "../..",     "/..",         "1560/1570/1580",
                           "1560~?",     "1560-25",   "1560-21-01",  "1560-XX-04",
                           "1560T12:00", "--156",     "1560-04-12Z", "1560 / 1570",
                           "\xff\xfe"}) {
    const auto parsed = parse_edtf(text);
    ASSERT_FALSE(parsed.has_value()) << text;
    EXPECT_EQ(parsed.error().code, ErrorCode::invalid);
    EXPECT_NE(parsed.error().detail.find("1560/.."), std::string::npos);
  }
}

}  // namespace
}  // namespace strata
