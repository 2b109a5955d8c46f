#pragma once

#include <cstdint>

#include "core/error.h"
#include "query/conditions/texel_selection.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
class SurfaceDistances;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

// Dilation and erosion of a set of surface texels with a disc of `radius` (model units), the two
// operations of morphology (Serra, "Image Analysis and Mathematical Morphology", 1982). Distances
// are measured along the surface, between the centers of texels (mesh/distance/surface_distance.h).
// The edge of the mesh and the seams of the atlas are no borders. All functions return surface
// texels without gutter, take time and memory like distances_along_surface, and fail when
// cancelled.

// Texels whose distance equals the radius are within it, in spite of rounding errors.
inline constexpr double kRim = 1 + 1e-4;

// Adds the texels whose distance to the set is at most the radius.
Result<TexelSelection> dilate(const TexelSelection& set, double radius, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, Progress& progress, int threads = 1);
// Keeps the texels whose distance to all other surface texels is larger than the radius.
Result<TexelSelection> erode(const TexelSelection& set, double radius, const mesh::SurfaceMap& map,
                             const mesh::TexelGraph& graph, Progress& progress, int threads = 1);

// Returns the texels whose distance is known.
TexelSelection reached_texels(const mesh::SurfaceDistances& distances, const mesh::SurfaceMap& map);

// Returns the surface texels that are not in the set.
TexelSelection surface_outside(const TexelSelection& set, const mesh::SurfaceMap& map);

// Adds the texels whose center is within `distance` (model units) of the border of the set. If
// negative, removes the texels whose center is within -`distance` of the rest of the surface. Half
// a texel of the mean size lies between the border and the centers of the texels at the border.
Result<TexelSelection> grow(const TexelSelection& set, double distance, const mesh::SurfaceMap& map,
                            const mesh::TexelGraph& graph, Progress& progress, int threads = 1);

// Removes the pieces that are narrower than `width` (model units), and then closes the gaps that
// are narrower: opens, then closes.
Result<TexelSelection> smooth(const TexelSelection& set, double width, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, Progress& progress, int threads = 1);

// Returns the most bytes that one of these functions needs at a time, without the result.
std::uint64_t bytes_to_dilate(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph);

}  // namespace strata::query
