#include "bill/measure.h"

#include <gtest/gtest.h>

#include "bill/check_bill.h"

namespace strata::bill {
namespace {

using Measure = protocol::BillRuleMeasure;

Element element(std::string id, double value) {
  Element made;
  made.id = std::move(id);
  made.measured = made.size = ExactNumber::measured(value);
  return made;
}

protocol::BillRule area_rule() {
  protocol::BillRule rule;
  rule.table = 1;
  rule.measure = Measure::area;
  return rule;
}

protocol::BillItem position(std::vector<protocol::BillRule> rules) {
  protocol::BillItem item;
  item.number = "01";
  item.unit = "m2";
  item.rules = std::move(rules);
  return item;
}

std::vector<std::string> effects(const Position& measured) {
  std::vector<std::string> names;
  for (const Line& line : measured.lines) names.emplace_back(name(line.effect));
  return names;
}

TEST(Measure, rounds_the_sum_or_each_element) {
  auto item = position({area_rule()});
  const std::vector<std::vector<Element>> elements{
      {element("a", 1.004), element("b", 1.004), element("c", 1.004)}};
  EXPECT_EQ(measure(item, elements)->quantity.text(2), "3.01");
  item.rounding = protocol::BillRounding{};
  item.rounding->each = protocol::BillRoundingEach::element;
  EXPECT_EQ(measure(item, elements)->quantity.text(2), "3.00");
}

TEST(Measure, divides_elements_into_size_classes_without_a_gap) {
  auto small = area_rule(), middle = area_rule(), large = area_rule();
  small.size = protocol::BillSize{};
  small.size->up_to = "0.1";
  middle.size = protocol::BillSize{};
  middle.size->over = "0.1";
  middle.size->up_to = "0.5";
  large.size = protocol::BillSize{};
  large.size->over = "0.5";
  const std::vector<Element> all{element("a", 0.05), element("b", 0.1), element("c", 0.100001),
                                 element("d", 0.5), element("e", 0.6)};
  const auto lines = [&](const protocol::BillRule& rule) {
    std::string ids;
    const auto measured = measure(position({rule}), {all});
    for (const Line& line : measured->lines) ids += line.element.id;
    return ids;
  };
  EXPECT_EQ(lines(small), "ab");
  EXPECT_EQ(lines(middle), "cd");
  EXPECT_EQ(lines(large), "e");
}

TEST(Measure, small_openings_are_overmeasured) {
  auto openings = area_rule();
  openings.deduct = true;
  openings.overmeasured_up_to = "2.5";
  const auto measured =
      measure(position({area_rule(), openings}),
              {{element("wall", 20)}, {element("window", 2.5), element("door", 2.500001)}});
  EXPECT_EQ(measured->quantity.text(2), "17.50");
  EXPECT_EQ(effects(*measured), (std::vector<std::string>{"billed", "overmeasured", "deducted"}));
}

TEST(Measure, small_elements_count_as_the_smallest_size) {
  auto item = position({area_rule()});
  item.rounding = protocol::BillRounding{};
  item.rounding->smallest = "0.1";
  const auto measured = measure(item, {{element("a", 0.02), element("b", 0.3)}});
  EXPECT_EQ(measured->quantity.text(2), "0.40");
  EXPECT_EQ(effects(*measured), (std::vector<std::string>{"smallest", "billed"}));
}

TEST(Measure, hand_measurements_are_added_or_replace_a_line) {
  auto item = position({area_rule()});
  protocol::HandMeasurement added, replacing;
  added.formula = "2 * 1,20 * 0,85";
  replacing.formula = "4,5";
  replacing.replaces = "a";
  item.measurements = {added, replacing};
  item.unit_price = "35.555";
  const auto measured = measure(item, {{element("a", 4.1), element("b", 1)}});
  EXPECT_EQ(measured->quantity.text(2), "7.54");
  EXPECT_EQ(measured->total->text(2), "268.08");  // 7.54 * 35.555 = 268.0847
  EXPECT_EQ(effects(*measured),
            (std::vector<std::string>{"replaced", "billed", "billed", "billed"}));
  item.measurements->back().replaces = "gone";
  const auto refused = measure(item, {{element("a", 4.1)}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "replaces");
}

TEST(Measure, applies_the_factor_of_a_rule) {
  auto rule = area_rule();
  rule.factor = "2";
  EXPECT_EQ(measure(position({rule}), {{element("a", 1.25)}})->quantity.text(2), "2.50");
}

protocol::BillWrite bill(std::vector<protocol::BillItem> items) {
  protocol::BillWrite made;
  made.name = "Bill";
  made.items = std::move(items);
  return made;
}

std::string field_of_error(const protocol::BillWrite& made) {
  const auto good = check_bill(made);
  return good ? "" : good.error().field;
}

TEST(CheckBill, names_the_field_of_a_mistake) {
  EXPECT_EQ(field_of_error(bill({position({area_rule()})})), "");
  EXPECT_EQ(field_of_error(bill({position({}), position({})})), "items[1].number");
  auto deep = position({});
  deep.number = "02.0010";
  EXPECT_EQ(field_of_error(bill({deep})), "items[0].number");
  auto other_unit = position({area_rule()});
  other_unit.unit = "m";
  EXPECT_EQ(field_of_error(bill({other_unit})), "items[0].rules[0].measure");
  other_unit.unit = "psch";
  EXPECT_EQ(field_of_error(bill({other_unit})), "items[0].rules[0].measure");
  auto no_depth = area_rule();
  no_depth.measure = Measure::volume;
  auto volume = position({no_depth});
  volume.unit = "m3";
  EXPECT_EQ(field_of_error(bill({volume})), "items[0].rules[0].depth");
  auto no_source = area_rule();
  no_source.table.reset();
  EXPECT_EQ(field_of_error(bill({position({no_source})})), "items[0].rules[0]");
  auto bad_formula = position({});
  protocol::HandMeasurement hand;
  hand.formula = "2 *";
  bad_formula.measurements = {hand};
  EXPECT_EQ(field_of_error(bill({bad_formula})), "items[0].measurements[0].formula");
  auto group = position({area_rule()});
  group.kind = protocol::BillItemKind::group;
  EXPECT_EQ(field_of_error(bill({group})), "items[0]");
}

TEST(SignMeasurements, keeps_the_author_of_unchanged_lines) {
  protocol::HandMeasurement line;
  line.formula = "1";
  line.user = "forged";
  auto item = position({});
  item.measurements = {line, line};
  auto before = bill({item});
  sign_measurements(before, {}, "ada", "2026-01-01");
  EXPECT_EQ(before.items->front().measurements->front().user, "ada");
  auto after = before;
  after.items->front().measurements->front().user = "eve";
  after.items->front().measurements->back().formula = "2";
  sign_measurements(after, before, "bob", "2026-02-02");
  const auto& lines = *after.items->front().measurements;
  EXPECT_EQ(lines.front().user, "ada");
  EXPECT_EQ(lines.front().time, "2026-01-01");
  EXPECT_EQ(lines.back().user, "bob");
}

}  // namespace
}  // namespace strata::bill
