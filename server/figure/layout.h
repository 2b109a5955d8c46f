#pragma once

#include <string>
#include <vector>

#include "figure/drawing.h"
#include "figure/legend.h"
#include "figure/sheet.h"

namespace strata::figure {

// Places everything on a sheet: the drawing gets the area that legend and text leave.

enum class Paper { a5, a4, a3 };
glm::dvec2 paper_mm(Paper paper, bool landscape);

struct Captions {
  std::string title, caption, credit;
  // after the title of a list that continues in another column of the legend
  std::string continued = "(continued)";
};

struct Label {
  glm::dvec2 at{0};  // center of the text, mm from the drawing's top left
  std::string text;
};

// A sheet without the parts that depend on the drawing's scale; gives the room for the drawing.
class SheetLayout {
 public:
  SheetLayout(glm::dvec2 paper_mm, const Captions& captions, const std::vector<Legend>& legends,
              int dpi);

  // Whole pixels of `dpi` that are available for the drawing.
  int drawing_width() const { return width_; }
  int drawing_height() const { return height_; }
  glm::dvec2 drawing_mm() const { return sheet_.drawing.size; }

  // `north`: its direction on the paper (y down), unless it is too steep to the paper; labels as
  // `place_labels` returns them.
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

// The label of a record and its visible positions, sorted by the size of the areas.
struct LabelRequest {
  std::string text;
  std::vector<glm::dvec2> places;  // mm from the drawing's top left, the best first
};
inline constexpr double kLabel_mm = 2.4;  // height of letters
// Places each label at its first position that is within the drawing and overlaps no other label;
// leaves out labels without such a position.
std::vector<Label> place_labels(const std::vector<LabelRequest>& requests,
                                const glm::dvec2& drawing_mm);

}  // namespace strata::figure
