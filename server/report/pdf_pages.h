#pragma once

#include <cairo.h>

#include <array>
#include <string>
#include <vector>

#include "core/error.h"
#include "report/document.h"
#include "report/page.h"
#include "report/pdf_picture.h"
#include "report/pdf_text.h"

namespace strata::report {

// Draws texts, lines and pictures from the top of the first page to the end of the last page, with
// headers and footers. Lengths are points, and y is down. Nothing is drawn before `begin_drawing`,
// so that a first pass can count the pages.
class PdfPages {
 public:
  // The unit of the context must be a point.
  PdfPages(cairo_t* context, const Document& document, PdfPictures& pictures);

  void begin_drawing();  // from the first page again
  void finish();         // ends the last page

  cairo_t* context() const { return context_; }
  const std::string& language() const { return document_.language; }
  int number() const { return number_; }  // of the current page, from 1
  double y() const { return y_; }
  static double left() { return points(kMargin_mm); }
  static double width() { return points(kTextWidth_mm); }
  static double height() { return points(kTextHeight_mm); }
  double rest() const;  // the height that is left on the page
  bool is_empty() const;

  void break_page();
  // Continues on the next page if `height` is not left on this one. Has no effect on an empty page.
  void need(double height);
  void move(double height) { y_ += height; }
  void add_space(double height);  // has no effect on an empty page

  // Draws a text and moves below it. Continues on the next page if necessary. Each part has the
  // tag.
  void add_text(const PdfText& text, double x, const char* tag);
  // These functions draw at a place.
  void draw_lines(const PdfText& text, double x, double y, std::size_t begin, std::size_t end);
  void draw_rule(double x, double y, double width, double thickness, const Color& color);
  void fill(double x, double y, double width, double height, const Color& color);
  Result<void> draw_picture(const PictureSource& source, const std::string& alternative,
                            const std::string& place, double x, double y, double width,
                            double height);
  // Adds an entry to the outline. The level of titles is 1.
  void add_outline(int level, const std::string& text);

  // The texts of the pictures, in the order of their tags.
  const std::vector<std::string>& alternatives() const { return alternatives_; }

  // Marks what is drawn during its lifetime as an element of the structure, such as "P" or "TD"
  // (ISO 32000-1, section 14.8.4).
  class Tag {
   public:
    Tag(PdfPages& pages, const char* name);
    ~Tag();
    Tag(const Tag&) = delete;
    Tag& operator=(const Tag&) = delete;

   private:
    PdfPages& pages_;
    const char* name_;
  };

 private:
  void draw_header_and_footer();

  cairo_t* context_;
  const Document& document_;
  PdfPictures& pictures_;
  bool draws_ = false;
  int number_ = 1, count_ = 0;
  double y_ = 0;
  std::array<int, 4> outline_{};  // the newest entry of each level, with the root at 0
  std::vector<std::string> alternatives_;
};

}  // namespace strata::report
