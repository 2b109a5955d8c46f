// Functions along the surface in formulas: their grammar, and the layers that take their place.
#include "expression/surface_functions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "expression/expression_parser.h"
#include "expression/record_parts.h"

namespace strata::query {
namespace {

using Op = Expression::Op;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Expression number(const std::string& text) {
  const auto parsed = parse_number(text, "expression");
  EXPECT_TRUE(parsed) << text << ": " << parsed.error().detail;
  return parsed.value_or(Expression{});
}
Expression condition(const std::string& text) {
  const auto parsed = parse_condition(text, "expression");
  EXPECT_TRUE(parsed) << text << ": " << parsed.error().detail;
  return parsed.value_or(Expression{});
}

TEST(SurfaceFunctions, have_a_condition_or_a_number_and_a_limit) {
  const Expression distance = number("distance(pieces = 3 and wet > 0.5, 50)");
  EXPECT_EQ(distance.op, Op::distance);
  EXPECT_EQ(distance.number, 50);
  ASSERT_EQ(distance.parts.size(), 1u);
  EXPECT_EQ(distance.parts[0], condition("pieces = 3 and wet > 0.5"));
  EXPECT_EQ(number("distance(wet > 1)").number, kInfinity);
  const Expression nearest = number("nearest(pieces, 2.5)");
  EXPECT_EQ(nearest.op, Op::nearest);
  EXPECT_EQ(nearest.number, 2.5);
  EXPECT_EQ(nearest.parts[0], number("pieces"));
  EXPECT_EQ(number("nearest(pieces.thickness * 2)").number, kInfinity);
}

TEST(SurfaceFunctions, of_neighborhoods_have_a_number_and_a_radius) {
  for (const auto& [name, op] :
       {std::pair("focal_mean", Op::focal_mean), std::pair("focal_min", Op::focal_min),
        std::pair("focal_max", Op::focal_max), std::pair("focal_variety", Op::focal_variety),
        std::pair("hot_spot", Op::hot_spot)}) {
    const Expression focal = number(std::string(name) + "(wet - dry, 5)");
    EXPECT_EQ(focal.op, op);
    EXPECT_EQ(focal.number, 5);
    EXPECT_EQ(focal.parts[0], number("wet - dry"));
  }
}

TEST(SurfaceFunctions, of_chance_have_a_radius_and_permutations) {
  const Expression chance = number("hot_spot_chance(wet - dry, 5, 199)");
  EXPECT_EQ(chance.op, Op::hot_spot_chance);
  EXPECT_TRUE(chance.is_surface_function());
  EXPECT_EQ(chance.number, 5);
  ASSERT_EQ(chance.parts.size(), 2u);
  EXPECT_EQ(chance.parts[0], number("wet - dry"));
  EXPECT_EQ(chance.parts[1].number, 199);
  EXPECT_EQ(number("hot_spot_chance(wet, 5)").parts[1].number, kDefaultPermutations);
}

TEST(SurfaceFunctions, of_basins_have_a_height_and_of_water_only_the_rain) {
  const Expression basins = number("watershed(wet, 0.5)");
  EXPECT_EQ(basins.op, Op::watershed);
  EXPECT_EQ(basins.number, 0.5);
  const Expression water = number("run_off(max(0, nz) * 12)");
  EXPECT_EQ(water.op, Op::run_off);
  EXPECT_EQ(water.parts[0], number("max(0, nz) * 12"));
  EXPECT_TRUE(basins.is_surface_function() && water.is_surface_function());
}

TEST(SurfaceFunctions, of_lines_have_a_number_and_a_width) {
  for (const auto& [name, op] : {std::pair("valley", Op::valley), std::pair("ridge", Op::ridge)}) {
    const Expression line = number(std::string(name) + "(height - 2, 1.5)");
    EXPECT_EQ(line.op, op);
    EXPECT_EQ(line.number, 1.5);
    EXPECT_EQ(line.parts[0], number("height - 2"));
  }
}

TEST(SurfaceFunctions, hysteresis_is_a_condition_with_two_thresholds) {
  const Expression known = condition("hysteresis(wet - dry, -0.5, 2)");
  ASSERT_EQ(known.op, Op::known);
  const Expression& function = known.parts[0];
  EXPECT_EQ(function.op, Op::hysteresis);
  EXPECT_TRUE(function.is_surface_function());
  ASSERT_EQ(function.parts.size(), 2u);
  EXPECT_EQ(function.parts[0], number("wet - dry"));
  EXPECT_EQ(function.parts[1].number, -0.5);
  EXPECT_EQ(function.number, 2);
  EXPECT_EQ(number("if(hysteresis(wet, 1, 1), 3, 0)").op, Op::choose);
  const auto formula = separate_surface_functions(
      condition("hysteresis(valley(wet, 2), 1, 2) and hysteresis(valley(wet, 2), 1, 3)"), "e");
  ASSERT_TRUE(formula);
  EXPECT_EQ(formula->functions.size(), 3u);
}

TEST(SurfaceFunctions, that_clean_up_return_what_they_get) {
  for (const auto& [name, op] :
       {std::pair("sieve", Op::sieve), std::pair("fill_holes", Op::fill_holes),
        std::pair("majority", Op::majority)}) {
    const Expression classes = number(std::string(name) + "(wet, 4)");
    EXPECT_EQ(classes.op, op);
    EXPECT_EQ(classes.number, 4);
    EXPECT_EQ(classes.parts[0], number("wet"));
    EXPECT_TRUE(classes.is_surface_function());
    const Expression places = condition(std::string(name) + "(wet > 1, 4)");
    ASSERT_EQ(places.op, Op::known);
    EXPECT_EQ(places.parts[0].op, op);
    EXPECT_EQ(places.parts[0].parts[0], condition("wet > 1"));
  }
  for (const auto& [name, op] :
       {std::pair("opening", Op::opening), std::pair("closing", Op::closing)}) {
    const Expression places = condition(std::string(name) + "(wet, 4)");
    ASSERT_EQ(places.op, Op::known);
    EXPECT_EQ(places.parts[0].op, op);
    EXPECT_EQ(places.parts[0].parts[0], condition("valid(wet)"));
    EXPECT_TRUE(places.parts[0].is_surface_function());
  }
  const auto formula =
      separate_surface_functions(condition("sieve(opening(wet > 1, 2), 9) and dry > 2"), "e");
  ASSERT_TRUE(formula);
  ASSERT_EQ(formula->functions.size(), 2u);
  EXPECT_EQ(formula->functions[1].function.op, Op::sieve);
  EXPECT_TRUE(formula->functions[1].function.parts[0].is_condition());
}

TEST(SurfaceFunctions, of_readings_have_a_number_and_a_range) {
  for (const auto& [name, op] : {std::pair("interpolated", Op::interpolated),
                                 std::pair("interpolation_error", Op::interpolation_error)}) {
    const Expression interpolated = number(std::string(name) + "(round(wet * 10) / 10, 80)");
    EXPECT_EQ(interpolated.op, op);
    EXPECT_EQ(interpolated.number, 80);
    EXPECT_EQ(interpolated.parts[0], number("round(wet * 10) / 10"));
    EXPECT_TRUE(interpolated.is_surface_function());
  }
}

TEST(SurfaceFunctions, take_a_layer_for_the_places_where_it_has_a_value) {
  EXPECT_EQ(number("distance(crack)"), number("distance(valid(crack))"));
  EXPECT_EQ(number("distance(\"3d\", 4)"), number("distance(valid(\"3d\"), 4)"));
  // A column is a condition by itself.
  EXPECT_EQ(number("distance(pieces.wet)").parts[0], condition("pieces.wet"));
}

TEST(SurfaceFunctions, within_is_a_known_distance) {
  EXPECT_EQ(condition("within(crack, 20)"), condition("distance(crack, 20) is not null"));
  EXPECT_EQ(condition("not within(wet > 1, 20) and z > 2"),
            condition("distance(wet > 1, 20) is null and z > 2"));
}

TEST(SurfaceFunctions, are_names_of_layers_without_a_bracket) {
  EXPECT_EQ(number("distance + nearest * within").op, Op::add);
  EXPECT_EQ(number("distance(distance)").parts[0].name, "distance");
}

struct Mistaken {
  std::string text;
  std::string_view reason;
  std::size_t offset;
  std::size_t length = 0;
  std::string says{};
};

TEST(SurfaceFunctions, are_refused_with_the_reason_and_the_place) {
  using namespace mistake;
  for (const Mistaken& each : std::vector<Mistaken>{
           {"distance(wet + 1)", kExpectsCondition, 9},
           {"distance(wet > 1, dry)", kSyntax, 18, 0, "as a number"},
           {"distance(wet > 1, -5)", kSyntax, 18, 0, "must not be negative"},
           {"distance(wet > 1, 5 mm)", kUnit, 18, 4, "unit of the model"},
           {"distance(wet > 1, 5mm)", kUnit, 18, 3},
           {"distance(wet > 1, 5 adn 6)", kSyntax, 20},
           {"distance(wet > 1", kSyntax, 16},
           {"distance()", kSyntax, 9},
           {"within(wet > 1) and true", kSyntax, 14, 0, "a distance"},
           {"nearest(wet > 1)", kExpectsNumber, 8},
           {"nearest('a')", kWrongType, 8},
           {"focal_mean(wet)", kSyntax, 14, 0, "a distance"},
           {"focal_min(wet > 1, 5)", kExpectsNumber, 10},
           {"watershed(wet, 5 mm)", kUnit, 15, 4, "unit of the layer"},
           {"watershed(wet)", kSyntax, 13, 0, "a height"},
           {"run_off(wet, 5)", kSyntax, 11},
           {"run_off(wet > 1)", kExpectsNumber, 8},
           {"hot_spot_chance(wet)", kSyntax, 19, 0, "a distance"},
           {"hot_spot_chance(wet, 5, 98)", kSyntax, 24, 0, "from 99 to 9999"},
           {"hot_spot_chance(wet, 5, 10000)", kSyntax, 24, 0, "from 99 to 9999"},
           {"hot_spot_chance(wet, 5, 99.5)", kSyntax, 24, 0, "whole number"},
           {"valley(wet)", kSyntax, 10, 0, "a width"},
           {"ridge(wet > 1, 2)", kExpectsNumber, 6},
           {"hysteresis(wet, 1, 2)", kExpectsNumber, 0},
           {"hysteresis(wet)", kSyntax, 14, 0, "two thresholds"},
           {"hysteresis(wet, 1)", kSyntax, 17, 0, "two thresholds"},
           {"hysteresis(wet, dry, 1)", kSyntax, 16, 0, "as a number"},
           {"hysteresis(wet, 2, 1)", kSyntax, 20, 0, "lower than the first"},
           {"hysteresis(wet > 1, 1, 2)", kExpectsNumber, 11},
           {"sieve(wet)", kSyntax, 9, 0, "an area"},
           {"sieve(wet, 20 mm)", kUnit, 11, 5, "model, squared"},
           {"fill_holes('a', 2)", kWrongType, 11},
           {"majority(wet > 1, 2)", kExpectsNumber, 0},
           {"opening(wet + 1, 2)", kExpectsCondition, 8},
           {"closing(wet > 1)", kSyntax, 15, 0, "a width"},
           {"interpolated(wet)", kSyntax, 16, 0, "a distance"},
           {"interpolated(wet > 1, 80)", kExpectsNumber, 13},
           {"interpolation_error(wet, 80 mm)", kUnit, 25, 5, "unit of the model"},
           {"interpolate(wet, 80)", kUnknownFunction, 0, 11, "Did you mean interpolated"},
           {"focal_max(wet, dry)", kSyntax, 15, 0, "as a number"},
           {"distanc(wet > 1)", kUnknownFunction, 0, 7, "Did you mean distance"},
       }) {
    SCOPED_TRACE(each.text);
    const auto parsed = parse_number(each.text, "expression");
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.error().reason, each.reason) << parsed.error().detail;
    EXPECT_EQ(parsed.error().offset, each.offset);
    EXPECT_EQ(parsed.error().length, each.length);
    std::string told = parsed.error().detail;
    if (!parsed.error().suggestions.empty())
      told += " Did you mean " + parsed.error().suggestions.front();
    EXPECT_THAT(told, testing::HasSubstr(each.says));
  }
}

TEST(SurfaceFunctions, work_in_computed_layers_only) {
  for (const char* text : {"wet > 1 and distance(crack) < 5", "within(pieces.state = 'loose', 5)",
                           "pieces.thickness > distance(pieces.wet)", "nearest(pieces) = 3"}) {
    SCOPED_TRACE(text);
    const auto split = split_records(condition(text), "where");
    ASSERT_FALSE(split);
    EXPECT_EQ(split.error().reason, mistake::kComputedLayersOnly);
    EXPECT_EQ(split.error().field, "where");
    EXPECT_THAT(split.error().detail, testing::HasSubstr("create a computed layer"));
    const std::string named = std::string(text).substr(*split.error().offset, split.error().length);
    EXPECT_TRUE(named == "distance" || named == "within" || named == "nearest") << named;
    const auto filter = parse_condition(text, "filter", Names::columns);
    ASSERT_FALSE(filter);
    EXPECT_EQ(filter.error().reason, mistake::kComputedLayersOnly);
  }
}

TEST(SurfaceFunctions, give_their_place_to_layers) {
  const auto formula =
      separate_surface_functions(number("1 + distance(pieces.wet, 5) * nearest(pieces)"), "e");
  ASSERT_TRUE(formula);
  ASSERT_EQ(formula->functions.size(), 2u);
  EXPECT_EQ(formula->functions[0].function, number("distance(pieces.wet, 5)"));
  EXPECT_EQ(formula->functions[1].function, number("nearest(pieces)"));
  EXPECT_FALSE(has_surface_function(formula->expression));
  EXPECT_EQ(layers_of(formula->expression),
            (std::vector<std::string>{formula->functions[0].slug, formula->functions[1].slug}));
  EXPECT_TRUE(split_records(formula->expression, "e"));
}

TEST(SurfaceFunctions, read_the_layers_of_inner_functions) {
  const auto formula = separate_surface_functions(number("distance(distance(crack) < 5)"), "e");
  ASSERT_TRUE(formula);
  ASSERT_EQ(formula->functions.size(), 2u);
  EXPECT_EQ(formula->functions[0].function, number("distance(crack)"));
  EXPECT_EQ(layers_of(formula->functions[1].function),
            std::vector<std::string>{formula->functions[0].slug});
  EXPECT_EQ(formula->expression.name, formula->functions[1].slug);
}

TEST(SurfaceFunctions, that_are_equal_are_computed_once) {
  const auto count = [](const std::string& text) {
    return separate_surface_functions(number(text), "e")->functions.size();
  };
  EXPECT_EQ(count("distance(crack) + distance(valid(crack)) + if(within(crack, 2), 1, 0)"), 2u);
  EXPECT_EQ(count("distance(crack) * distance(salt) + distance(crack, 5)"), 3u);
  EXPECT_EQ(count("if(distance(crack) between 3 and 5, 1, 0)"), 1u);
  EXPECT_EQ(count("crack + 1"), 0u);
}

TEST(SurfaceFunctions, have_a_limit_for_their_number) {
  std::string text = "0";
  for (std::size_t i = 1; i <= kMaxSurfaceFunctions; ++i)
    text += " + distance(crack, " + std::to_string(i) + ")";
  EXPECT_TRUE(separate_surface_functions(number(text), "e"));
  const auto refused = separate_surface_functions(number(text + " + nearest(crack)"), "e");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, mistake::kTooLarge);
  EXPECT_EQ(refused.error().field, "e");
}

}  // namespace
}  // namespace strata::query
