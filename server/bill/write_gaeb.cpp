#include <algorithm>
#include <cstdio>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "bill/gaeb.h"
#include "bill/items.h"
#include "bill/reb_rows.h"
#include "bill/units.h"
#include "core/text/printable.h"
#include "core/text/utf8.h"

namespace strata::bill {
namespace {

using protocol::BillItem;
using protocol::BillItemKind;

constexpr int kQuantityPlaces = 3, kPricePlaces = 2;  // tgDecimal_11_3 and tgDecimal_13_2
constexpr std::size_t kMaxLevels = 6;                 // of groups
constexpr std::size_t kMaxIndex = 4;                  // characters of an RNoIndex
constexpr std::size_t kUnitCharacters = 4;            // tgQU

void add(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text().set(printable(text).c_str());
}

std::string cut(const std::string& text, std::size_t most) {
  return std::string(first_bytes(text, most));
}

std::vector<std::string> parts_of(const std::string& number) {
  std::vector<std::string> parts;
  std::istringstream in(number);
  for (std::string part; std::getline(in, part, '.');) parts.push_back(part);
  return parts;
}

void add_paragraphs(pugi::xml_node parent, const std::string& text) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    add(parent.append_child("p"), "span", line.empty() ? " " : line);
}

class Writer {
 public:
  Writer(const protocol::BillWrite& bill, std::span<const Position> positions, GaebPhase phase)
      : bill_(bill), positions_(positions), phase_(phase) {}

  Result<std::string> write(const GaebFacts& facts) {
    STRATA_TRY(find_levels());
    auto declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    const std::string number(number_of(phase_));
    pugi::xml_node root = document_.append_child("GAEB");
    root.append_attribute("xmlns") =
        ("http://www.gaeb.de/GAEB_DA_XML/DA" + number + "/3.3").c_str();
    pugi::xml_node info = root.append_child("GAEBInfo");
    add(info, "Version", "3.3");
    add(info, "VersDate", "2021-05");
    add(info, "Date", facts.date);
    add(info, "Time", facts.time);
    add(info, "ProgSystem", "Strata");
    pugi::xml_node boq =
        phase_ == GaebPhase::x31 ? begin_quantities(root, facts) : begin_award(root, facts);
    STRATA_TRY(add_items(boq.append_child("BoQBody")));
    std::ostringstream out;
    document_.save(out, " ", pugi::format_indent, pugi::encoding_utf8);
    return out.str();
  }

 private:
  bool has_texts() const { return phase_ == GaebPhase::x83 || phase_ == GaebPhase::x86; }

  // GAEB numbers each level with the same number of characters, and has positions only on the
  // lowest level.
  Result<void> find_levels() {
    for (const BillItem& item : items_of(bill_)) {
      const auto parts = parts_of(item.number);
      if (item.kind == BillItemKind::group) {
        if (parts.size() > kMaxLevels)
          return fail(ErrorCode::invalid, "Too many levels",
                      "GAEB allows at most 6 levels of groups, but `" + item.number + "` has more.",
                      "format");
        widths_.resize(std::max(widths_.size(), parts.size()), 1);
        widths_[parts.size() - 1] = std::max(widths_[parts.size() - 1], parts.back().size());
        continue;
      }
      if (levels_ && *levels_ != parts.size())
        return fail(ErrorCode::invalid, "Positions on different levels",
                    "GAEB needs all positions on the same level, but `" + item.number +
                        "` has another number of parts. Number the positions again.",
                    "format");
      levels_ = parts.size();
      position_width_ = std::max(position_width_, without_index(parts.back()).size());
    }
    if (levels_) widths_.resize(*levels_ - 1, 1);
    return {};
  }

  static std::string index_of(const std::string& part) {
    const auto mark = part.rfind('_');
    const bool has_index =
        mark != std::string::npos && mark > 0 && part.size() - mark - 1 <= kMaxIndex;
    return has_index ? part.substr(mark + 1) : "";
  }
  static std::string without_index(const std::string& part) {
    const auto index = index_of(part);
    return index.empty() ? part : part.substr(0, part.size() - index.size() - 1);
  }

  void add_breakdown(pugi::xml_node parent) const {
    const auto level = [&](const char* type, std::size_t width) {
      pugi::xml_node one = parent.append_child("BoQBkdn");
      add(one, "Type", type);
      add(one, "Length", std::to_string(width));
      add(one, "Num", "Yes");
    };
    for (const std::size_t width : widths_) level("BoQLevel", width);
    level("Item", position_width_);
  }

  pugi::xml_node begin_quantities(pugi::xml_node root, const GaebFacts& facts) {
    pugi::xml_node all = root.append_child("QtyDeterm");
    add(all.append_child("PrjInfo"), "RefPrjName", cut(facts.project, 60));
    add(all.append_child("QtyDetermInfo"), "MethodDescription", "REB23003-2009");
    add(all, "DP", "31");
    pugi::xml_node boq = all.append_child("BoQ");
    boq.append_attribute("ID") = "B1";
    add(boq, "RefBoQName", cut(bill_.name, 20));
    add_breakdown(boq);
    return boq;
  }

  pugi::xml_node begin_award(pugi::xml_node root, const GaebFacts& facts) {
    pugi::xml_node project = root.append_child("PrjInfo");
    add(project, "NamePrj", cut(facts.project, 20));
    add(project, "LblPrj", cut(facts.project, 60));
    add(project, "Cur", bill_.currency);
    pugi::xml_node award = root.append_child("Award");
    add(award, "DP", std::string(number_of(phase_)));
    add(award.append_child("AwardInfo"), "Cur", bill_.currency);
    pugi::xml_node boq = award.append_child("BoQ");
    boq.append_attribute("ID") = "B1";
    pugi::xml_node info = boq.append_child("BoQInfo");
    add(info, "Name", cut(bill_.name, 20));
    if (phase_ != GaebPhase::x84) {
      add(info, "LblBoQ", cut(bill_.name, 60));
      add(info, "Date", facts.date);
      add(info, "OutlCompl", "AllTxt");
    }
    add_breakdown(info);
    return boq;
  }

  // Returns the element that contains the parts of a level: the body of the bill or of a group, or
  // its list of positions.
  Result<void> add_items(pugi::xml_node body) {
    std::map<std::string, pugi::xml_node> bodies{{"", body}};
    const auto items = items_of(bill_);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const BillItem& item = items[i];
      const auto point = item.number.rfind('.');
      pugi::xml_node parent =
          bodies.at(point == std::string::npos ? "" : item.number.substr(0, point));
      const std::string part = item.number.substr(point == std::string::npos ? 0 : point + 1);
      if (item.kind == BillItemKind::group) {
        pugi::xml_node group = parent.append_child("BoQCtgy");
        group.append_attribute("ID") = ("C" + std::to_string(i + 1)).c_str();
        group.append_attribute("RNoPart") = part.c_str();
        if (has_texts()) add_paragraphs(group.append_child("LblTx"), item.short_text);
        pugi::xml_node inner = group.append_child("BoQBody");
        if (has_texts() && !item.long_text.empty())
          add_paragraphs(inner.append_child("Remark")
                             .append_child("Description")
                             .append_child("CompleteText")
                             .append_child("DetailTxt")
                             .append_child("Text"),
                         item.long_text);
        bodies[item.number] = inner;
        continue;
      }
      pugi::xml_node list = parent.child("Itemlist");
      if (!list) list = parent.append_child("Itemlist");
      pugi::xml_node node = list.append_child("Item");
      node.append_attribute("ID") = ("I" + std::to_string(i + 1)).c_str();
      node.append_attribute("RNoPart") = without_index(part).c_str();
      if (const auto index = index_of(part); !index.empty())
        node.append_attribute("RNoIndex") = index.c_str();
      STRATA_TRY(phase_ == GaebPhase::x31 ? add_proof(node, item, positions_[i])
                                          : add_position(node, item, positions_[i]));
    }
    // GAEB allows no group without content.
    for (auto found = bodies.rbegin(); found != bodies.rend(); ++found)
      if (!found->second.first_child() && !found->first.empty()) {
        pugi::xml_node group = found->second.parent();
        group.parent().remove_child(group);
      }
    return {};
  }

  Result<void> check_range(const BillItem& item, const ExactNumber& number, std::int64_t most) {
    if (number < ExactNumber(most) && ExactNumber(-most) < number) return {};
    return fail(
        ErrorCode::invalid, "Number too large for GAEB",
        "A quantity or price of position `" + item.number + "` has more digits than GAEB allows.",
        "format");
  }

  // A rounded number in the file would differ from the bill, and the receiver would compute other
  // totals.
  static Result<void> check_places(const BillItem& item, const ExactNumber& number, int places,
                                   const std::string& what) {
    if (number == number.rounded(places)) return {};
    return fail(ErrorCode::invalid, "Too many decimal places for GAEB",
                "GAEB allows " + std::to_string(places) + " decimal places, but the " + what +
                    " of position `" + item.number + "` has more. Round it, or use XLSX.",
                "format");
  }

  // Returns the unit in at most kUnitCharacters. Known longer units have a shorter form.
  static Result<std::string> unit_of(const BillItem& item) {
    if (item.unit.empty())
      return fail(ErrorCode::invalid, "Unit missing",
                  "GAEB needs the unit of position `" + item.number + "`.", "format");
    if (character_count(item.unit) <= kUnitCharacters) return item.unit;
    if (const auto measure = measure_of_unit(item.unit)) return std::string(usual_unit(*measure));
    return fail(ErrorCode::invalid, "Unit too long for GAEB",
                "GAEB allows " + std::to_string(kUnitCharacters) +
                    " characters, but the unit of position `" + item.number + "` is `" + item.unit +
                    "`. Shorten it, or use XLSX.",
                "format");
  }

  Result<void> add_position(pugi::xml_node node, const BillItem& item, const Position& position) {
    const std::string unit = STRATA_TRY(unit_of(item));
    const bool has_prices = phase_ != GaebPhase::x83;
    if (has_prices && !item.unit_price)
      return fail(ErrorCode::invalid, "Price missing",
                  "Position `" + item.number + "` has no unit price, which X" +
                      std::string(number_of(phase_)) + " needs.",
                  "format");
    const bool is_tendered = phase_ != GaebPhase::x86 && item.quantity;
    const ExactNumber quantity =
        is_tendered ? *ExactNumber::parse(*item.quantity) : position.quantity;
    STRATA_TRY(check_range(item, quantity, 100'000'000));
    STRATA_TRY(check_places(item, quantity, kQuantityPlaces, "quantity"));
    add(node, "Qty", quantity.text(kQuantityPlaces));
    add(node, "QU", unit);
    if (has_prices) {
      const ExactNumber price = *ExactNumber::parse(*item.unit_price);
      STRATA_TRY(check_places(item, price, kPricePlaces, "unit price"));
      const ExactNumber total = quantity * price;
      STRATA_TRY(check_range(item, total, 10'000'000'000));
      add(node, "UP", price.text(kPricePlaces));
      add(node, "IT", total.text(kPricePlaces));
    }
    if (phase_ == GaebPhase::x84) return {};
    pugi::xml_node text = node.append_child("Description").append_child("CompleteText");
    if (!item.long_text.empty())
      add_paragraphs(text.append_child("DetailTxt").append_child("Text"), item.long_text);
    add_paragraphs(
        text.append_child("OutlineText").append_child("OutlTxt").append_child("TextOutlTxt"),
        item.short_text.empty() ? item.number : item.short_text);
    return {};
  }

  Result<void> add_proof(pugi::xml_node node, const BillItem& item, const Position& position) {
    STRATA_TRY(check_range(item, position.quantity, 100'000'000));
    STRATA_TRY(check_places(item, position.quantity, kQuantityPlaces, "quantity"));
    pugi::xml_node proof = node.append_child("QtyDeterm");
    add(proof, "Qty", position.quantity.text(kQuantityPlaces));
    for (const Line& line : position.lines) {
      const auto rows = STRATA_TRY(rows_.of(line, item));
      for (const std::string& row : rows)
        proof.append_child("QDetermItem").append_child("QTakeoff").append_attribute("Row") =
            row.c_str();
    }
    return {};
  }

  const protocol::BillWrite& bill_;
  const std::span<const Position> positions_;
  const GaebPhase phase_;
  pugi::xml_document document_;
  std::vector<std::size_t> widths_;  // characters of the numbers of groups, by level
  std::size_t position_width_ = 1;
  std::optional<std::size_t> levels_;
  RebRows rows_;
};

}  // namespace

Result<std::string> write_gaeb(const protocol::BillWrite& bill, std::span<const Position> positions,
                               GaebPhase phase, const GaebFacts& facts) {
  return Writer(bill, positions, phase).write(facts);
}

}  // namespace strata::bill
