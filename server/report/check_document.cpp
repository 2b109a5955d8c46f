#include "report/check_document.h"

#include <algorithm>
#include <cmath>

#include "core/overloaded.h"
#include "core/text/printable.h"

namespace strata::report {
namespace {

void clean(std::string& text) {
  text = printable(text);
  std::ranges::replace(text, '\t', ' ');
}

// For texts that are properties of the file.
void clean_line(std::string& text) {
  clean(text);
  std::ranges::replace(text, '\n', ' ');
}

void clean(std::vector<Run>& runs) {
  for (Run& run : runs) clean(run.text);
}

void clean(std::vector<Cell>& cells) {
  for (Cell& cell : cells) {
    clean(cell.text);
    if (cell.picture) clean_line(cell.picture->alternative);
  }
}

void clean(Block& block) {
  std::visit(Overloaded{[](Heading& heading) { clean_line(heading.text); },
                        [](Paragraph& paragraph) { clean(paragraph.runs); },
                        [](ListItem& item) { clean(item.runs); },
                        [](Table& table) {
                          for (Column& column : table.columns) clean(column.name);
                          for (auto& row : table.rows) clean(row);
                          clean(table.total);
                          clean(table.caption);
                        },
                        [](Picture& picture) {
                          clean_line(picture.alternative);
                          clean(picture.caption);
                        },
                        [](PageBreak&) {}},
             block);
}

tl::unexpected<Error> wrong(const std::string& detail, const std::string& place) {
  return fail(ErrorCode::invalid, "Invalid report", detail, place);
}

bool is_length(double value) { return std::isfinite(value) && value > 0; }

Result<void> check_width(double width_mm, const std::string& place) {
  if (!is_length(width_mm))
    return wrong("The width of a picture must be a positive number of millimeters.", place);
  return {};
}

Result<void> check_row(const std::vector<Cell>& cells, std::size_t columns,
                       const std::string& place) {
  if (cells.size() > columns)
    return wrong("The row has " + std::to_string(cells.size()) + " cells, but the table has only " +
                     std::to_string(columns) + " columns.",
                 place);
  for (const Cell& cell : cells)
    if (cell.picture) STRATA_TRY(check_width(cell.picture->width_mm, place));
  return {};
}

Result<void> check(const Table& table, const std::string& place) {
  if (table.columns.empty() || table.columns.size() > kMaxColumns)
    return wrong("A table must have 1 to " + std::to_string(kMaxColumns) + " columns.", place);
  for (const Column& column : table.columns)
    if (!is_length(column.width))
      return wrong("The width of a column must be a positive number.", place + "/columns");
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    STRATA_TRY(
        check_row(table.rows[i], table.columns.size(), place + "/rows/" + std::to_string(i)));
  return check_row(table.total, table.columns.size(), place + "/total");
}

Result<void> check(const Block& block, const std::string& place) {
  if (const auto* heading = std::get_if<Heading>(&block))
    if (heading->level < 1 || heading->level > 3)
      return wrong("The level of a heading must be 1, 2 or 3.", place);
  if (const auto* table = std::get_if<Table>(&block)) return check(*table, place);
  if (const auto* picture = std::get_if<Picture>(&block))
    return check_width(picture->width_mm, place);
  return {};
}

bool is_language(const std::string& tag) {
  constexpr std::size_t kMaxTag = 35;  // RFC 5646, section 4.4.1
  return !tag.empty() && tag.size() <= kMaxTag && std::ranges::all_of(tag, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
}

}  // namespace

Result<Document> checked(const Document& requested) {
  Document document = requested;
  for (std::string* line : {&document.title, &document.subject, &document.author})
    clean_line(*line);
  for (std::string* text : {&document.header, &document.footer, &document.wording.reduced})
    clean(*text);
  for (auto& [label, value] : document.title_block) {
    clean(label);
    clean(value);
  }
  for (Block& block : document.blocks) clean(block);
  if (!is_language(document.language))
    return wrong("The language must be a BCP 47 tag, such as \"de\".", "language");
  if (document.logo) {
    clean_line(document.logo->alternative);
    STRATA_TRY(check_width(document.logo->width_mm, "logo"));
  }
  for (std::size_t i = 0; i < document.blocks.size(); ++i)
    STRATA_TRY(check(document.blocks[i], "blocks/" + std::to_string(i)));
  return document;
}

}  // namespace strata::report
