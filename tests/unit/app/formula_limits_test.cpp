// Limits of functions along the surface, checked without a map of the surface.
#include "app/layers/formula_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/layers/formula_layers.h"

namespace strata::app {
namespace {

// In mm, with texels of 0.1 mm at 2048².
Model measured_model() {
  Model model;
  model.unit = Unit::mm;
  model.atlas.texel_sizes = {{2048, 0.01, 0.02}, {4096, 0.0025, 0.005}};
  return model;
}

Result<void> check(const std::string& text, int resolution, const Model& model = measured_model()) {
  const auto expression = parse_formula(text);
  EXPECT_TRUE(expression) << text;
  return check_formula_limits(*expression, model, resolution);
}

TEST(FormulaLimits, hold_for_the_resolution_of_the_layer) {
  for (const char* text : {"focal_mean(a, 3.9)", "focal_min(a, 3.9)", "focal_max(a, 3.9)",
                           "focal_variety(a, 3.9)", "hot_spot(a, 3.9)", "hot_spot_chance(a, 3.9)",
                           "majority(a, 3.9)", "valley(a, 2.1)", "ridge(a, 2.1)"}) {
    EXPECT_TRUE(check(text, 1024)) << text;
    EXPECT_TRUE(check(text, 2048)) << text;
    EXPECT_FALSE(check(text, 4096)) << text;
    EXPECT_FALSE(check(text, 16384)) << text;  // larger than the measured resolutions
  }
  for (const char* text :
       {"valley(a, 0.21)", "interpolated(a, 2.1)", "interpolation_error(a, 2.1)"}) {
    EXPECT_FALSE(check(text, 1024)) << text;
    EXPECT_TRUE(check(text, 2048)) << text;
    EXPECT_TRUE(check(text, 4096)) << text;
  }
}

TEST(FormulaLimits, name_the_function_that_does_not_keep_them) {
  const auto refused = check("1 + max(distance(x > 1), focal_mean(valley(a, 1), 50))", 2048);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "expression");
  EXPECT_EQ(refused.error().offset, 25u);
  EXPECT_EQ(refused.error().length, 10u);
  EXPECT_THAT(refused.error().detail, testing::HasSubstr("at most 3.96 model units"));
  // in a condition, and inside another function
  EXPECT_EQ(check("x > 1 and valley(a, 9) > 2", 2048).error().offset, 10u);
  EXPECT_EQ(check("focal_mean(valley(a, 9), 1)", 2048).error().offset, 11u);
}

TEST(FormulaLimits, of_majority_are_in_millimeters) {
  const auto refused = check("majority(a, 50)", 2048);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "expression");
  EXPECT_THAT(refused.error().detail, testing::HasSubstr("at most 3.96 mm"));
}

TEST(FormulaLimits, are_left_to_the_job_if_the_size_of_texels_is_not_known) {
  Model model = measured_model();
  model.atlas.texel_sizes.clear();
  EXPECT_TRUE(check("focal_mean(a, 50)", 2048, model));
}

}  // namespace
}  // namespace strata::app
