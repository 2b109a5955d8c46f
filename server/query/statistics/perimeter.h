#pragma once

#include <cstdint>
#include <map>

#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

// In model units, along the surface.
struct Perimeters {
  double all = 0;  // around all valid texels
  std::map<std::uint32_t, double>
      of_class;  // by ValueClasses::of, around each class; a border of two classes counts for both
};

// Measures the borders of valid texels, restricted to texels in `within` (null: all). An open edge
// of the mesh is a border, a seam of the atlas is not.
//
// Edges of texels would be up to 41 % too long. By the Cauchy-Crofton formula the length of a curve
// is proportional to the number of lines that cross it: lines through texels in 8 directions are
// counted, each weighted by its spacing and share of directions on the surface itself, so that
// stretched texels count with their true size (Boykov and Kolmogorov, "Computing geodesics and
// minimal surfaces via graph cuts", ICCV 2003). Straight borders are within 2 %; for areas a few
// texels wide, and along seams, the error may be about a texel.
Perimeters measure_perimeters(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const TexelSelection* within,
                              const ValueClasses& classes, int threads = 1);

}  // namespace strata::query
