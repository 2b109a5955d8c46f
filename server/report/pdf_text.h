#pragma once

#include <pango/pangocairo.h>

#include <memory>
#include <string>
#include <vector>

#include "figure/pango_layout.h"
#include "report/document.h"
#include "report/style.h"

namespace strata::report {

inline constexpr double kPoints_per_mm = 72 / 25.4;
inline constexpr double points(double mm) { return mm * kPoints_per_mm; }

// A text that Pango has divided into lines. Lengths are points. The unit of the context must be a
// point.
class PdfText {
 public:
  // A text without characters has no lines.
  PdfText(cairo_t* context, const std::vector<Run>& runs, const TextStyle& style,
          const std::string& language, double width, Alignment alignment = Alignment::start);

  std::size_t line_count() const { return lines_.size(); }
  double height() const { return height_between(0, lines_.size()); }
  // Returns the height of the lines from `begin` to before `end`.
  double height_between(std::size_t begin, std::size_t end) const;
  // Returns the number of lines from `begin` that fit into a height.
  std::size_t fitting(std::size_t begin, double height) const;
  // Draws these lines. (x, y) is the top left of the line `begin`.
  void draw(double x, double y, std::size_t begin, std::size_t end) const;
  void draw(double x, double y) const { draw(x, y, 0, lines_.size()); }

 private:
  struct Line {
    PangoLayoutLine* line = nullptr;  // owned by the layout
    double x = 0, top = 0, bottom = 0, baseline = 0;
  };
  cairo_t* context_;
  Color color_;
  figure::Layout layout_;
  std::vector<Line> lines_;
};

}  // namespace strata::report
