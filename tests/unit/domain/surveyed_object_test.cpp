#include "domain/scene/surveyed_object.h"

#include <gtest/gtest.h>

namespace strata {
namespace {

std::string refused_field(bool has_object, const std::string& date) {
  const auto result = check_survey(has_object, date);
  if (result) return "";
  EXPECT_EQ(result.error().code, ErrorCode::invalid) << date;
  return result.error().field;
}

TEST(SurveyDate, is_a_year_a_month_or_a_day) {
  for (const char* date : {"2019", "0800", "2019-05", "2019-12", "2019-05-01", "2024-02-29"})
    EXPECT_EQ(refused_field(true, date), "") << date;
}

TEST(SurveyDate, other_texts_are_refused) {
  for (const char* date :
       {"19",         "2019-5",    "2019-13",          "2019-00",    "2019-21", "2019-05-32",
        "2023-02-29", "2019-05-1", "20190501",         "2019~",      "201X",    "-2019",
        "-0043-05",   "2019/2020", "2019-05-01T12:00", "2019--05-1", "abcd",    "2019-05-01 ",
        "20190501--", " 2019",     "2019-05-"})
    EXPECT_EQ(refused_field(true, date), "survey_date") << date;
}

TEST(SurveyDate, belongs_to_a_model_of_an_object_and_to_no_other) {
  EXPECT_EQ(refused_field(true, ""), "survey_date");
  EXPECT_EQ(refused_field(false, "2019"), "object");
  EXPECT_EQ(refused_field(false, ""), "");
}

TEST(SurveyDate, may_be_within_a_period_if_a_day_of_both_is_the_same) {
  EXPECT_TRUE(may_be_within("2019-05-01", "", ""));
  EXPECT_TRUE(may_be_within("2019-05-01", "2019", "2019"));
  EXPECT_TRUE(may_be_within("2019-12-31", "2018-03", "2019"));
  EXPECT_TRUE(may_be_within("2019", "2019-05", "2019-06-02"));
  EXPECT_TRUE(may_be_within("2019-05", "2019-05-17", ""));
  EXPECT_FALSE(may_be_within("2019-05-01", "2019-05-02", ""));
  EXPECT_FALSE(may_be_within("2019-05", "", "2019-04-30"));
  EXPECT_FALSE(may_be_within("2018", "2019-05", ""));
  EXPECT_FALSE(may_be_within("2020", "", "2019"));
  EXPECT_FALSE(may_be_within("2019-06", "2020", "2018"));
}

TEST(SurveyDate, of_a_limit_is_checked_like_that_of_a_survey) {
  EXPECT_TRUE(check_survey_date("2019-05", "from"));
  const auto refused = check_survey_date("2019-13", "from");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "from");
}

TEST(SurveyedObject, is_written_with_its_surveys) {
  const SurveyedObject object{7, 1, "Bust", 3, {{5, "bust-2019", "Bust 2019", "2019"}}};
  EXPECT_EQ(to_json(object), nlohmann::json::parse(R"({"id": 7, "name": "Bust", "surveys":
      [{"model": 5, "slug": "bust-2019", "name": "Bust 2019", "date": "2019"}]})"));
}

}  // namespace
}  // namespace strata
