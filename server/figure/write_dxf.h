#pragma once

#include <filesystem>

#include "core/progress.h"
#include "figure/dimension.h"
#include "figure/layer_areas.h"
#include "figure/layout.h"

namespace strata::figure {

// A drawing for CAD programs.
struct DxfDrawing {
  std::vector<LayerVectors> areas, marks;  // on the sheet
  std::vector<Label> labels;               // from the drawing's top left
  std::vector<Dimension> dimensions;       // on the sheet
  Box area;                                // of the drawing on the sheet
  double scale = 1;                        // n of 1 : n
  glm::dvec2 top_left{0};                  // of the drawing, in millimeters on the object, y up
};

// Writes a DXF file of AutoCAD 2007 (AC1021): ASCII in UTF-8, so texts can be in any language. A
// unit is a millimeter on the object, and y points up. Each class of a layer has a DXF layer in its
// color, and so have the marks of a layer, the labels and the dimensions. Each polygon is a HATCH
// and closed polylines (LWPOLYLINE). Lines are polylines, and points are of the type POINT. Their
// extended data of the application STRATA is a list of names and values: "layer", "class", "value"
// (in layers of records the key) and, for areas, "area_mm2", which is the area of the whole polygon
// on the drawing plane. Errors: `cancelled`, and `storage_full` if the file cannot be written.
Result<void> write_dxf(const DxfDrawing& drawing, const std::filesystem::path& file,
                       const Progress& progress);

}  // namespace strata::figure
