#include "domain/layers/key_colors.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "domain/layers/classification.h"

namespace strata {
namespace {

Palette palette(const char* text) {
  const auto read = palette_from_json(nlohmann::json::parse(text));
  if (!read) throw std::runtime_error(read.error().detail);
  return *read;
}

constexpr Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 128};

TEST(KeyColors, numbers_of_records_take_the_palettes_colours) {
  const Palette steps =
      palette(R"({"mode":"step","column":"depth","points":[{"at":0,"color":"#ff0000"},
    {"at":5,"color":"#00ff00","pattern":"hatch","angle":30,"spacing_mm":2}]})");
  const std::vector<KeyNumber> numbers{{9, 7}, {2, -3}, {4'000'000'000u, 5}};
  const Palette made = colors_of_numbers(steps, numbers);
  EXPECT_EQ(made.mode, PaletteMode::categorical);
  ASSERT_EQ(made.points.size(), 3u);
  EXPECT_EQ(made.points[0].at, 2) << "ascending, whatever the order of the records";
  EXPECT_EQ(color_of(made, 2), kRed);
  EXPECT_EQ(color_of(made, 9), kGreen);
  EXPECT_EQ(color_of(made, 4'000'000'000.0), kGreen);
  EXPECT_EQ(color_of(made, 3), kNoValueColor) << "a record that has no number";
  EXPECT_EQ(point_of(made, 9)->pattern, Pattern::hatch);
  EXPECT_EQ(point_of(made, 9)->spacing_mm, 2);
  EXPECT_EQ(point_of(made, 2)->pattern, Pattern::solid);
}

TEST(KeyColors, each_number_is_coloured_as_the_palette_colours_it_alone) {
  std::mt19937 random(1);
  for (
      const char* text :
      {R"({"mode":"linear","points":[{"at":-4,"color":"#102030"},{"at":8,"color":"#f0e0d080"}]})",
       R"({"mode":"step","points":[{"at":-4,"color":"#102030"},{"at":0,"color":"#00ff00"},{"at":8,"color":"#f0e0d0"}]})"}) {
    const Palette given = palette(text);
    std::vector<KeyNumber> numbers;
    for (std::uint32_t key = 0; key < 500; ++key)
      numbers.push_back({key * 7, std::uniform_real_distribution(-10.0, 14.0)(random)});
    const Palette made = colors_of_numbers(given, numbers);
    for (const KeyNumber& known : numbers)
      ASSERT_EQ(color_of(made, known.key), color_of(given, known.number));
  }
}

TEST(KeyColors, texts_are_named_by_points_and_the_rest_are_others) {
  const Palette states =
      palette(R"({"mode":"categorical","column":"state","others":"#0000ff80","points":[
    {"at":0,"value":"loose","color":"#ff0000"},{"at":1,"value":"firm","color":"#00ff00","pattern":"dots"}]})");
  const std::vector<KeyText> texts{{5, "firm"}, {1, "loose"}, {3, "odd"}};
  const Palette made = colors_of_texts(states, texts);
  EXPECT_EQ(color_of(made, 1), kRed);
  EXPECT_EQ(color_of(made, 5), kGreen);
  EXPECT_EQ(point_of(made, 5)->pattern, Pattern::dots);
  EXPECT_EQ(color_of(made, 3), kBlue) << "a value that the palette does not list";
  EXPECT_EQ(color_of(made, 77), kBlue) << "a record without a value";
}

TEST(KeyColors, highlighted_keys_stand_out_in_their_own_colours) {
  const Palette keys = palette(R"({"mode":"categorical","points":[{"at":4,"color":"#0000ff80"}]})");
  const std::vector<std::uint32_t> lit{4, 9};
  const Palette dimmed = highlighted_colors(keys, lit, false),
                isolated = highlighted_colors(keys, lit, true);
  for (const Palette& made : {dimmed, isolated}) {
    EXPECT_EQ(color_of(made, 4), (Rgba{0, 0, 255, 255})) << "as opaque as can be";
    EXPECT_EQ(color_of(made, 9), generated_color(9));
  }
  EXPECT_EQ(color_of(isolated, 5)[3], 0);
  EXPECT_GT(color_of(dimmed, 5)[3], 0);
  EXPECT_LT(color_of(dimmed, 5)[3], 128);
  EXPECT_EQ(color_of(dimmed, 5)[0], color_of(dimmed, 5)[1]) << "grey";
}

TEST(Classification, equal_intervals_and_quantiles_hold_every_number_once) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> numbers(std::uniform_int_distribution<std::size_t>(1, 300)(random));
    const int values = std::uniform_int_distribution(1, 40)(random);
    for (double& number : numbers)
      number = std::uniform_int_distribution(-values, values)(random) * 0.25;
    const int count = std::uniform_int_distribution(1, 12)(random);
    for (const ClassMethod method : {ClassMethod::equal, ClassMethod::quantile}) {
      const auto classes = classify(numbers, method, count);
      ASSERT_GE(classes.size(), 1u);
      ASSERT_LE(classes.size(), static_cast<std::size_t>(count));
      std::uint64_t total = 0;
      for (std::size_t i = 0; i < classes.size(); ++i) {
        const bool last = i + 1 == classes.size();
        std::uint64_t held = 0;
        for (const double number : numbers)
          held += number >= classes[i].from &&
                  (number < classes[i].to || (last && number == classes[i].to));
        ASSERT_EQ(classes[i].count, held) << round << " " << i;
        if (!last) {
          ASSERT_EQ(classes[i].to, classes[i + 1].from);
        }
        if (method == ClassMethod::quantile) {
          ASSERT_GT(held, 0u);
        }
        total += held;
      }
      ASSERT_EQ(total, numbers.size());
      if (method == ClassMethod::equal && classes.size() == static_cast<std::size_t>(count) &&
          count > 1) {
        ASSERT_NEAR(classes[0].to - classes[0].from, classes[1].to - classes[1].from, 1e-9);
      }
    }
  }
}

TEST(Classification, quantiles_share_distinct_numbers_out_evenly) {
  std::vector<double> numbers;
  for (int i = 0; i < 1000; ++i) numbers.push_back(i * i);
  for (const NumberClass& each : classify(numbers, ClassMethod::quantile, 7))
    EXPECT_NEAR(double(each.count), 1000 / 7.0, 1);
}

TEST(Classification, extremes_stay_finite_and_nothing_makes_no_class) {
  EXPECT_TRUE(classify(std::span<const double>(), ClassMethod::equal, 5).empty());
  const std::vector<double> same(9, 3.5);
  for (const ClassMethod method : {ClassMethod::equal, ClassMethod::quantile}) {
    const auto classes = classify(same, method, 5);
    ASSERT_EQ(classes.size(), 1u);
    EXPECT_EQ(classes[0].from, 3.5);
    EXPECT_EQ(classes[0].to, 3.5);
  }
  constexpr double kHuge = std::numeric_limits<double>::max();
  const std::vector<double> far{-kHuge, 0, kHuge};
  for (const NumberClass& each : classify(far, ClassMethod::equal, 4))
    EXPECT_TRUE(std::isfinite(each.to));
}

TEST(Classification, values_are_counted_the_most_frequent_first) {
  const std::vector<std::string> values{"b", "a", "c", "a", "c", "a"};
  const auto classes = classify(values);
  ASSERT_EQ(classes.size(), 3u);
  EXPECT_EQ(classes[0].value, "a");
  EXPECT_EQ(classes[0].count, 3u);
  EXPECT_EQ(classes[1].value, "c");
  EXPECT_EQ(classes[2].value, "b");
}

}  // namespace
}  // namespace strata
