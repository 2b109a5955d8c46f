#include "report/pdf_pages.h"

#include <cairo-pdf.h>

#include <algorithm>
#include <cmath>

namespace strata::report {
namespace {

constexpr double kTop = points(kTopMargin_mm);
constexpr double kBottom = points(kPageHeight_mm - kBottomMargin_mm);
constexpr double kTolerance = 0.01;
constexpr double kNumberWidth = points(30);  // of the page number
constexpr double kMarginText = points(10);   // the largest height of a header or footer

void set_color(cairo_t* context, const Color& color) {
  cairo_set_source_rgb(context, color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
}

}  // namespace

PdfPages::Tag::Tag(PdfPages& pages, const char* name) : pages_(pages), name_(name) {
  if (pages_.draws_) cairo_tag_begin(pages_.context_, name_, nullptr);
}

PdfPages::Tag::~Tag() {
  if (pages_.draws_) cairo_tag_end(pages_.context_, name_);
}

PdfPages::PdfPages(cairo_t* context, const Document& document, PdfPictures& pictures)
    : context_(context), document_(document), pictures_(pictures), y_(kTop) {}

void PdfPages::begin_drawing() {
  draws_ = true;
  count_ = number_;
  number_ = 1;
  y_ = kTop;
  draw_header_and_footer();
}

void PdfPages::finish() {
  if (draws_) cairo_show_page(context_);
}

double PdfPages::rest() const { return kBottom - y_ + kTolerance; }

bool PdfPages::is_empty() const { return y_ <= kTop; }

void PdfPages::break_page() {
  finish();
  ++number_;
  y_ = kTop;
  // At the beginning of a page, because cairo 1.16 ends the program if the first content of a page
  // is a picture with a tag.
  if (draws_) draw_header_and_footer();
}

void PdfPages::need(double height) {
  if (rest() < height && !is_empty()) break_page();
}

void PdfPages::add_space(double height) {
  if (!is_empty()) y_ += height;
}

void PdfPages::add_text(const PdfText& text, double x, const char* tag) {
  const std::size_t count = text.line_count();
  for (std::size_t at = 0; at < count;) {
    std::size_t fits = text.fitting(at, rest());
    const std::size_t left_over = count - at - fits;
    if (left_over > 0) {
      if (left_over == 1 && fits > 2) --fits;  // so that two lines are on the next page
      if (fits < 2 && !is_empty()) {           // so that no single line is on this page
        break_page();
        continue;
      }
      fits = std::max<std::size_t>(fits, 1);
    }
    {
      const Tag part(*this, tag);
      draw_lines(text, x, y_, at, at + fits);
    }
    y_ += text.height_between(at, at + fits);
    at += fits;
    if (at < count) break_page();
  }
}

void PdfPages::draw_lines(const PdfText& text, double x, double y, std::size_t begin,
                          std::size_t end) {
  if (draws_) text.draw(x, y, begin, end);
}

void PdfPages::draw_rule(double x, double y, double width, double thickness, const Color& color) {
  fill(x, y - thickness / 2, width, thickness, color);
}

void PdfPages::fill(double x, double y, double width, double height, const Color& color) {
  if (!draws_) return;
  set_color(context_, color);
  cairo_rectangle(context_, x, y, width, height);
  cairo_fill(context_);
}

Result<void> PdfPages::draw_picture(const PictureSource& source, const std::string& alternative,
                                    const std::string& place, double x, double y, double width,
                                    double height) {
  if (!draws_) return {};
  const Tag figure(*this, "Figure");
  alternatives_.push_back(alternative);
  return pictures_.draw(context_, source, place, x, y, width, height);
}

void PdfPages::add_outline(int level, const std::string& text) {
  if (!draws_ || text.empty()) return;
  const auto index = static_cast<std::size_t>(level);
  const std::string target = "page=" + std::to_string(number_) + " pos=[" +
                             std::to_string(std::lround(left())) + " " +
                             std::to_string(std::lround(y_)) + "]";
  outline_[index] =
      cairo_pdf_surface_add_outline(cairo_get_target(context_), outline_[index - 1], text.c_str(),
                                    target.c_str(), CAIRO_PDF_OUTLINE_FLAG_OPEN);
  // A level that the document leaves out gets its parent from the level above.
  for (std::size_t lower = index + 1; lower < outline_.size(); ++lower)
    outline_[lower] = outline_[index];
}

void PdfPages::draw_header_and_footer() {
  if (number_ > 1) {
    const PdfText header(context_, {{document_.header}}, kHeaderText, language(), width());
    header.draw(left(), points(kHeader_mm), 0, header.fitting(0, kMarginText));
  }
  const std::string number = std::to_string(number_) + " / " + std::to_string(count_);
  const PdfText page(context_, {{number}}, kHeaderText, language(), kNumberWidth, Alignment::end);
  const PdfText footer(context_, {{document_.footer}}, kHeaderText, language(),
                       width() - kNumberWidth);
  const std::size_t lines = footer.fitting(0, kMarginText);
  const double bottom = points(kPageHeight_mm - kFooter_mm);
  footer.draw(left(), bottom - footer.height_between(0, lines), 0, lines);
  page.draw(left() + width() - kNumberWidth, bottom - page.height());
}

}  // namespace strata::report
