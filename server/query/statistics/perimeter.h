#pragma once

#include <cstdint>
#include <map>

#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::query {

// Model units, along the surface.
struct Perimeters {
  double all = 0;  // around what is valid
  std::map<std::uint32_t, double>
      of_class;  // by ValueClasses::of, around each class; a border of two classes is in both
};

// How long the borders of valid texels are; of texels in `within` (null: all). An open edge of the
// mesh is a border, a seam of the atlas is none.
//
// Edges of texels would be up to 41 % too long. By Cauchy and Crofton a curve is as long as the
// number of lines that cross it is great: lines through texels in 8 directions are counted, each
// weighted by its spacing and share of directions on the surface itself, so that stretched texels
// count what they are (Boykov and Kolmogorov, "Computing geodesics and minimal surfaces via graph
// cuts", ICCV 2003). Straight borders come out within 2 %; of areas a few texels wide, and along
// seams, there may be an error of about a texel.
Perimeters measure_perimeters(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const TexelSelection* within,
                              const ValueClasses& classes, int threads = 1);

}  // namespace strata::query
