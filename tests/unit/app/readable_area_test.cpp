// Areas in a unit that suits their size.
#include "app/records/readable_area.h"

#include <gtest/gtest.h>

#include "app/records/sheet.h"

namespace strata::app {
namespace {

TEST(ReadableArea, the_unit_and_its_decimals_follow_the_largest_area) {
  const auto of = [](double largest_m2) {
    const AreaUnit unit = readable_area(largest_m2);
    return unit.name + " " + number_format(largest_m2 * unit.per_m2);
  };
  EXPECT_EQ(of(0), "mm² #,##0.00");
  EXPECT_EQ(of(1.2345e-5), "mm² #,##0.00");
  EXPECT_EQ(of(1.2345e-9), "mm² #,##0.000000");
  EXPECT_EQ(of(9.99e-5), "mm² #,##0.00");
  EXPECT_EQ(of(1e-4), "cm² #,##0.000");
  EXPECT_EQ(of(0.0999), "cm² #,##0.00");
  EXPECT_EQ(of(0.1), "m² #,##0.0000");
  EXPECT_EQ(of(123456), "m² #,##0.00");
  EXPECT_EQ(of(1e-300), "mm² #,##0.000000000000");
}

Sheet areas() {
  Sheet sheet{"report", {"class", "area_m2", "scan/salt area_m2"}, {}};
  sheet.rows = {{std::string("Salt"), 0.25, 2e-6}, {std::string("total"), 0.5, {}}};
  return sheet;
}

TEST(ReadableArea, each_column_comes_again_in_its_own_unit_and_stays_for_scripts) {
  Sheet sheet = areas();
  add_readable_areas(sheet);
  EXPECT_EQ(sheet.heads, (std::vector<std::string>{"class", "area_m2", "scan/salt area_m2",
                                                   "area (m²)", "scan/salt area (mm²)"}));
  EXPECT_EQ(sheet.number_formats, (std::vector<std::string>{"", "#,##0.0000", "#,##0.000000000",
                                                            "#,##0.0000", "#,##0.000"}));
  EXPECT_EQ(std::get<double>(sheet.rows[0][2]), 2e-6);
  EXPECT_EQ(std::get<double>(sheet.rows[0][3]), 0.25);
  EXPECT_DOUBLE_EQ(std::get<double>(sheet.rows[0][4]), 2);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(sheet.rows[1][4]));
}

TEST(ReadableArea, a_sheet_without_areas_stays_as_it_is) {
  Sheet sheet{"empty", {"class"}, {}};
  add_readable_areas(sheet);
  EXPECT_EQ(sheet.heads, std::vector<std::string>{"class"});
}

}  // namespace
}  // namespace strata::app
