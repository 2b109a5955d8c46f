#include "app/bills/measured_bill.h"

#include "bill/items.h"

namespace strata::app {
namespace {

constexpr int kPricePlaces = 2;

std::string item_field(std::size_t item) { return "items[" + std::to_string(item) + "]"; }

tl::unexpected<Error> at_field(Error problem, const std::string& field) {
  problem.field = field + (problem.field.empty() ? "" : "." + problem.field);
  return tl::unexpected(std::move(problem));
}

nlohmann::json line_json(const bill::Line& line) {
  const bill::Element& element = line.element;
  nlohmann::json json{{"id", element.id},
                      {"title", element.title},
                      {"measured", element.measured.short_text()},
                      {"factor", line.factor.short_text()},
                      {"billed", line.billed.short_text()},
                      {"effect", name(line.effect)}};
  const auto add_number = [&](const char* member, std::int64_t value) {
    if (value > 0) json[member] = value;
  };
  const auto add_text = [&](const char* member, const std::string& text) {
    if (!text.empty()) json[member] = text;
  };
  add_number("rule", line.rule);
  add_number("model", element.model);
  add_number("layer", element.layer);
  add_number("table", element.table);
  add_number("key", element.key);
  add_text("model_name", element.model_name);
  add_text("layer_name", element.layer_name);
  add_text("figure", line.figure);
  add_text("link", element.link);
  add_text("formula", line.formula);
  add_text("remark", line.remark);
  add_text("user", line.user);
  add_text("time", line.time);
  return json;
}

}  // namespace

Result<MeasuredBill> measured_bill(const Services& services, const BillSource& source,
                                   protocol::BillWrite bill) {
  BillElements reader(services, source);
  MeasuredBill measured;
  std::size_t lines = 0;
  const auto items = bill::items_of(bill);
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::vector<std::vector<bill::Element>> elements;
    const auto rules = bill::rules_of(items[i]);
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto of_rule = reader.of(rules[r]);
      if (!of_rule)
        return at_field(of_rule.error(), item_field(i) + ".rules[" + std::to_string(r) + "]");
      elements.push_back(std::move(*of_rule));
    }
    auto position = bill::measure(items[i], elements);
    if (!position) return at_field(position.error(), item_field(i));
    lines += position->lines.size();
    if (lines > bill::kMaxLines)
      return fail(ErrorCode::invalid, "Too many lines",
                  "A bill can have at most " + std::to_string(bill::kMaxLines) +
                      " lines. Divide it into several bills.",
                  item_field(i));
    if (position->total) measured.total += *position->total;
    measured.positions.push_back(std::move(*position));
  }
  measured.bill = std::move(bill);
  return measured;
}

nlohmann::json to_json(const MeasuredBill& measured) {
  nlohmann::json positions = nlohmann::json::array();
  const auto items = bill::items_of(measured.bill);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const protocol::BillItem& item = items[i];
    if (item.kind == protocol::BillItemKind::group) continue;
    const bill::Position& position = measured.positions[i];
    const int places = item.rounding.value_or(protocol::BillRounding{}).places;
    nlohmann::json lines = nlohmann::json::array();
    for (const bill::Line& line : position.lines) lines.push_back(line_json(line));
    nlohmann::json json{{"number", item.number},
                        {"short_text", item.short_text},
                        {"unit", item.unit},
                        {"quantity", position.quantity.text(places)},
                        {"lines", std::move(lines)}};
    if (item.quantity) json["tendered"] = *item.quantity;
    if (item.unit_price) json["unit_price"] = *item.unit_price;
    if (position.total) json["total"] = position.total->text(kPricePlaces);
    positions.push_back(std::move(json));
  }
  return {{"currency", measured.bill.currency},
          {"positions", std::move(positions)},
          {"total", measured.total.text(kPricePlaces)}};
}

}  // namespace strata::app
