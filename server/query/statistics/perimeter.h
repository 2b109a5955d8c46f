#pragma once

#include <cstdint>
#include <map>

#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

// Lengths of borders in model units, along the surface.
struct Perimeters {
  double all = 0;  // perimeter of all valid texels
  // around each class, by ValueClasses::of; a border between two classes is added to both
  std::map<std::uint32_t, double> of_class;
};

// Measures the borders of valid texels. `within` restricts the texels; null means all texels. An
// open edge of the mesh is a border. A seam of the atlas is not a border.
//
// A sum of texel edges is up to 41 % too long. By the Cauchy-Crofton formula, the length of a curve
// is proportional to the number of lines that cross it. Lines through texels in 8 directions are
// counted. Each line is weighted by its spacing and its share of the directions. Both are measured
// on the surface, so stretched texels have their true size (Boykov and Kolmogorov, "Computing
// geodesics and minimal surfaces via graph cuts", ICCV 2003). The error of straight borders is at
// most 2 %. For areas a few texels wide, and along seams, the error may be about one texel.
//
// If `progress` is cancelled, the result is incomplete.
Perimeters measure_perimeters(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const TexelSelection* within,
                              const ValueClasses& classes, int threads = 1,
                              const Progress* progress = nullptr);

}  // namespace strata::query
