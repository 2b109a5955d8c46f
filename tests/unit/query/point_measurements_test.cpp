#include "query/maps/point_measurements.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace strata::query {
namespace {

TEST(PointMeasurements, are_read_by_the_names_of_their_columns) {
  for (const std::string text :
       {"x,y,z,value\n1,2,3,0.5\n-4e2,+5,6.25,7\n",
        "Value;note;Z;Y;X\n0.5;a;3;2;1\r\n\r\n7;;6.25;5;-400\r\n",
        "\xef\xbb\xbfid\tX\tY\tZ\tVALUE\n1\t\"1\"\t 2 \t3\t0.5\n2\t-400\t5\t6.25\t7"}) {
    const auto measurements = parse_point_measurements(text);
    ASSERT_TRUE(measurements) << text << measurements.error().detail;
    ASSERT_EQ(measurements->size(), 2u);
    EXPECT_EQ((*measurements)[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ((*measurements)[0].value, 0.5);
    EXPECT_EQ((*measurements)[1].position, glm::dvec3(-400, 5, 6.25));
    EXPECT_EQ((*measurements)[1].value, 7);
  }
}

TEST(PointMeasurements, that_cannot_be_read_are_refused_with_the_line) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "a first line with"},
      {"\n\n  \n", "a first line with"},
      {"x,y,z,value\n", "a first line with"},
      {"1,2,3,4\n", "Line 1: there is no column 'x'"},
      {"x,y,z\n1,2,3\n", "Line 1: there is no column 'value'"},
      {"x,y,z,value\n1,2,3\n", "Line 2: it has 3 fields"},
      {"x,y,z,value\n1,2,3,4,5\n", "Line 2: it has 5 fields"},
      {"x,y,z,value\n\n1,2,three,4\n", "Line 3: the column 'z'"},
      {"x,y,z,value\n1,2,,4\n", "the column 'z'"},
      {"x,y,z,value\n1,2,nan,4\n", "the column 'z'"},
      {"x,y,z,value\n1,2,3,inf\n", "the column 'value'"},
      {"x,y,z,value\n1,2,3,1e999\n", "the column 'value'"},
      {"x,y,z,value\n1,2,3,4 mm\n", "the column 'value'"},
      {"x;y;z;value\n1,5;2;3;4\n", "the column 'x'"},
      {std::string("x,y,z,value\n1,2,3,4\0\n", 21), "the column 'value'"},
  };
  for (const auto& [text, says] : cases) {
    const auto measurements = parse_point_measurements(text);
    ASSERT_FALSE(measurements) << text;
    EXPECT_EQ(measurements.error().code, ErrorCode::invalid);
    EXPECT_THAT(measurements.error().detail, testing::HasSubstr(says)) << text;
  }
  std::string many = "x,y,z,value\n";
  for (std::size_t i = 0; i <= kMaxPointMeasurements; ++i) many += "1,2,3,4\n";
  EXPECT_THAT(parse_point_measurements(many).error().detail,
              testing::HasSubstr("more than 100000"));
}

}  // namespace
}  // namespace strata::query
