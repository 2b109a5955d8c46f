#pragma once

#include <optional>
#include <string>
#include <vector>

#include "figure/legend.h"
#include "figure/sheet.h"
#include "figure/title_block.h"
#include "figure/view_grid.h"

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

// The place of a view on the sheet, which is a box of whole pixels.
struct ViewPlace {
  Box box;
  int x = 0, y = 0;  // in pixels from the top left of the drawing
  int width = 0, height = 0;
  double scale = 1;
};

struct PlacedView {
  ViewPlace place;
  std::string title{};  // only shown if there are several views
  // The direction of north on the paper (y down). It has no value if the angle between north and
  // the paper is too large.
  std::optional<glm::dvec2> north{};
  std::vector<Label> labels{};  // from place_labels
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

  // Places views in the area of the drawing. A single view fills it. `scale` applies to views
  // without their own scale. Without it, this is the largest round scale at which all views fit.
  struct Arrangement {
    std::vector<ViewPlace> places;
    double scale = 1;
    // The size of the views relative to their space: of a single view at 1 : 1, of several ones at
    // `scale`.
    double tightness = 0;
  };
  Arrangement arrange(const std::vector<ViewSize>& views, std::optional<double> scale) const;

  // Views with one common scale have one scale bar. Several views have their titles and scales
  // below them.
  Sheet finish(const std::vector<PlacedView>& views) const;

 private:
  Sheet sheet_;
  Box scale_box_;  // for the scale bar and the arrow
  std::optional<TitleBlock> block_;
  BlockShape block_shape_ = BlockShape::wide;
  Box block_box_;
  int width_ = 0, height_ = 0;
};

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
