#include "bill/check_bill.h"

#include <gtest/gtest.h>

namespace {

using namespace strata;
using protocol::BillItem;
using protocol::BillRule;

BillRule rule_of_layer() {
  BillRule rule;
  rule.model = 1;
  rule.layer = 2;
  rule.measure = protocol::BillRuleMeasure::area;
  return rule;
}

protocol::BillWrite bill_with(const BillItem& item) {
  protocol::BillWrite bill;
  bill.name = "Facade";
  bill.items = {item};
  return bill;
}

BillItem position(const BillRule& rule) {
  BillItem item;
  item.number = "0010";
  item.unit = "m2";
  item.rules = {rule};
  return item;
}

// The element of a layer is a whole class: 20 windows of 1 m² would be one opening of 20 m².
TEST(CheckBill, sizes_need_single_elements) {
  ASSERT_TRUE(bill::check_bill(bill_with(position(rule_of_layer()))));
  BillRule sized = rule_of_layer(), openings = rule_of_layer();
  sized.size = protocol::BillSize{};
  sized.size->up_to = "0.5";
  openings.deduct = true;
  openings.overmeasured_up_to = "2.5";
  BillItem smallest = position(rule_of_layer());
  smallest.rounding = protocol::BillRounding{};
  smallest.rounding->smallest = "0.1";
  const std::pair<BillItem, std::string> wrong[] = {
      {position(sized), "items[0].rules[0].size"},
      {position(openings), "items[0].rules[0].overmeasured_up_to"},
      {smallest, "items[0].rules[0].table"}};
  for (const auto& [item, field] : wrong) {
    const auto checked = bill::check_bill(bill_with(item));
    ASSERT_FALSE(checked) << field;
    EXPECT_EQ(checked.error().field, field);
    BillItem of_records = item;
    of_records.rules->front().layer.reset();
    of_records.rules->front().model.reset();
    of_records.rules->front().table = 3;
    EXPECT_TRUE(bill::check_bill(bill_with(of_records))) << field;
  }
}

TEST(SignMeasurements, a_position_with_a_new_number_keeps_who_entered_its_lines) {
  BillItem item;
  item.number = "0010";
  protocol::HandMeasurement plinth, cornice;
  plinth.formula = "2 * 1.2";
  cornice.formula = "3";
  item.measurements = {plinth, cornice};
  protocol::BillWrite before = bill_with(item);
  bill::sign_measurements(before, {}, "ada", "2026-01-01");

  protocol::BillWrite after = before;
  after.items->front().number = "0020";
  after.items->front().measurements->at(1).formula = "4";
  bill::sign_measurements(after, before, "bert", "2026-02-02");
  const auto& lines = *after.items->front().measurements;
  EXPECT_EQ(lines[0].user, "ada");
  EXPECT_EQ(lines[0].time, "2026-01-01");
  EXPECT_EQ(lines[1].user, "bert") << "the line was changed";
}

TEST(SignMeasurements, equal_lines_of_two_positions_keep_their_own_signatures) {
  protocol::BillWrite before;
  protocol::HandMeasurement line;
  line.formula = "1";
  for (const char* number : {"0010", "0020"}) {
    BillItem item;
    item.number = number;
    item.measurements = {line};
    protocol::BillWrite one = bill_with(item);
    bill::sign_measurements(one, {}, number, "2026-01-01");
    if (!before.items) before.items.emplace();
    before.items->push_back(one.items->front());
  }
  protocol::BillWrite after = before;
  std::swap(after.items->at(0), after.items->at(1));
  bill::sign_measurements(after, before, "bert", "2026-02-02");
  EXPECT_EQ(after.items->at(0).measurements->front().user, "0020");
  EXPECT_EQ(after.items->at(1).measurements->front().user, "0010");
}

}  // namespace
