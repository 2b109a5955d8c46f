#include "query/statistics/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "domain/layers/layer.h"

namespace strata::query {
namespace {

constexpr CrossTable::Key kUnpainted = std::nullopt;

CrossTable table_of(std::vector<CrossTable::Key> rows, std::vector<CrossTable::Key> columns,
                    std::vector<std::vector<double>> area_m2, double neither_m2 = 0) {
  CrossTable table;
  table.rows = std::move(rows);
  table.columns = std::move(columns);
  table.area_m2 = std::move(area_m2);
  table.neither_m2 = neither_m2;
  return table;
}

CrossTable transposed(const CrossTable& table) {
  CrossTable other = table_of(table.columns, table.rows, {}, table.neither_m2);
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    other.area_m2.emplace_back();
    for (const auto& row : table.area_m2) other.area_m2.back().push_back(row[column]);
  }
  return other;
}

const ClassAgreement& of_key(const Agreement& agreement, CrossTable::Key key) {
  return *std::ranges::find(agreement.classes, key, &ClassAgreement::key);
}

// Classes 1 to `size` and "not painted", with a share of pairs that do not occur.
CrossTable random_table(int size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<CrossTable::Key> keys;
  for (int key = 1; key <= size; ++key) keys.emplace_back(key);
  keys.push_back(kUnpainted);
  CrossTable table = table_of(keys, keys, {}, 1 + random() % 1000 / 7.0);
  for (int row = 0; row <= size; ++row) {
    table.area_m2.emplace_back();
    for (int column = 0; column <= size; ++column) {
      const bool occurs = random() % 4 != 0 && !(row == size && column == size);
      table.area_m2.back().push_back(occurs ? (1 + random() % 1000) / 3.0 : 0);
    }
  }
  return table;
}

// The formula of Cohen (1960) as it stands, with the areas as frequencies.
struct Oracle {
  long double all = 0, agreed = 0, chance = 0;
  std::map<CrossTable::Key, long double> first, second;

  explicit Oracle(const CrossTable& table) {
    const auto add = [&](CrossTable::Key row, CrossTable::Key column, double area) {
      all += area;
      if (row == column) agreed += area;
      first[row] += area;
      second[column] += area;
    };
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      for (std::size_t column = 0; column < table.columns.size(); ++column)
        add(table.rows[row], table.columns[column], table.area_m2[row][column]);
    add(kUnpainted, kUnpainted, table.neither_m2);
    for (const auto& [key, area] : first) chance += area / all * second[key] / all;
  }
  double kappa() const { return static_cast<double>((agreed / all - chance) / (1 - chance)); }
};

TEST(Agreement, of_two_classes_is_as_computed_by_hand) {
  // Observed: 35 of 50. Expected: 25/50 · 30/50 + 25/50 · 20/50.
  const auto agreement = measure_agreement(table_of({1, 2}, {1, 2}, {{20, 5}, {10, 15}}));
  ASSERT_TRUE(agreement);
  EXPECT_DOUBLE_EQ(agreement->area_m2, 50);
  EXPECT_DOUBLE_EQ(agreement->observed, 0.7);
  EXPECT_DOUBLE_EQ(agreement->expected, 0.5);
  EXPECT_DOUBLE_EQ(agreement->kappa.value(), 0.4);
  EXPECT_DOUBLE_EQ(agreement->observed_painted.value(), 0.7);
  ASSERT_EQ(agreement->classes.size(), 2u);
  const ClassAgreement& one = agreement->classes[0];
  EXPECT_EQ(one.key, 1);
  EXPECT_DOUBLE_EQ(one.both_m2, 20);
  EXPECT_DOUBLE_EQ(one.first_m2, 25);
  EXPECT_DOUBLE_EQ(one.second_m2, 30);
  EXPECT_DOUBLE_EQ(one.iou(), 20.0 / 35);
  EXPECT_DOUBLE_EQ(one.f1(), 40.0 / 55);
}

TEST(Agreement, counts_not_painted_as_a_class) {
  // The same areas as above, but the second class is "not painted".
  const auto agreement =
      measure_agreement(table_of({1, kUnpainted}, {1, kUnpainted}, {{20, 5}, {10, 0}}, 15));
  ASSERT_TRUE(agreement);
  EXPECT_DOUBLE_EQ(agreement->observed, 0.7);
  EXPECT_DOUBLE_EQ(agreement->kappa.value(), 0.4);
  EXPECT_DOUBLE_EQ(agreement->observed_painted.value(), 20.0 / 35);
  ASSERT_EQ(agreement->classes.size(), 2u);
  EXPECT_EQ(agreement->classes[1].key, kUnpainted);
  EXPECT_DOUBLE_EQ(agreement->classes[1].both_m2, 15);
}

TEST(Agreement, of_classes_in_only_one_layer_is_as_computed_by_hand) {
  // First: 1 on 4, 2 on 4, nothing on 8. Second: 1 on 6, 7 on 2, nothing on 8.
  const auto agreement = measure_agreement(
      table_of({1, 2, kUnpainted}, {1, 7, kUnpainted}, {{3, 0, 1}, {1, 2, 1}, {2, 0, 0}}, 6));
  ASSERT_TRUE(agreement);
  EXPECT_DOUBLE_EQ(agreement->observed, 9.0 / 16);
  EXPECT_DOUBLE_EQ(agreement->expected, (4.0 * 6 + 8 * 8) / 256);
  EXPECT_DOUBLE_EQ(agreement->kappa.value(), (9.0 / 16 - 88.0 / 256) / (1 - 88.0 / 256));
  ASSERT_EQ(agreement->classes.size(), 4u);
  EXPECT_EQ(of_key(*agreement, 2).iou(), 0);
  EXPECT_EQ(of_key(*agreement, 7).f1(), 0);
  EXPECT_DOUBLE_EQ(of_key(*agreement, 7).second_m2, 2);
  EXPECT_DOUBLE_EQ(of_key(*agreement, 1).iou(), 3.0 / 7);
  EXPECT_EQ(agreement->classes.back().key, kUnpainted);
}

TEST(Agreement, is_that_of_the_formula_and_symmetric) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const CrossTable table = random_table(1 + static_cast<int>(seed % 12), seed);
    const Oracle oracle(table);
    const auto one = measure_agreement(table), other = measure_agreement(transposed(table));
    ASSERT_TRUE(one && other);
    EXPECT_NEAR(one->area_m2, static_cast<double>(oracle.all), 1e-12 * one->area_m2);
    EXPECT_NEAR(one->observed, static_cast<double>(oracle.agreed / oracle.all), 1e-12);
    EXPECT_NEAR(one->expected, static_cast<double>(oracle.chance), 1e-12);
    EXPECT_NEAR(one->kappa.value(), oracle.kappa(), 1e-11);
    EXPECT_LE(*one->kappa, 1);
    EXPECT_NEAR(*one->kappa, other->kappa.value(), 1e-12);
    EXPECT_NEAR(one->observed, other->observed, 1e-12);
    ASSERT_EQ(one->classes.size(), other->classes.size());
    double first = 0, second = 0, both = 0;
    for (std::size_t i = 0; i < one->classes.size(); ++i) {
      const ClassAgreement &a = one->classes[i], &b = other->classes[i];
      EXPECT_EQ(a.key, b.key);
      EXPECT_NEAR(a.iou(), b.iou(), 1e-12);
      EXPECT_NEAR(a.first_m2, b.second_m2, 1e-12 * one->area_m2);
      EXPECT_NEAR(a.f1(), 2 * a.iou() / (1 + a.iou()), 1e-12);
      first += a.first_m2;
      second += a.second_m2;
      both += a.both_m2;
    }
    EXPECT_NEAR(first, one->area_m2, 1e-9);
    EXPECT_NEAR(second, one->area_m2, 1e-9);
    EXPECT_NEAR(both, one->observed * one->area_m2, 1e-9);
  }
}

TEST(Agreement, of_equal_layers_is_exactly_1) {
  for (const double neither : {0.0, 0.1, 1e6}) {
    const auto agreement = measure_agreement(
        table_of({1, 2, 9}, {1, 2, 9}, {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 1e-7}}, neither));
    ASSERT_TRUE(agreement);
    EXPECT_EQ(agreement->observed, 1);
    EXPECT_EQ(agreement->kappa, 1);
    EXPECT_EQ(agreement->observed_painted, 1);
    for (const ClassAgreement& each : agreement->classes) {
      EXPECT_EQ(each.iou(), 1);
      EXPECT_EQ(each.f1(), 1);
    }
  }
}

TEST(Agreement, of_independent_layers_is_0) {
  std::mt19937 random(4);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> first, second;
    for (int i = 0; i < 4; ++i) {
      first.push_back(1 + random() % 100);
      second.push_back(1 + random() % 100);
    }
    CrossTable table = table_of({1, 2, 3, kUnpainted}, {1, 2, 3, kUnpainted}, {});
    for (const double row : first) {
      table.area_m2.emplace_back();
      for (const double column : second) table.area_m2.back().push_back(row * column);
    }
    std::swap(table.neither_m2, table.area_m2[3][3]);
    const auto agreement = measure_agreement(table);
    ASSERT_TRUE(agreement);
    EXPECT_NEAR(agreement->observed, agreement->expected, 1e-14);
    EXPECT_NEAR(agreement->kappa.value(), 0, 1e-13);
  }
}

TEST(Agreement, below_chance_is_negative) {
  const auto swapped = measure_agreement(table_of({1, 2}, {1, 2}, {{0, 3}, {3, 0}}));
  ASSERT_TRUE(swapped);
  EXPECT_EQ(swapped->observed, 0);
  EXPECT_DOUBLE_EQ(swapped->kappa.value(), -1);
  // Each layer has one class, and these differ: agreement by chance is impossible.
  const auto apart = measure_agreement(table_of({1}, {2}, {{5}}));
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->expected, 0);
  EXPECT_EQ(apart->kappa, 0);
}

TEST(Agreement, has_no_kappa_where_both_layers_have_one_class) {
  const auto everywhere = measure_agreement(table_of({4}, {4}, {{2}}));
  ASSERT_TRUE(everywhere);
  EXPECT_EQ(everywhere->observed, 1);
  EXPECT_EQ(everywhere->expected, 1);
  EXPECT_FALSE(everywhere->kappa);
  EXPECT_EQ(everywhere->observed_painted, 1);

  const auto nothing = measure_agreement(table_of({}, {}, {}, 2));
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->observed, 1);
  EXPECT_FALSE(nothing->kappa);
  EXPECT_FALSE(nothing->observed_painted);
  ASSERT_EQ(nothing->classes.size(), 1u);

  EXPECT_FALSE(measure_agreement(CrossTable{}));
  EXPECT_FALSE(measure_agreement(table_of({1}, {1}, {{0}})));
}

TEST(Agreement, leaves_out_classes_without_area) {
  const auto agreement = measure_agreement(table_of({1, 2}, {1, 3}, {{5, 0}, {0, 0}}, 1));
  ASSERT_TRUE(agreement);
  ASSERT_EQ(agreement->classes.size(), 2u);
  EXPECT_EQ(agreement->classes[0].key, 1);
  EXPECT_EQ(agreement->classes[1].key, kUnpainted);
}

TEST(Agreement, of_a_speck_on_a_large_surface_keeps_its_digits) {
  // Both layers have 1 m² of the class, half of it in common. With e = 1 m² / all, kappa is
  // (0.5 - e) / (1 - e).
  const auto agreement =
      measure_agreement(table_of({1, kUnpainted}, {1, kUnpainted}, {{0.5, 0.5}, {0.5, 0}}, 1e12));
  ASSERT_TRUE(agreement);
  const double share = 1 / (1e12 + 1.5);
  EXPECT_NEAR(agreement->kappa.value(), (0.5 - share) / (1 - share), 1e-14);
}

TEST(Agreement, without_the_unpainted_surface_would_never_be_positive_for_one_class) {
  std::mt19937 random(8);
  for (int round = 0; round < 50; ++round) {
    const double both = 1 + random() % 1000, first = random() % 100 + 1,
                 second = random() % 100 + 1;
    const auto measured = [&](double neither) {
      return *measure_agreement(
                  table_of({1, kUnpainted}, {1, kUnpainted}, {{both, first}, {second, 0}}, neither))
                  ->kappa;
    };
    EXPECT_LT(measured(0), 0);
    EXPECT_GT(measured(10'000), 0);
  }
}

Layer classes(std::vector<Palette::Point> points) {
  Layer layer;
  layer.palette.mode = PaletteMode::categorical;
  layer.palette.points = std::move(points);
  return layer;
}

Palette::Point named(double key, std::string name) {
  Palette::Point point;
  point.at = key;
  point.label = std::move(name);
  return point;
}

TEST(SharedClasses, are_keys_that_the_palettes_do_not_name_differently) {
  const Layer anna = classes({named(1, "Crack"), named(2, "Loss"), named(3, "")});
  EXPECT_TRUE(share_classes(anna, anna));
  EXPECT_TRUE(share_classes(anna, classes({named(1, " crack"), named(3, "Salt")})));
  EXPECT_TRUE(share_classes(anna, classes({named(1, ""), named(2, "")})));
  EXPECT_TRUE(share_classes(anna, classes({})));
  EXPECT_TRUE(share_classes(classes({}), classes({})));
  const Layer swapped = classes({named(1, "Loss"), named(2, "Crack")});
  EXPECT_FALSE(share_classes(anna, swapped));
  EXPECT_FALSE(share_classes(swapped, anna));
  EXPECT_FALSE(share_classes(anna, classes({named(11, "Nave"), named(12, "Apse")})));
}

TEST(SharedClasses, are_records_of_the_same_table) {
  Layer records = classes({});
  records.kind = LayerKind::database;
  records.table = TableId{4};
  Layer same = records, other = records;
  same.palette.mode = PaletteMode::linear;
  other.table = TableId{5};
  EXPECT_TRUE(share_classes(records, same));
  EXPECT_FALSE(share_classes(records, other));
  EXPECT_FALSE(share_classes(records, classes({})));
  EXPECT_FALSE(share_classes(classes({}), records));
}

TEST(SharedClasses, do_not_include_measurements) {
  Layer measured = classes({});
  measured.palette.mode = PaletteMode::step;
  EXPECT_FALSE(share_classes(measured, classes({})));
  EXPECT_FALSE(share_classes(measured, measured));
}

}  // namespace
}  // namespace strata::query
