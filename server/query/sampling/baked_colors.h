#pragma once

#include "core/error.h"
#include "core/progress.h"
#include "media/picture.h"
#include "mesh/surface/geometry.h"
#include "query/sampling/surface_colors.h"

namespace strata::query {

// The progress of a task after bake_colors, which reports the stages before.
constexpr double kBaked = 0.8;

// Returns an upper limit of the memory in bytes that `bake_colors` needs.
std::uint64_t bytes_to_bake(const mesh::Geometry& geometry, int size);

// Paints the colors of a surface on an opaque image of the atlas with `size`² pixels. Each pixel of
// the surface has the color at its center. The pixels between the charts continue the colors, so
// that filters and coarser levels of a texture add no other colors at the seams. Uses several
// threads, and the result does not depend on their number. Fails when cancelled, or if the size is
// not a resolution of a surface map (mesh::check_map_resolution).
Result<Picture> bake_colors(const mesh::Geometry& geometry, const SurfaceColors& colors, int size,
                            Progress& progress);

}  // namespace strata::query
