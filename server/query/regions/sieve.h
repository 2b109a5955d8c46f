#pragma once

#include <cstdint>

#include "query/regions/regions.h"

namespace strata::query {

enum class SieveTo {
  longest_border,  // the value of the neighbor region with the longest common border
  no_value,
};

// Gives each region with a value and an area below `min_area` (model units²) another value.
//
// With `longest_border`, only regions that keep their value count as neighbors. They are regions
// of at least `min_area`, and regions without a value. A small region among small regions waits
// until one of its neighbors belongs to such a region. If the whole piece of the surface consists
// of small regions, they stay unchanged. Borders of nearly the same length (1 in 10³) are decided
// by the larger area of the neighbor, then by its value, so that the result does not depend on the
// atlas. Along a seam, the length of a border may differ by a texel, which may decide for regions
// of a few texels.
//
// The method is that of `r.reclass.area` in GRASS GIS (mode `rmarea`). `gdal_sieve` takes the
// largest neighbor instead. Lengths are measured with BorderLines. `regions` are those of
// `values`. Fails when cancelled.
Result<CleanedValues> sieve(SurfaceValues values, const Regions& regions, double min_area,
                            SieveTo to, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            Progress& progress);

// Gives each region without a value the value around it if its area is below `max_area` (model
// units²) and all texels around it have the same value. A region at an open edge of the mesh is not
// enclosed, and stays unchanged. `regions` are those of `values`. Fails when cancelled.
Result<CleanedValues> fill_holes(SurfaceValues values, const Regions& regions, double max_area,
                                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                 Progress& progress);

}  // namespace strata::query
