#include "report/pdf_table.h"

#include <algorithm>
#include <optional>

#include "report/page.h"
#include "report/style.h"

namespace strata::report {
namespace {

constexpr double kSwatchGap = points(1.5);
constexpr std::size_t kMaxTogether = 12;   // rows of a table that stays on one page
constexpr double kPictureGap = points(1);  // between a picture and the text below it

struct LaidCell {
  PdfText text;
  double x = 0, text_x = 0;
  std::optional<Color> swatch{};
  const CellPicture* picture = nullptr;
  double picture_width = 0, picture_height = 0;

  double text_top() const { return picture == nullptr ? 0 : picture_height + kPictureGap; }
  double height() const {
    if (text.line_count() > 0) return text_top() + text.height();
    return std::max(picture_height, swatch ? points(kSwatchHeight_mm) : 0);
  }
};

struct LaidRow {
  std::vector<LaidCell> cells;
  const char* tag = "TD";
  double before = 0, after = 0;  // the space above and below the content
  double height() const {
    double height = 0;
    for (const LaidCell& cell : cells) height = std::max(height, cell.height());
    return before + height + after;
  }
};

class TableFlow {
 public:
  TableFlow(PdfPages& pages, PdfPictures& pictures, const Table& table, const std::string& place)
      : pages_(pages),
        pictures_(pictures),
        table_(table),
        place_(place),
        widths_mm_(column_widths_mm(table)),
        has_rules_(has_rules(table)),
        caption_(pages.context(), {{table.caption}}, kCaption, pages.language(), pages.width()) {}

  Result<double> least_height() {
    double least = caption_height();
    if (has_head(table_)) least += STRATA_TRY(head()).height();
    if (table_.rows.empty()) return least;
    double height = least;
    least += STRATA_TRY(laid(table_.rows[0], kTableText, "TD")).height();
    if (table_.rows.size() > kMaxTogether) return least;
    for (const auto& row : table_.rows) height += STRATA_TRY(laid(row, kTableText, "TD")).height();
    if (!table_.total.empty()) height += STRATA_TRY(laid(table_.total, kTableTotal, "TD")).height();
    return height <= pages_.height() / 3 ? height : least;
  }

  Result<void> draw(const Progress& progress) {
    const PdfPages::Tag tag(pages_, "Table");
    pages_.add_space(kAboveTable_pt);
    pages_.need(std::min(STRATA_TRY(least_height()), pages_.height()));
    const bool begins_page = pages_.is_empty();
    pages_.add_text(caption_, pages_.left(), "Caption");
    if (caption_.line_count() > 0) pages_.move(kCaptionGap_pt);
    draw_rule(kRule_pt, kRule);
    if (has_head(table_)) {
      const LaidRow row = STRATA_TRY(head());
      STRATA_TRY(draw_row(row));
      draw_rule(kRule_pt, kRule);
      // A head that is very high would leave no room for other rows.
      if (row.height() < pages_.height() / 3) repeats_head_ = true;
    }
    is_page_new_ = begins_page;
    double total_height = 0;
    if (!table_.total.empty())
      total_height = STRATA_TRY(laid(table_.total, kTableTotal, "TD")).height();
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      if (progress.cancelled()) return cancelled_problem();
      const bool is_last = i + 1 == table_.rows.size();
      if (i > 0) draw_rule(kHairline_pt, kHairline);
      const LaidRow row = STRATA_TRY(laid(table_.rows[i], kTableText, "TD"));
      // The last row and the total are on the same page.
      STRATA_TRY(draw_row(row, is_last ? total_height : 0));
    }
    if (!table_.total.empty()) {
      draw_rule(kRule_pt, kRule);
      STRATA_TRY(draw_row(STRATA_TRY(laid(table_.total, kTableTotal, "TD"))));
    }
    draw_rule(kRule_pt, kRule);
    pages_.add_space(kBelowTable_pt);
    return {};
  }

 private:
  double caption_height() const {
    return caption_.line_count() == 0 ? 0 : caption_.height() + kCaptionGap_pt;
  }

  Result<LaidRow> head() {
    std::vector<Cell> names;
    for (const Column& column : table_.columns) names.push_back({column.name});
    return laid(names, kTableHead, "TH");
  }

  Result<LaidRow> laid(const std::vector<Cell>& cells, const TextStyle& style, const char* tag) {
    static const Cell kEmpty;
    LaidRow row{{}, tag, style.before_pt, style.after_pt};
    double x = pages_.left();
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      const Cell& cell = i < cells.size() ? cells[i] : kEmpty;
      const double padding = has_rules_ ? points(kCellPadding_mm) : 0;
      const double inner_width = points(widths_mm_[i] - 2 * kCellPadding_mm);
      const double indent = cell.swatch ? points(kSwatchWidth_mm) + kSwatchGap : 0;
      LaidCell laid{PdfText(pages_.context(), {{cell.text}}, style, pages_.language(),
                            inner_width - indent, table_.columns[i].alignment),
                    x + padding, x + padding + indent, cell.swatch};
      if (cell.picture) {
        const auto pixels = STRATA_TRY(pictures_.size(cell.picture->source, place_));
        const ShownSize size =
            shown_size(cell.picture->width_mm, pixels.width, pixels.height,
                       widths_mm_[i] - 2 * kCellPadding_mm, kMaxCellPictureHeight_mm);
        laid.picture = &*cell.picture;
        laid.picture_width = points(size.width_mm);
        laid.picture_height = points(size.height_mm);
      }
      row.cells.push_back(std::move(laid));
      x += points(widths_mm_[i]);
    }
    return row;
  }

  // `below` is the height that must be left below the row.
  Result<void> draw_row(const LaidRow& row, double below = 0) {
    if (pages_.rest() < row.height() + below) {
      if (!is_page_new_) STRATA_TRY(continue_on_next_page());
      if (pages_.rest() < row.height()) return draw_split_row(row);
    }
    is_page_new_ = false;
    const PdfPages::Tag tag(pages_, "TR");
    for (const LaidCell& cell : row.cells) {
      const PdfPages::Tag cell_tag(pages_, row.tag);
      const double y = pages_.y() + row.before;
      STRATA_TRY(draw_picture(cell, y));
      draw_text(cell, y + cell.text_top(), 0, cell.text.line_count());
    }
    pages_.move(row.height());
    return {};
  }

  Result<void> draw_split_row(const LaidRow& row) {
    struct Place {
      bool is_picture_drawn = false;
      std::size_t line = 0;
    };
    std::vector<Place> places(row.cells.size());
    const PdfPages::Tag tag(pages_, "TR");
    for (bool is_done = false; !is_done;) {
      is_done = true;
      double height = 0;
      const double room = pages_.rest() - row.before - row.after;
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const LaidCell& cell = row.cells[i];
        Place& place = places[i];
        const PdfPages::Tag cell_tag(pages_, row.tag);
        double y = 0;
        if (cell.picture != nullptr && !place.is_picture_drawn) {
          // On a page with only the first row, the limits of pictures and of the first row leave
          // enough room.
          if (cell.picture_height > room) {
            is_done = false;
            continue;
          }
          STRATA_TRY(draw_picture(cell, pages_.y() + row.before));
          place.is_picture_drawn = true;
          y = cell.text_top();
        }
        std::size_t count = cell.text.fitting(place.line, room - y);
        draw_text(cell, pages_.y() + row.before + y, place.line, place.line + count);
        y += cell.text.height_between(place.line, place.line + count);
        place.line += count;
        height = std::max(height, y);
        if (place.line < cell.text.line_count()) is_done = false;
      }
      pages_.move(row.before + height + row.after);
      is_page_new_ = false;
      if (!is_done) STRATA_TRY(continue_on_next_page());
    }
    return {};
  }

  Result<void> continue_on_next_page() {
    draw_rule(kRule_pt, kRule);
    pages_.break_page();
    if (repeats_head_) {
      draw_rule(kRule_pt, kRule);
      STRATA_TRY(draw_row(STRATA_TRY(head())));
    }
    draw_rule(kRule_pt, kRule);
    is_page_new_ = true;
    return {};
  }

  Result<void> draw_picture(const LaidCell& cell, double y) {
    if (cell.picture == nullptr) return {};
    return pages_.draw_picture(cell.picture->source, cell.picture->alternative, place_, cell.x, y,
                               cell.picture_width, cell.picture_height);
  }

  // The swatch is in the middle of the first line.
  void draw_text(const LaidCell& cell, double y, std::size_t begin, std::size_t end) {
    if (cell.swatch && begin == 0) {
      const double height = points(kSwatchHeight_mm);
      const double line =
          std::max(height, cell.text.height_between(0, std::min<std::size_t>(1, end)));
      pages_.fill(cell.x, y + (line - height) / 2, points(kSwatchWidth_mm), height, *cell.swatch);
    }
    pages_.draw_lines(cell.text, cell.text_x, y, begin, end);
  }

  void draw_rule(double thickness, const Color& color) {
    if (!has_rules_) return;
    pages_.draw_rule(pages_.left(), pages_.y(), pages_.width(), thickness, color);
  }

  PdfPages& pages_;
  PdfPictures& pictures_;
  const Table& table_;
  const std::string& place_;
  const std::vector<double> widths_mm_;
  const bool has_rules_;
  const PdfText caption_;
  bool repeats_head_ = false;
  bool is_page_new_ = false;  // the page has no row except the repeated first row
};

}  // namespace

Result<void> add_table(PdfPages& pages, PdfPictures& pictures, const Table& table,
                       const std::string& place, const Progress& progress) {
  return TableFlow(pages, pictures, table, place).draw(progress);
}

Result<double> least_table_height(PdfPages& pages, PdfPictures& pictures, const Table& table,
                                  const std::string& place) {
  return TableFlow(pages, pictures, table, place).least_height();
}

}  // namespace strata::report
