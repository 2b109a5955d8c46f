#pragma once

#include <string>
#include <vector>

#include "figure/drawing.h"
#include "figure/legend.h"
#include "figure/sheet.h"
#include "figure/title_block.h"

namespace strata::figure {

// The layout of a sheet. The drawing fills the area that the legend and the texts do not use.

enum class Paper { a5, a4, a3 };
glm::dvec2 paper_mm(Paper paper, bool landscape);

struct Captions {
  std::string title, caption, credit;
  // Text after the title of a list that continues in another column of the legend.
  std::string continued = "(continued)";
  // At the bottom right, in a frame around the sheet. It contains `title`, which is then not above
  // the caption. finish() adds the scale.
  std::optional<TitleBlock> block{};
};

struct Label {
  glm::dvec2 at{0};  // center of the text, in mm from the drawing's top left
  std::string text;
};

// A sheet without the parts that depend on the scale. It determines the area of the drawing.
class SheetLayout {
 public:
  // `margin` on each side of the paper in mm.
  static constexpr double kMargin_mm = 10;
  SheetLayout(glm::dvec2 paper_mm, const Captions& captions, const std::vector<Legend>& legends,
              int dpi, double margin = kMargin_mm);

  // The number of whole pixels for the drawing, with `dpi` pixels per inch.
  int drawing_width() const { return width_; }
  int drawing_height() const { return height_; }
  glm::dvec2 drawing_mm() const { return sheet_.drawing.size; }
  const Box& drawing() const { return sheet_.drawing; }  // on the paper

  // `north` is the direction of north on the paper (y down). It has no value if the angle between
  // north and the paper is too large. `place_labels` makes the labels.
  Sheet finish(double scale, const std::optional<glm::dvec2>& north,
               const std::vector<Label>& labels) const;

 private:
  Sheet sheet_;
  Box scale_box_;  // for the scale bar and the arrow
  std::optional<TitleBlock> block_;
  BlockShape block_shape_ = BlockShape::wide;
  Box block_box_;
  int width_ = 0, height_ = 0;
};

// Returns a scale as text, for example "1 : 50" or "2 : 1".
std::string scale_text(double scale);

// A scale bar with a round length, 20 to 60 mm on paper.
struct ScaleBar {
  double length_mm = 0;  // on paper
  int steps = 1;         // number of equal steps
  double step = 0;       // length of a step, in `unit`
  std::string unit;      // "mm", "cm", "m", "km"
};
ScaleBar scale_bar(double scale, double widest_mm);

// The label of a record, and the positions at which the record is visible, largest area first.
struct LabelRequest {
  std::string text;
  std::vector<glm::dvec2> places;  // in mm from the drawing's top left, best position first
};
inline constexpr double kLabel_mm = 2.4;  // letter height
// Places each label at its first position that is within the drawing and does not overlap other
// labels. Omits labels without such a position.
std::vector<Label> place_labels(const std::vector<LabelRequest>& requests,
                                const glm::dvec2& drawing_mm);

}  // namespace strata::figure
