#pragma once

#include <map>
#include <optional>

#include "support/gl_scene.h"

namespace strata::test {

// A stroke computed in plain C++ with double precision: the owned texels that the stroke writes, by
// the definition of invariant 6 and the depth read back from the GPU. `radii_px`: one radius for
// each path point, in window pixels.
struct OracleResult {
  std::map<TileAddress, TileMask> written;
  // Texels so near to a threshold of the tool, the window or the depth test that rounding decides.
  std::map<TileAddress, TileMask> undecided;
  int count = 0;
};
OracleResult oracle_edit(const Scene& scene, const StrokeBatch& stroke,
                         const std::vector<double>& radii_px, const std::vector<float>& depth);

struct Difference {
  int surface = 0;    // differing texels outside the rounding error
  int undecided = 0;  // differing texels within the rounding error
  int compared = 0;   // texels that the oracle or the renderer wrote
};
Difference compare(const OracleResult& expected, const render::StrokeOutcome& outcome);

// Limits of a comparison. The oracle must write `at_least` texels for a meaningful result. One in
// `undecided_one_in` of the compared texels, plus two, may differ within the rounding error. No
// other texel may differ.
struct OracleBounds {
  int at_least = 0;
  int undecided_one_in = 10'000;
};
// Paints the stroke on a new layer and expects the texels of the oracle. Without `model`, adds the
// scene as a new model first.
void expect_as_oracle(TestRenderer& renderer, const Scene& scene, const StrokeBatch& stroke,
                      OracleBounds bounds, std::optional<render::ModelHandle> model = {});

int written_texels(const render::StrokeOutcome& outcome);  // sum over all tiles

}  // namespace strata::test
