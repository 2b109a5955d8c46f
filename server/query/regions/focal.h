#pragma once

#include <string>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// Statistics of the values in the neighborhood of each texel.
enum class Focal {
  mean,     // weighted by the true area of the texels
  min,      //
  max,      //
  variety,  // the number of distinct values
  // The z-score of a hot spot (positive) or cold spot (negative): Gi* of Getis and Ord (1992; Ord
  // and Getis 1995), with equal weights within the radius. Their formula counts places, so its
  // scores grow with the number of texels. Here the places are discs with a quarter of the radius:
  // their mean area and the spread of their means stand for the size and the variance of a place.
  // From a radius of 8 texels on, the score is then about the same at each resolution. If values
  // are independent over more than such a disc, the score has about a standard normal distribution.
  hot_spot,
};

// Returns a statistic of the values within `radius` (model units) along the surface around each
// surface texel, as f32. Texels without a value do not count. The result has no value where no
// texel in the neighborhood has one, also where the texel itself has none but another has one.
// `type` is the type of `values`.
//
// The neighborhood is that of query/regions/texel_discs. Near a seam or an edge, distances are
// straight through space, and at folds and thin walls, where that reaches too much surface, along
// paths. TexelDiscs states how far its rim can be from the radius.
//
// Hot spots also need the values of all other places: where they are equal, or all within the
// radius, the score is 0.
//
// Sums of blocks and of their rows make the time per texel proportional to the radius. It is about
// three times as long near seams, and a hundred times as long at folds. It grows with the square of
// the radius at folds, and for the variety of layers with many values. Needs about 24 bytes of
// memory per texel of the map. The result does not depend on the number of threads. Fails when
// cancelled, and at `field` for a radius that check_focal_radius refuses. The radius must not be
// negative.
Result<SurfaceValues> focal_values(Focal statistic, const SurfaceValues& values, ValueType type,
                                   double radius, const mesh::SurfaceMap& map,
                                   const mesh::TexelGraph& graph, const std::string& field,
                                   Progress& progress, int threads = 1);

// Returns how likely chance alone makes the mean of a neighborhood at least as unusual as it is:
// the pseudo p-value of a conditional permutation test of Gi* with the places of Focal::hot_spot
// (query/regions/place_permutations), on both sides, as f32. It is 1 where all values are equal.
// Where each value is independent of others farther than a place away, about 5 % of the results are
// below 0.05. Unlike the score, it assumes no normal distribution.
//
// Takes as long as the score, and about 0.6 ns for each texel and permutation. Needs about 40 bytes
// of memory per texel, and 12 bytes per place. Otherwise like focal_values.
Result<SurfaceValues> hot_spot_chances(const SurfaceValues& values, ValueType type, double radius,
                                       int permutations, const mesh::SurfaceMap& map,
                                       const mesh::TexelGraph& graph, const std::string& field,
                                       Progress& progress, int threads = 1);

}  // namespace strata::query
