#include "bill/measure.h"

#include <map>

#include "bill/formula.h"
#include "bill/items.h"

namespace strata::bill {
namespace {

using protocol::BillItem;
using protocol::BillRounding;
using protocol::BillRule;

constexpr int kPricePlaces = 2;

std::optional<ExactNumber> number_of(const std::optional<std::string>& text) {
  return text ? ExactNumber::parse(*text) : std::nullopt;
}

bool is_in_class(const BillRule& rule, const Element& element) {
  if (!rule.size) return true;
  const auto over = number_of(rule.size->over), up_to = number_of(rule.size->up_to);
  return (!over || *over < element.size) && (!up_to || !(*up_to < element.size));
}

bool rounds_each(const BillRounding& rounding) {
  return rounding.each == protocol::BillRoundingEach::element;
}

ExactNumber rounded_element(const BillRounding& rounding, const ExactNumber& value) {
  return rounds_each(rounding) ? value.rounded(rounding.places, rounding.mode) : value;
}

Line line_of(const BillRule& rule, const BillRounding& rounding, const Element& element) {
  Line line;
  line.element = element;
  line.figure = rule.figure;
  line.factor = number_of(rule.factor).value_or(ExactNumber(1));
  ExactNumber counted = element.measured;
  if (rule.deduct) {
    const auto limit = number_of(rule.overmeasured_up_to);
    const bool is_small = limit && !(*limit < element.measured);
    line.effect = is_small ? Effect::overmeasured : Effect::deducted;
    counted = is_small ? ExactNumber(0) : -counted;
  } else if (const auto smallest = number_of(rounding.smallest); smallest && counted < *smallest) {
    line.effect = Effect::smallest;
    counted = *smallest;
  }
  line.billed = rounded_element(rounding, counted * line.factor);
  return line;
}

Result<Line> line_of(const protocol::HandMeasurement& hand, const BillRounding& rounding,
                     std::size_t index) {
  Line line;
  line.element.id = "hand " + std::to_string(index + 1);
  line.element.title = hand.text;
  line.element.measured = STRATA_TRY(compute_formula(hand.formula, "formula"));
  line.formula = hand.formula;
  line.remark = hand.remark;
  line.user = hand.user;
  line.time = hand.time;
  line.billed = rounded_element(rounding, line.element.measured);
  return line;
}

// Adds the hand measurements. Lines that they replace no longer count.
Result<void> add_hand_measurements(const BillItem& item, const BillRounding& rounding,
                                   std::vector<Line>& lines) {
  std::multimap<std::string, std::size_t> of_element;
  for (std::size_t i = 0; i < lines.size(); ++i) of_element.emplace(lines[i].element.id, i);
  const auto hands = measurements_of(item);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    if (const auto& replaced = hands[i].replaces) {
      const auto [begin, end] = of_element.equal_range(*replaced);
      if (begin == end)
        return fail(ErrorCode::invalid, "Replaced line not found",
                    "Position `" + item.number + "` no longer measures `" + *replaced +
                        "`, which a hand measurement replaces. Remove `replaces` from the hand "
                        "measurement, or remove the hand measurement.",
                    "replaces");
      for (auto found = begin; found != end; ++found) {
        lines[found->second].effect = Effect::replaced;
        lines[found->second].billed = ExactNumber(0);
      }
    }
    auto line = STRATA_TRY(line_of(hands[i], rounding, i));
    lines.push_back(std::move(line));
  }
  return {};
}

}  // namespace

std::string_view name(Effect effect) {
  switch (effect) {
    case Effect::billed: return "billed";
    case Effect::smallest: return "smallest";
    case Effect::deducted: return "deducted";
    case Effect::overmeasured: return "overmeasured";
    case Effect::replaced: return "replaced";
  }
  return "";
}

Result<Position> measure(const BillItem& item, const std::vector<std::vector<Element>>& elements) {
  const BillRounding rounding = item.rounding.value_or(BillRounding{});
  Position position;
  const auto rules = rules_of(item);
  for (std::size_t i = 0; i < rules.size() && i < elements.size(); ++i)
    for (const Element& element : elements[i]) {
      if (!is_in_class(rules[i], element)) continue;
      position.lines.push_back(line_of(rules[i], rounding, element));
      position.lines.back().rule = static_cast<int>(i) + 1;
    }
  STRATA_TRY(add_hand_measurements(item, rounding, position.lines));
  ExactNumber sum;
  for (const Line& line : position.lines) sum += line.billed;
  position.quantity = sum.rounded(rounding.places, rounding.mode);
  if (const auto price = number_of(item.unit_price))
    position.total = (position.quantity * *price).rounded(kPricePlaces);
  if (!position.quantity.is_valid() || (position.total && !position.total->is_valid()))
    return fail(ErrorCode::invalid, "Number too large",
                "The quantity of position `" + item.number +
                    "` is too large to be computed exactly. Check its factors and hand "
                    "measurements.",
                "items");
  return position;
}

std::string rounding_text(const BillItem& item) {
  const BillRounding rounding = item.rounding.value_or(BillRounding{});
  return std::string(name(rounding.each)) + ", " + std::to_string(rounding.places) + ", " +
         std::string(name(rounding.mode)) +
         (rounding.smallest ? ", smallest " + *rounding.smallest : "");
}

}  // namespace strata::bill
