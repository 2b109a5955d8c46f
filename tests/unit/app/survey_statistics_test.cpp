// The statistics of a layer in all surveys of an object, as a table.
#include "app/layers/survey_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace strata::app {
namespace {

Layer layer(const std::string& name, const std::string& slug, PaletteMode mode) {
  Layer made;
  made.name = name;
  made.slug = slug;
  made.palette.mode = mode;
  return made;
}

SurveyStatistics survey(const std::string& date, std::optional<SurveyLayer> of) {
  return {{5, "bust-" + date, "Bust " + date, date}, std::move(of)};
}

SurveyLayer counted(Layer of, std::uint64_t texels, double area_m2) {
  SurveyLayer made{std::move(of), 3, 8, {}};
  made.statistics.texels = texels;
  made.statistics.area_m2 = area_m2;
  return made;
}

std::vector<SurveyStatistics> cracks() {
  const Layer cracks = layer("Cracks", "cracks", PaletteMode::categorical);
  auto then = counted(cracks, 30, 3), now = counted(cracks, 70, 7);
  then.classes = std::vector<SurveyClass>{{1, "Crack", 20, 2}, {2, "Loss", 10, 1}};
  // another key for the same class, and two keys for another class
  now.classes =
      std::vector<SurveyClass>{{4, "Crack", 30, 3}, {5, "Salt", 30, 3}, {6, "Salt", 10, 1}};
  return {survey("2019", then), survey("2021", std::nullopt), survey("2022-06", now)};
}

std::vector<std::optional<double>> column(const Sheet& sheet, const std::string& head) {
  const auto found = std::ranges::find(sheet.heads, head);
  if (found == sheet.heads.end()) return {};
  std::vector<std::optional<double>> numbers;
  for (const auto& row : sheet.rows) {
    const auto* number = std::get_if<double>(&row[std::size_t(found - sheet.heads.begin())]);
    numbers.push_back(number ? std::optional(*number) : std::nullopt);
  }
  return numbers;
}

using Numbers = std::vector<std::optional<double>>;

TEST(SurveyStatistics, have_a_column_for_each_name_of_a_class) {
  const Sheet sheet = survey_statistics_sheet(cracks());
  EXPECT_EQ(sheet.name, "cracks-surveys");
  EXPECT_EQ(sheet.heads, (std::vector<std::string>{
                             "date", "model", "layer", "unit", "texels", "area_m2",
                             "percent_of_surface", "Crack area_m2", "Loss area_m2", "Salt area_m2",
                             "area (m²)", "Crack area (m²)", "Loss area (m²)", "Salt area (m²)"}));
  ASSERT_EQ(sheet.rows.size(), 3u);
  EXPECT_EQ(std::get<std::string>(sheet.rows[2][0]), "2022-06");
  EXPECT_EQ(std::get<std::string>(sheet.rows[1][1]), "bust-2021");
  EXPECT_EQ(column(sheet, "percent_of_surface"), (Numbers{37.5, {}, 87.5}));
  EXPECT_EQ(column(sheet, "Crack area_m2"), (Numbers{2, {}, 3}));
  EXPECT_EQ(column(sheet, "Loss area_m2"), (Numbers{1, {}, 0}));
  EXPECT_EQ(column(sheet, "Salt area_m2"), (Numbers{0, {}, 4}));
  EXPECT_FALSE(sheet.has_totals);
}

TEST(SurveyStatistics, of_values_have_their_mean_and_limits) {
  auto wet = counted(layer("Moisture", "moisture", PaletteMode::linear), 4, 2);
  const auto dry = counted(wet.layer, 0, 0);
  wet.statistics.mean = 0.25;
  wet.statistics.min = -1;
  wet.statistics.max = 3;
  wet.statistics.quantiles = query::Quantiles{-0.5, 0, 0.125, 0.5, 2};
  const Sheet sheet = survey_statistics_sheet({survey("2019", wet), survey("2020", dry)});
  EXPECT_EQ(column(sheet, "mean"), (Numbers{0.25, {}}));
  EXPECT_EQ(column(sheet, "min"), (Numbers{-1, {}}));
  EXPECT_EQ(column(sheet, "max"), (Numbers{3, {}}));
  EXPECT_EQ(column(sheet, "p50"), (Numbers{0.125, {}}));
  EXPECT_EQ(column(sheet, "texels"), (Numbers{4, 0}));
  EXPECT_EQ(column(sheet, "pieces"), Numbers{}) << "they were not requested";
}

TEST(SurveyStatistics, without_surveys_are_an_empty_table) {
  const Sheet sheet = survey_statistics_sheet({});
  EXPECT_EQ(sheet.name, "surveys");
  EXPECT_TRUE(sheet.rows.empty());
}

TEST(SurveyStatistics, use_the_layer_with_the_name_before_one_with_the_slug) {
  const std::vector<Layer> layers = {layer("Cracks", "cracks", PaletteMode::linear),
                                     layer("cracks", "cracks-2", PaletteMode::linear)};
  EXPECT_EQ(named_layer(layers, "cracks")->slug, "cracks-2");
  EXPECT_EQ(named_layer(layers, "Cracks")->slug, "cracks");
  EXPECT_EQ(named_layer(layers, "cracks-2")->slug, "cracks-2");
  EXPECT_EQ(named_layer(layers, "salts"), nullptr);
}

TEST(SurveyStatistics, have_classes_only_for_records_and_labelled_whole_numbers) {
  Layer of = layer("Cracks", "cracks", PaletteMode::categorical);
  EXPECT_TRUE(holds_classes(of));
  of.type = ValueType::f32;
  EXPECT_FALSE(holds_classes(of));
  of = layer("Moisture", "moisture", PaletteMode::linear);
  EXPECT_FALSE(holds_classes(of));
  of.kind = LayerKind::database;
  EXPECT_TRUE(holds_classes(of));
}

}  // namespace
}  // namespace strata::app
