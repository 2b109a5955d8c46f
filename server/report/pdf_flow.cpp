#include "report/pdf_flow.h"

#include <algorithm>
#include <array>
#include <optional>

#include "report/page.h"
#include "report/pdf_pages.h"
#include "report/pdf_table.h"
#include "report/style.h"

namespace strata::report {
namespace {

class Flow {
 public:
  Flow(const Document& document, PdfPages& pages, PdfPictures& pictures, Progress& progress)
      : document_(document), pages_(pages), pictures_(pictures), progress_(progress) {}

  // Reports progress from `from` to `to`.
  Result<void> run(double from, double to) {
    STRATA_TRY(add_title());
    const std::size_t count = document_.blocks.size();
    std::optional<PdfPages::Tag> list;  // of consecutive items
    for (std::size_t i = 0; i < count; ++i) {
      if (progress_.cancelled()) return cancelled_problem();
      progress_.report(from + (to - from) * static_cast<double>(i) / static_cast<double>(count),
                       "Writing the report");
      const Block& block = document_.blocks[i];
      const bool is_item = std::holds_alternative<ListItem>(block);
      if (!is_item) list.reset();
      if (is_item && !list) list.emplace(pages_, "L");
      block_ = i;
      STRATA_TRY(std::visit([&](const auto& each) { return add(each); }, block));
    }
    return {};
  }

 private:
  PdfText text_of(const std::string& text, const TextStyle& style, double width = 0) {
    return text_of(std::vector<Run>{{text}}, style, width);
  }
  PdfText text_of(const std::vector<Run>& runs, const TextStyle& style, double width = 0) {
    return {pages_.context(), runs, style, pages_.language(), width > 0 ? width : pages_.width()};
  }
  std::string place() const { return "blocks/" + std::to_string(block_); }

  Result<void> add_title() {
    const PdfPages::Tag part(pages_, "Sect");
    const double top = pages_.y();
    double logo_height = 0, width = pages_.width();
    if (document_.logo) {
      const Logo& logo = *document_.logo;
      const auto pixels = STRATA_TRY(pictures_.size(logo.source, "logo"));
      const ShownSize size = shown_size(logo.width_mm, pixels.width, pixels.height,
                                        kMaxLogoWidth_mm, kMaxLogoHeight_mm);
      logo_height = points(size.height_mm);
      const double logo_width = points(size.width_mm);
      STRATA_TRY(pages_.draw_picture(logo.source, logo.alternative, "logo",
                                     pages_.left() + width - logo_width, top, logo_width,
                                     logo_height));
      constexpr double kGap = points(8);
      width -= logo_width + kGap;
    }
    const int first_page = pages_.number();
    const PdfText title = text_of(document_.title, kTitle, width);
    pages_.add_text(title, pages_.left(), "H1");
    if (title.line_count() > 0) pages_.move(kTitle.after_pt);
    pages_.add_text(text_of(document_.subject, kSubject, width), pages_.left(), "P");
    if (pages_.number() == first_page) pages_.move(std::max(0.0, top + logo_height - pages_.y()));
    add_title_block();
    pages_.add_space(kBody.after_pt);
    return {};
  }

  void add_title_block() {
    if (document_.title_block.empty()) return;
    constexpr double kGap = points(5), kPadding = points(2);
    const auto draw_rule = [&] {
      pages_.draw_rule(pages_.left(), pages_.y(), pages_.width(), kRule_pt, kRule);
    };
    pages_.add_space(kGap);
    draw_rule();
    pages_.move(kPadding);
    const double indent = points(kLabelWidth_mm);
    for (const auto& [label, value] : document_.title_block) {
      const PdfText name = text_of(label, kLabel, indent - points(kCellPadding_mm));
      const PdfText text = text_of(value, kValue, pages_.width() - indent);
      const double height = std::max(name.height(), text.height());
      pages_.need(std::min(height, pages_.height()));
      pages_.move(kValue.before_pt);
      // A value that is higher than the rest of the page continues below.
      const double y = pages_.y();
      const int page = pages_.number();
      {
        const PdfPages::Tag tag(pages_, "P");
        pages_.draw_lines(name, pages_.left(), y, 0, name.fitting(0, pages_.rest()));
      }
      pages_.add_text(text, pages_.left() + indent, "P");
      if (pages_.number() == page) pages_.move(std::max(0.0, y + name.height() - pages_.y()));
      pages_.move(kValue.after_pt);
    }
    pages_.move(kPadding);
    draw_rule();
  }

  Result<void> add(const Heading& heading) {
    begin_block();
    const TextStyle& style = style_of(heading);
    const PdfText text = text_of(heading.text, style);
    pages_.add_space(style.before_pt);
    const double least = text.height() + style.after_pt + STRATA_TRY(least_height(block_ + 1));
    pages_.need(least <= pages_.height() ? least : std::min(text.height(), pages_.height()));
    pages_.add_outline(heading.level, heading.text);
    constexpr std::array kTags{"H2", "H3", "H4"};  // below the title
    pages_.add_text(text, pages_.left(), kTags.at(static_cast<std::size_t>(heading.level - 1)));
    pages_.move(style.after_pt);
    return {};
  }

  Result<void> add(const Paragraph& paragraph) {
    begin_block();
    pages_.add_text(text_of(paragraph.runs, kBody), pages_.left(), "P");
    pages_.add_space(kBody.after_pt);
    return {};
  }

  Result<void> add(const ListItem& item) {
    begin_block();
    const PdfText bullet = text_of("•", kListItem, kListIndent_pt);
    const PdfText text = text_of(item.runs, kListItem, pages_.width() - kListIndent_pt);
    pages_.need(first_lines(text));
    const PdfPages::Tag tag(pages_, "LI");
    {
      const PdfPages::Tag label(pages_, "Lbl");
      pages_.draw_lines(bullet, pages_.left(), pages_.y(), 0, bullet.line_count());
    }
    if (text.line_count() == 0) pages_.move(bullet.height());
    pages_.add_text(text, pages_.left() + kListIndent_pt, "LBody");
    pages_.move(kListItem.after_pt);
    return {};
  }

  Result<void> add(const Table& table) {
    begin_block();
    return add_table(pages_, pictures_, table, place(), progress_);
  }

  Result<void> add(const Picture& picture) {
    begin_block();
    const LaidPicture laid = STRATA_TRY(lay_out(picture, place()));
    pages_.add_space(kAbovePicture_pt);
    pages_.need(std::min(laid.height(), pages_.height()));
    STRATA_TRY(pages_.draw_picture(picture.source, picture.alternative, place(), pages_.left(),
                                   pages_.y(), points(laid.size.width_mm),
                                   points(laid.size.height_mm)));
    pages_.move(points(laid.size.height_mm));
    if (laid.caption.line_count() > 0) {
      pages_.move(kCaptionGap_pt);
      pages_.add_text(laid.caption, pages_.left(), "P");
    }
    pages_.add_space(kBelowPicture_pt);
    return {};
  }

  Result<void> add(const PageBreak&) {
    breaks_ = true;
    return {};
  }

  void begin_block() {
    if (breaks_ && !pages_.is_empty()) pages_.break_page();
    breaks_ = false;
  }

  static const TextStyle& style_of(const Heading& heading) {
    return kHeadings[static_cast<std::size_t>(heading.level - 1)];
  }

  struct LaidPicture {
    ShownSize size;
    PdfText caption;
    double height() const {
      return points(size.height_mm) +
             (caption.line_count() == 0 ? 0 : kCaptionGap_pt + caption.height());
    }
  };
  Result<LaidPicture> lay_out(const Picture& picture, const std::string& place) {
    const auto pixels = STRATA_TRY(pictures_.size(picture.source, place));
    const ShownSize size = shown_size(picture.width_mm, pixels.width, pixels.height,
                                      kMaxPictureWidth_mm, kMaxPictureHeight_mm);
    return LaidPicture{size, text_of(caption_of(picture, size, document_.wording), kCaption)};
  }

  // Returns the height of the lines that stay together at the beginning of a text.
  static double first_lines(const PdfText& text) {
    constexpr std::size_t kTogether = 2;
    return text.height_between(0, std::min(kTogether, text.line_count()));
  }

  // Returns the height that the beginning of a block needs, so that a heading can be above it.
  // Follows at most `depth` headings.
  Result<double> least_height(std::size_t index, int depth = 3) {
    if (index >= document_.blocks.size()) return 0;
    const Block& block = document_.blocks[index];
    const std::string place = "blocks/" + std::to_string(index);
    if (const auto* heading = std::get_if<Heading>(&block)) {
      const TextStyle& style = style_of(*heading);
      const double height =
          style.before_pt + text_of(heading->text, style).height() + style.after_pt;
      if (depth == 0) return height;
      return height + STRATA_TRY(least_height(index + 1, depth - 1));
    }
    if (const auto* paragraph = std::get_if<Paragraph>(&block))
      return first_lines(text_of(paragraph->runs, kBody));
    if (const auto* item = std::get_if<ListItem>(&block))
      return first_lines(text_of(item->runs, kListItem, pages_.width() - kListIndent_pt));
    if (const auto* table = std::get_if<Table>(&block))
      return kAboveTable_pt + STRATA_TRY(least_table_height(pages_, pictures_, *table, place));
    if (const auto* picture = std::get_if<Picture>(&block))
      return kAbovePicture_pt + STRATA_TRY(lay_out(*picture, place)).height();
    return 0;
  }

  const Document& document_;
  PdfPages& pages_;
  PdfPictures& pictures_;
  Progress& progress_;
  std::size_t block_ = 0;  // the index of the current block
  bool breaks_ = false;    // the next block begins on a new page
};

}  // namespace

Result<std::vector<std::string>> draw_pages(cairo_t* context, const Document& document,
                                            PdfPictures& pictures, Progress& progress,
                                            double share) {
  PdfPages pages(context, document, pictures);
  // The first pass counts the pages for the footers and checks the pictures.
  STRATA_TRY(Flow(document, pages, pictures, progress).run(0, share / 2));
  pages.begin_drawing();
  {
    const PdfPages::Tag tag(pages, "Document");
    STRATA_TRY(Flow(document, pages, pictures, progress).run(share / 2, share));
  }
  pages.finish();
  return pages.alternatives();
}

}  // namespace strata::report
