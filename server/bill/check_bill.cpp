#include "bill/check_bill.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "bill/exact_number.h"
#include "bill/formula.h"
#include "bill/items.h"
#include "bill/units.h"

namespace strata::bill {
namespace {

using protocol::BillItem;
using protocol::BillItemKind;
using protocol::BillRule;
using Measure = protocol::BillRuleMeasure;

std::string at(std::string_view list, std::size_t index) {
  return std::string(list) + "[" + std::to_string(index) + "]";
}

Result<void> check_source(const BillRule& rule, const std::string& field) {
  if (!rule.table && !rule.layer)
    return fail(ErrorCode::invalid, "Source missing",
                "A rule needs a `table` or a `layer` whose elements it counts.", field);
  if (rule.layer && !rule.model)
    return fail(ErrorCode::invalid, "Model missing",
                "A rule for one layer needs the `model` of the layer.", field + ".model");
  if (rule.where && !rule.table)
    return fail(ErrorCode::invalid, "Condition without a table",
                "`where` chooses records, so the rule needs a `table`. For a layer, use `values`.",
                field + ".where");
  if (rule.values && rule.table)
    return fail(ErrorCode::invalid, "Values of a table",
                "`values` chooses classes of a layer. For a table, use `where`.",
                field + ".values");
  if (rule.measure == Measure::length && !rule.table)
    return fail(ErrorCode::invalid, "No lines",
                "Only records have lines. Choose a `table` to count lengths.", field + ".measure");
  return {};
}

Result<void> check_measure(const BillItem& item, const BillRule& rule, const std::string& field) {
  const auto expected = measure_of_unit(item.unit);
  if (!expected)
    return fail(ErrorCode::invalid, "Unit cannot be measured",
                "Rules need the unit m2, m, m3 or St. Positions in `" + item.unit +
                    "` can only have hand measurements.",
                field + ".measure");
  if (*expected != rule.measure)
    return fail(ErrorCode::invalid, "Measure does not fit the unit",
                "A position in `" + item.unit + "` counts the measure `" +
                    std::string(name(*expected)) + "`.",
                field + ".measure");
  if (rule.depth.has_value() != (rule.measure == Measure::volume))
    return fail(ErrorCode::invalid, "Depth and measure do not fit",
                "A rule has a `depth` if it measures the volume, and only then.", field + ".depth");
  if (rule.depth && rule.depth->column && !rule.table)
    return fail(ErrorCode::invalid, "Column without a table",
                "Only records have columns. Use `metres` or a `layer` as the depth.",
                field + ".depth.column");
  if (rule.overmeasured_up_to && !rule.deduct)
    return fail(ErrorCode::invalid, "Nothing is deducted",
                "`overmeasured_up_to` has an effect only with `deduct`.",
                field + ".overmeasured_up_to");
  // The element of a layer is a class, whose size is the sum of all its pieces.
  if (rule.size && !rule.table)
    return fail(ErrorCode::invalid, "Sizes of classes",
                "Size classes need single elements, so the rule needs a `table`. Make records of "
                "the pieces of the layer first.",
                field + ".size");
  if (rule.overmeasured_up_to && !rule.table)
    return fail(ErrorCode::invalid, "Sizes of classes",
                "Openings are compared one by one, so the rule needs a `table`. Make records of "
                "the pieces of the layer first.",
                field + ".overmeasured_up_to");
  if (item.rounding && item.rounding->smallest && !rule.table)
    return fail(ErrorCode::invalid, "Sizes of classes",
                "A smallest size needs single elements, so the rule needs a `table`. Make records "
                "of the pieces of the layer first.",
                field + ".table");
  if (rule.size && rule.measure == Measure::length && rule.size->of != protocol::BillSizeOf::length)
    return fail(ErrorCode::invalid, "Lines have no area",
                "A rule that measures lengths needs size classes `of` length.", field + ".size.of");
  if (rule.size && rule.size->over && rule.size->up_to &&
      !(*ExactNumber::parse(*rule.size->over) < *ExactNumber::parse(*rule.size->up_to)))
    return fail(ErrorCode::invalid, "Empty size class", "`over` must be less than `up_to`.",
                field + ".size.up_to");
  return {};
}

Result<void> check_position(const BillItem& item, const std::string& field) {
  const auto rules = rules_of(item);
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const std::string of_rule = field + at(".rules", i);
    STRATA_TRY(check_source(rules[i], of_rule));
    STRATA_TRY(check_measure(item, rules[i], of_rule));
  }
  const auto lines = measurements_of(item);
  for (std::size_t i = 0; i < lines.size(); ++i)
    STRATA_TRY(compute_formula(lines[i].formula, field + at(".measurements", i) + ".formula"));
  return {};
}

bool has_content(const BillItem& item) {
  return !item.unit.empty() || item.quantity || item.unit_price || item.rounding ||
         !rules_of(item).empty() || !measurements_of(item).empty();
}

}  // namespace

Result<void> check_bill(const protocol::BillWrite& bill) {
  std::set<std::string, std::less<>> numbers, groups;
  std::size_t measurements = 0;
  const auto items = items_of(bill);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const BillItem& item = items[i];
    const std::string field = at("items", i);
    if (!numbers.insert(item.number).second)
      return fail(ErrorCode::invalid, "Number used twice",
                  "The bill already has the ordinal number `" + item.number + "`.",
                  field + ".number");
    const auto point = item.number.rfind('.');
    if (point != std::string::npos && !groups.contains(item.number.substr(0, point)))
      return fail(ErrorCode::invalid, "Group missing",
                  "The bill has no group `" + item.number.substr(0, point) + "` before `" +
                      item.number + "`. Add the group first.",
                  field + ".number");
    measurements += measurements_of(item).size();
    if (measurements > kMaxMeasurements)
      return fail(ErrorCode::invalid, "Too many hand measurements",
                  "A bill can have at most " + std::to_string(kMaxMeasurements) +
                      " hand measurements. Divide it into several bills.",
                  field + ".measurements");
    if (item.kind == BillItemKind::group) {
      groups.insert(item.number);
      if (has_content(item))
        return fail(ErrorCode::invalid, "Group with a quantity",
                    "Only positions have a unit, quantities, prices and rules.", field);
    }
    STRATA_TRY(check_position(item, field));
  }
  return {};
}

void sign_measurements(protocol::BillWrite& bill, const protocol::BillWrite& before,
                       const std::string& user, const std::string& time) {
  using Content = std::tuple<std::string, std::string, std::string, std::string, std::string>;
  const auto content = [](const std::string& number, const protocol::HandMeasurement& line) {
    return Content{number, line.text, line.formula, line.replaces.value_or(""), line.remark};
  };
  std::multimap<Content, const protocol::HandMeasurement*> signed_lines;
  for (const BillItem& item : items_of(before))
    for (const auto& line : measurements_of(item))
      signed_lines.emplace(content(item.number, line), &line);
  if (!bill.items) return;
  std::vector<protocol::HandMeasurement*> moved;
  const auto sign = [&](protocol::HandMeasurement& line, const Content& key) {
    const auto known = signed_lines.find(key);
    if (known == signed_lines.end()) return false;
    line.user = known->second->user;
    line.time = known->second->time;
    signed_lines.erase(known);
    return true;
  };
  for (BillItem& item : *bill.items) {
    if (!item.measurements) continue;
    for (auto& line : *item.measurements)
      if (!sign(line, content(item.number, line))) moved.push_back(&line);
  }
  // The same lines under other numbers: their positions were numbered again.
  std::multimap<Content, const protocol::HandMeasurement*> rest;
  for (const auto& [key, line] : signed_lines) rest.emplace(content("", *line), line);
  signed_lines = std::move(rest);
  for (protocol::HandMeasurement* line : moved)
    if (!sign(*line, content("", *line))) {
      line->user = user;
      line->time = time;
    }
}

}  // namespace strata::bill
