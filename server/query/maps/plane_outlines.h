#pragma once

#include <map>

#include "mesh/surface/geometry.h"
#include "query/maps/flat_area.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::query {

// A plane that outlines are laid on: which of the world's coordinates lie to the right and upwards,
// and which is kept beside them.
struct OutlinePlane {
  int right = 0, up = 1, depth = 2;
};

// of texels, before they are simplified
inline constexpr std::size_t kMaxOutlineCorners = 4'000'000;

// What the areas of each class (ValueClasses::of) cover in the plane, as valid polygons with holes:
// world coordinates, in the order of the plane. Classes that nothing is painted of are not there;
// one that is seen edge-on has no polygon.
//
// Areas end where the texels end: at their edges, and at the surface's own. Texels are cut with the
// charts of the atlas, whose rims are the same lines in space on both sides of a seam, so that
// areas go on over seams without a gap. Lines are simplified by half a mean texel at most. What
// lies behind another part of the same class is one area with it.
//
// `map` is of the layer's resolution. Refused (invalid): more than kMaxOutlineCorners corners.
using PlaneOutlines = std::map<std::uint32_t, std::vector<FlatPolygon>>;
Result<PlaneOutlines> plane_outlines(const LayerView& view, const mesh::Geometry& geometry,
                                     const mesh::SurfaceMap& map, const ValueClasses& classes,
                                     const OutlinePlane& plane);

}  // namespace strata::query
