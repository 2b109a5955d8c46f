// Limits by the size of the texels, which requests check before a job.
#include "query/regions/neighborhood_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <regex>
#include <string>
#include <tuple>
#include <vector>

namespace strata::query {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kSizes[] = {1e-6, 0.0313, 0.05, 1, 7.77, 12345};

using Check = std::function<Result<void>(double length, double texel_size)>;

Result<void> focal(double radius, double size) { return check_focal_radius(radius, size, "e"); }
Result<void> line(double width, double size) { return check_line_width(width, size, "e"); }
Result<void> range(double range, double size) {
  return check_interpolation_range(range, size, "e");
}

void expect_refused(const Result<void>& checked, const std::string& field,
                    const std::string& texels) {
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, ErrorCode::invalid);
  EXPECT_EQ(checked.error().field, field);
  EXPECT_THAT(checked.error().detail, testing::HasSubstr(texels));
}

// Returns the numbers before "model units" or "mm" in a message.
std::vector<double> lengths_in(const std::string& detail) {
  const std::regex stated("(?:([0-9.e+-]+) to )?([0-9.e+-]+) (?:model units|mm)");
  std::smatch found;
  std::vector<double> lengths;
  if (!std::regex_search(detail, found, stated)) return lengths;
  for (std::size_t i = 1; i < found.size(); ++i)
    if (found[i].matched) lengths.push_back(std::stod(found[i]));
  return lengths;
}

TEST(NeighborhoodLimits, are_multiples_of_the_size_of_texels) {
  for (const double size : kSizes) {
    EXPECT_TRUE(focal(0, size));
    EXPECT_TRUE(focal(39.99 * size, size));
    EXPECT_TRUE(line(2.001 * size, size));
    EXPECT_TRUE(line(21.99 * size, size));
    EXPECT_TRUE(range(20.01 * size, size));
    EXPECT_TRUE(range(1e300, size));
    EXPECT_TRUE(check_majority_radius(39.99 * size, size, 0.001));
    for (const double texels : {40.01, 1e9, kNotANumber}) {
      expect_refused(focal(texels * size, size), "e", "40 texels");
      expect_refused(check_majority_radius(texels * size, size, 0.001), "radius_mm", "40 texels");
    }
    for (const double texels : {0.0, 1.99, 22.01, kNotANumber})
      expect_refused(line(texels * size, size), "e", "2 to 22 texels");
    for (const double texels : {-30.0, 0.0, 19.99, kNotANumber})
      expect_refused(range(texels * size, size), "e", "20 texels");
  }
}

TEST(NeighborhoodLimits, in_messages_also_hold_for_texels_of_a_slightly_different_size) {
  const Check majority = [](double radius, double size) {
    return check_majority_radius(radius, size, 0.001);  // mm
  };
  for (const auto& [check, refused, count] :
       {std::tuple(Check(focal), 50.0, 1u), std::tuple(Check(line), 50.0, 2u),
        std::tuple(Check(range), 10.0, 1u), std::tuple(majority, 50.0, 1u)})
    for (const double size : kSizes) {
      const auto problem = check(refused * size, size);
      ASSERT_FALSE(problem);
      const auto stated = lengths_in(problem.error().detail);
      ASSERT_EQ(stated.size(), count) << problem.error().detail;
      for (const double length : stated)
        for (const double other : {0.996, 1.0, 1.004})
          EXPECT_TRUE(check(length, other * size)) << problem.error().detail;
    }
}

TEST(NeighborhoodLimits, refuse_every_radius_on_texels_without_a_size) {
  EXPECT_FALSE(focal(0, 0));
  EXPECT_FALSE(range(0, 0));
}

}  // namespace
}  // namespace strata::query
