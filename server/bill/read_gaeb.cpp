#include <algorithm>
#include <array>
#include <cctype>
#include <pugixml.hpp>

#include "bill/exact_number.h"
#include "bill/gaeb.h"
#include "core/text/printable.h"
#include "core/text/utf8.h"

namespace strata::bill {
namespace {

using protocol::BillItem;
using protocol::BillItemKind;

constexpr std::size_t kMaxItems = 5000, kMaxShortText = 1000, kMaxLongText = 50'000, kMaxName = 200,
                      kMaxUnit = 20, kMaxRemarks = 50;
constexpr int kMaxLevels = 7, kMaxTextDepth = 30;
constexpr std::size_t kMaxPart = 14;

// The prefix of the namespace depends on the program that wrote the file.
std::string_view local_name(pugi::xml_node node) {
  const std::string_view name = node.name();
  const auto colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

pugi::xml_node child(pugi::xml_node node, std::string_view name) {
  for (const pugi::xml_node one : node.children())
    if (local_name(one) == name) return one;
  return {};
}

pugi::xml_node at_path(pugi::xml_node node, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) node = child(node, name);
  return node;
}

std::string trimmed(std::string text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  text.erase(std::ranges::find_if_not(text.rbegin(), text.rend(), is_space).base(), text.end());
  text.erase(text.begin(), std::ranges::find_if_not(text, is_space));
  return text;
}

std::string value_at(pugi::xml_node node, std::initializer_list<std::string_view> names) {
  return trimmed(printable(at_path(node, names).child_value()));
}

// Adds the text of a node: a line for each paragraph and line break. Spaces inside a line are
// joined, because programs indent their files.
void add_text(pugi::xml_node node, std::string& text, int depth) {
  if (depth > kMaxTextDepth) return;
  for (const pugi::xml_node part : node.children()) {
    if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) {
      for (const char c : std::string_view(part.value())) {
        const bool is_space = std::isspace(static_cast<unsigned char>(c)) != 0;
        if (!is_space)
          text += c;
        else if (!text.empty() && text.back() != ' ' && text.back() != '\n')
          text += ' ';
      }
      continue;
    }
    const auto name = local_name(part);
    if (name == "attachment" || name == "image") continue;
    const bool is_block = name == "p" || name == "div" || name == "li" || name == "tr";
    if ((is_block || name == "br") && !text.empty() && text.back() != '\n') text += '\n';
    add_text(part, text, depth + 1);
    if (is_block && !text.empty() && text.back() != '\n') text += '\n';
  }
}

std::string text_of(pugi::xml_node node) {
  std::string text;
  add_text(node, text, 0);
  return trimmed(printable(text));
}

tl::unexpected<Error> refused(ErrorCode code, std::string title, std::string detail) {
  return fail(code, std::move(title), std::move(detail), "body");
}

class Reader {
 public:
  Result<GaebBill> read(pugi::xml_node root) {
    const pugi::xml_node award = child(root, "Award");
    result_.phase = phase_of(root, award);
    static constexpr std::array kPhases{"80", "81", "82", "83", "84", "85", "86"};
    if (std::ranges::find(kPhases, result_.phase) == kPhases.end())
      return refused(ErrorCode::unsupported, "Phase not supported",
                     "The file is of the phase X" + result_.phase +
                         ". Export the bill as X81 or X83 (tender), X84 or X86.");
    const pugi::xml_node boq = child(award, "BoQ"), info = child(boq, "BoQInfo");
    if (!child(boq, "BoQBody"))
      return refused(ErrorCode::invalid, "No bill in the file",
                     "The file has no positions (BoQBody). Export the bill with its positions.");
    result_.bill.name = value_at(info, {"LblBoQ"});
    for (const std::string& name :
         {value_at(info, {"Name"}), value_at(root, {"PrjInfo", "NamePrj"}), std::string("Bill")})
      if (result_.bill.name.empty()) result_.bill.name = name;
    shorten(result_.bill.name, kMaxName, "name of the bill");
    for (const std::string& currency :
         {value_at(root, {"PrjInfo", "Cur"}), value_at(award, {"AwardInfo", "Cur"})})
      if (currency.size() == 3 &&
          std::ranges::all_of(currency, [](unsigned char c) { return c >= 'A' && c <= 'Z'; }))
        result_.bill.currency = currency;
    STRATA_TRY(body(child(boq, "BoQBody"), "", 1));
    result_.bill.items = std::move(items_);
    return std::move(result_);
  }

 private:
  static std::string phase_of(pugi::xml_node root, pugi::xml_node award) {
    std::string phase = value_at(award, {"DP"});
    if (phase.empty()) phase = value_at(root, {"QtyDeterm", "DP"});
    if (phase.starts_with('X') || phase.starts_with('x')) phase.erase(0, 1);
    return phase.substr(0, 10);
  }

  void remark(std::string text) {
    if (result_.remarks.size() < kMaxRemarks) result_.remarks.push_back(std::move(text));
  }

  void shorten(std::string& text, std::size_t most, const std::string& what) {
    if (text.size() <= most) return;
    text = std::string(first_bytes(text, most));
    remark("The " + what + " was shortened to " + std::to_string(most) + " bytes.");
  }

  Result<std::string> number_of(pugi::xml_node node, const std::string& group) {
    std::string part = trimmed(node.attribute("RNoPart").value());
    const std::string index = trimmed(node.attribute("RNoIndex").value());
    if (!index.empty()) part += "_" + index;
    const bool is_good =
        !part.empty() && part.size() <= kMaxPart && std::ranges::all_of(part, [](unsigned char c) {
          return c < 0x80 && (std::isalnum(c) != 0 || c == '_');
        });
    if (!is_good)
      return refused(ErrorCode::invalid, "Ordinal number not readable",
                     "In " + (group.empty() ? "the bill" : "`" + group + "`") +
                         ", the ordinal number `" + printable(part.substr(0, 40)) +
                         "` is missing, too long, or has other characters than letters and "
                         "digits. Number the bill again, and export it again.");
    return group.empty() ? part : group + "." + part;
  }

  Result<BillItem*> add(pugi::xml_node node, const std::string& group, BillItemKind kind) {
    if (items_.size() >= kMaxItems)
      return refused(ErrorCode::too_large, "Too many positions",
                     "A bill can have at most " + std::to_string(kMaxItems) +
                         " groups and positions. Export parts of the bill.");
    BillItem item;
    item.number = STRATA_TRY(number_of(node, group));
    item.kind = kind;
    items_.push_back(std::move(item));
    return &items_.back();
  }

  Result<void> body(pugi::xml_node node, const std::string& group, int level) {
    if (level > kMaxLevels)
      return refused(ErrorCode::invalid, "Too many levels",
                     "A bill can have at most " + std::to_string(kMaxLevels) + " levels.");
    const std::size_t group_index = items_.size() - 1;  // only used with a group
    for (const pugi::xml_node part : node.children()) {
      const auto name = local_name(part);
      if (name == "BoQCtgy") {
        const BillItem* item = STRATA_TRY(add(part, group, BillItemKind::group));
        const std::string number = item->number;
        BillItem& fresh = items_.back();
        fresh.short_text = text_of(child(part, "LblTx"));
        std::ranges::replace(fresh.short_text, '\n', ' ');
        shorten(fresh.short_text, kMaxShortText, "title of " + number);
        for (const std::string_view inner : {"BoQBody", "Itemlist"})
          if (const auto found = child(part, inner))
            STRATA_TRY(body(inner == "Itemlist" ? part : found, number, level + 1));
      } else if (name == "Itemlist") {
        for (const pugi::xml_node one : part.children()) {
          if (local_name(one) == "Item")
            STRATA_TRY(position(one, group));
          else
            keep_note(one, group, group_index);
        }
      } else {
        keep_note(part, group, group_index);
      }
    }
    return {};
  }

  Result<void> position(pugi::xml_node node, const std::string& group) {
    STRATA_TRY(add(node, group, BillItemKind::position));
    BillItem& item = items_.back();
    const pugi::xml_node text = at_path(node, {"Description", "CompleteText"});
    item.short_text = text_of(at_path(text, {"OutlineText", "OutlTxt"}));
    if (item.short_text.empty())
      item.short_text = text_of(at_path(node, {"Description", "OutlineText", "OutlTxt"}));
    std::ranges::replace(item.short_text, '\n', ' ');
    item.long_text = text_of(child(text, "DetailTxt"));
    shorten(item.short_text, kMaxShortText, "short text of " + item.number);
    shorten(item.long_text, kMaxLongText, "long text of " + item.number);
    item.unit = value_at(node, {"QU"});
    shorten(item.unit, kMaxUnit, "unit of " + item.number);
    const std::string number = item.number;
    item.quantity = STRATA_TRY(decimal(value_at(node, {"Qty"}), "quantity", number));
    item.unit_price = STRATA_TRY(decimal(value_at(node, {"UP"}), "unit price", number));
    if (value_at(node, {"LumpSumItem"}) == "Yes" && item.unit.empty()) item.unit = "psch";
    if (child(node, "Provis") || child(node, "ALNGroupNo"))
      remark(number + " is an optional or alternative position. It counts like other positions.");
    return {};
  }

  // Keeps the text of a note (Remark, PerfDescr) in the long text of its group.
  void keep_note(pugi::xml_node node, const std::string& group, std::size_t group_index) {
    const std::string text = text_of(node);
    if (text.empty() || local_name(node) == "Totals") return;
    if (group.empty()) {
      remark("A note before the first group was left out: " + text.substr(0, 100));
      return;
    }
    std::string& kept = items_[group_index].long_text;
    if (!kept.empty()) kept += "\n\n";
    kept += text;
    shorten(kept, kMaxLongText, "notes of " + group);
  }

  static Result<std::optional<std::string>> decimal(const std::string& text,
                                                    const std::string& what,
                                                    const std::string& number) {
    if (text.empty()) return std::optional<std::string>();
    const auto value = ExactNumber::parse(text);
    if (!value || !(*value < ExactNumber(100'000'000'000)) ||
        !(ExactNumber(-100'000'000'000) < *value))
      return refused(ErrorCode::invalid, "Number not readable",
                     "The " + what + " of position `" + number + "` is not a decimal number: `" +
                         text.substr(0, 40) + "`. Correct the file.");
    return std::optional(value->short_text());
  }

  GaebBill result_;
  std::vector<BillItem> items_;
};

}  // namespace

Result<GaebBill> read_gaeb(std::string_view bytes) {
  if (bytes.size() > kMaxGaebBytes)
    return refused(ErrorCode::too_large, "File too large",
                   "A GAEB file can have at most 16 MiB. Export it without its attachments.");
  const auto first = bytes.find_first_not_of(" \t\r\n");
  const std::string_view start = bytes.substr(std::min(first, bytes.size()));
  const bool has_mark = !start.empty() && static_cast<unsigned char>(start.front()) >= 0xef;
  if (start.starts_with("#begin"))
    return refused(ErrorCode::unsupported, "GAEB 2000 file",
                   "The server reads GAEB DA XML only. Open the file in the program for tenders, "
                   "and export it as GAEB DA XML 3.x (X83).");
  if (!start.starts_with('<') && !has_mark)
    return refused(ErrorCode::unsupported, "Not a GAEB DA XML file",
                   "The file is not XML. It may be a GAEB 90 file (D83). Open it in the program "
                   "for tenders, and export it as GAEB DA XML 3.x (X83).");
  pugi::xml_document document;
  const auto parsed = document.load_buffer(bytes.data(), bytes.size(), pugi::parse_default);
  if (!parsed)
    return refused(ErrorCode::malformed, "XML not readable",
                   "The file is not valid XML after byte " + std::to_string(parsed.offset) + ": " +
                       parsed.description() + ". Export it again.");
  const pugi::xml_node root = document.document_element();
  if (local_name(root) != "GAEB")
    return refused(ErrorCode::unsupported, "Not a GAEB DA XML file",
                   "The root of the XML is not `GAEB`. Export the bill as GAEB DA XML 3.x (X83).");
  return Reader().read(root);
}

}  // namespace strata::bill
