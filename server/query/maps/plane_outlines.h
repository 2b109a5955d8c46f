#pragma once

#include <map>
#include <set>

#include "query/maps/flat_area.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::mesh {
struct Geometry;
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// A plane for outlines. The fields are indices of world coordinates: `right` and `up` span the
// plane, and `depth` is the third coordinate, which is kept.
struct OutlinePlane {
  int right = 0, up = 1, depth = 2;
};

// limit for the corners of texels before the lines are simplified
inline constexpr std::size_t kMaxOutlineCorners = 4'000'000;

// The areas of each class (ValueClasses::of) in the plane, as valid polygons with holes. Corners
// are world coordinates in the order of the plane. Classes without painted texels are left out. A
// class that is seen edge-on has no polygon.
//
// Areas end at the edges of texels and at the edges of the surface. Texels are clipped to the
// charts of the atlas. Both sides of a seam are the same line in space, so areas continue across
// seams without a gap. Simplification moves lines by at most half the mean width of a texel. Parts
// of one class that overlap in the plane are merged.
//
// `only` contains the classes to outline. Null: all.
//
// `map` has the resolution of the layer. More than kMaxOutlineCorners corners are an `invalid`
// error.
using PlaneOutlines = std::map<std::uint32_t, std::vector<FlatPolygon>>;
Result<PlaneOutlines> plane_outlines(const LayerView& view, const mesh::Geometry& geometry,
                                     const mesh::SurfaceMap& map, const ValueClasses& classes,
                                     const OutlinePlane& plane,
                                     const std::set<std::uint32_t>* only = nullptr);

}  // namespace strata::query
