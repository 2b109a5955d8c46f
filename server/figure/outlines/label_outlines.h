#pragma once

#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "figure/outlines/label_faces.h"

namespace strata::figure {

// The areas of labels on a grid, as smooth polygons. Neighbors have one common border, so there are
// neither gaps nor overlaps between them.

// The corners of a ring. The first corner is not repeated at the end.
using OutlineRing = std::vector<glm::dvec2>;
// Returns the area. It is positive if the inside is on the left of somebody who walks along the
// ring on the page.
double signed_area(const OutlineRing& ring);
struct OutlinePolygon {
  std::vector<OutlineRing> rings;  // the outer ring first, and then the holes
};

struct OutlineSettings {
  // Bound for the distance between the outlines and the sides of cells, in cells. Half a cell is
  // added to it. At most this distance from the border, a cell may be in the area of a neighbor.
  double tolerance = 1;
  // Smaller pieces (in cells) become a part of their neighbor. 0: keep all.
  double smallest_area = 0;
  // The largest number of cell sides that are borders. More are an `invalid` error.
  std::size_t most_sides = 4'000'000;
};

struct LabelOutlines {
  // Valid polygons (OGC simple features, so rings may touch each other in points). Coordinates are
  // cells from the top left, y down.
  std::map<std::uint32_t, std::vector<OutlinePolygon>> areas;  // by label; without kNoLabel
  std::size_t points = 0;                                      // of all rings
  std::size_t dropped_pieces = 0;                              // smaller than smallest_area
  double dropped_area = 0;                                     // in cells
};

// Memory: 8 bytes for each cell, and about 100 bytes for each cell side that is a border. Errors:
// `cancelled`, and `invalid` for more borders than `most_sides`.
Result<LabelOutlines> label_outlines(LabelGrid grid, const OutlineSettings& settings,
                                     const Progress& progress);

}  // namespace strata::figure
