#pragma once

#include <map>

#include "query/maps/flat_area.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::mesh {
struct Geometry;
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// A plane for outlines: the indices of the world coordinates that point to the right and upwards,
// and of the third one, which is kept.
struct OutlinePlane {
  int right = 0, up = 1, depth = 2;
};

// of texels, before they are simplified
inline constexpr std::size_t kMaxOutlineCorners = 4'000'000;

// The areas of each class (ValueClasses::of) in the plane, as valid polygons with holes: world
// coordinates, in the order of the plane. Classes without painted texels are left out; one that is
// seen edge-on has no polygon.
//
// Areas end at the edges of texels, and at the surface's own edges. Texels are cut with the charts
// of the atlas, whose rims are the same lines in space on both sides of a seam, so areas continue
// across seams without a gap. Lines are simplified by half a mean texel at most. Parts of one class
// that are behind each other are merged.
//
// `map` is of the layer's resolution. Refused (invalid): more than kMaxOutlineCorners corners.
using PlaneOutlines = std::map<std::uint32_t, std::vector<FlatPolygon>>;
Result<PlaneOutlines> plane_outlines(const LayerView& view, const mesh::Geometry& geometry,
                                     const mesh::SurfaceMap& map, const ValueClasses& classes,
                                     const OutlinePlane& plane);

}  // namespace strata::query
