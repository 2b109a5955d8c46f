#pragma once

#include <string>
#include <vector>

#include "figure/drawing.h"
#include "figure/legend.h"
#include "figure/sheet.h"

namespace strata::figure {

// Where everything goes on a sheet: the drawing takes what legend and words leave.

enum class Paper { a5, a4, a3 };
glm::dvec2 paper_mm(Paper paper, bool landscape);

struct Captions {
  std::string title, caption, credit;
  // behind the title of a list that goes on in another column of the legend
  std::string continued = "(continued)";
};

struct Label {
  glm::dvec2 at{0};  // middle of the words, mm from the drawing's top left
  std::string text;
};

// A sheet with all but what depends on the drawing's scale: how large the drawing may be.
class SheetLayout {
 public:
  SheetLayout(glm::dvec2 paper_mm, const Captions& captions, const std::vector<Legend>& legends,
              int dpi);

  // Whole pixels of `dpi` that the drawing has room for.
  int drawing_width() const { return width_; }
  int drawing_height() const { return height_; }
  glm::dvec2 drawing_mm() const { return sheet_.drawing.size; }

  // `north`: where it is on the paper (y down), unless it is too far from its plane; labels as
  // `place_labels` leaves them.
  Sheet finish(double scale, const std::optional<glm::dvec2>& north,
               const std::vector<Label>& labels) const;

 private:
  Sheet sheet_;
  Box scale_box_;  // for bar and arrow
  int width_ = 0, height_ = 0;
};

// "1 : 50", "2 : 1".
std::string scale_text(double scale);

// A scale bar: round lengths, 20 to 60 mm of paper.
struct ScaleBar {
  double length_mm = 0;  // on paper
  int steps = 1;         // of equal length
  double step = 0;       // in `unit`
  std::string unit;      // "mm", "cm", "m", "km"
};
ScaleBar scale_bar(double scale, double widest_mm);

// Words that records have at places where they are seen, by size of their areas.
struct LabelWish {
  std::string text;
  std::vector<glm::dvec2> places;  // mm from the drawing's top left, the best first
};
inline constexpr double kLabel_mm = 2.4;  // height of letters
// Each at its first place where it lies over no other and within the drawing; those without one are
// left out.
std::vector<Label> place_labels(const std::vector<LabelWish>& wishes, const glm::dvec2& drawing_mm);

}  // namespace strata::figure
