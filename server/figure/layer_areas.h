#pragma once

#include "figure/outlines/label_outlines.h"
#include "figure/sheet.h"

namespace strata::figure {

// The areas and marks of layers as vectors. Coordinates are millimeters from the sheet's top left,
// y down.

struct ClassArea {
  std::string name;  // of the class or record
  double value = 0;  // of its texels; in a stepped palette the first value of the range
  Rgba color{};
  Pattern pattern = Pattern::solid;
  double angle = 45;      // of the lines, in degrees
  double spacing_mm = 1;  // of lines and dots
  std::vector<OutlinePolygon> polygons;
};

// A visible part of a line or, with one point, a point of a record.
struct RecordMark {
  std::int64_t key = 0;
  std::string name;  // of the record
  Rgba color{};
  std::vector<glm::dvec2> points;
};

struct LayerVectors {
  std::string id;  // slug of the layer
  std::string name;
  double opacity = 1;
  std::vector<ClassArea> areas;
  std::vector<RecordMark> marks;
};

// Returns the areas as a group with a part for each class, and the marks as a group. Lines and
// points have the widths that they have in pictures. Only the parts in the box of the drawing are
// visible.
Group area_group(LayerVectors layer, const Box& drawing);
Group mark_group(LayerVectors layer, const Box& drawing);

}  // namespace strata::figure
