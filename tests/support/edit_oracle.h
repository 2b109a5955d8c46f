#pragma once

#include <map>
#include <optional>

#include "support/gl_scene.h"

namespace strata::test {

// The edit in plain C++ and double: computes the owned texels that a stroke writes, by the
// definition of invariant 6 and the depth read back from the GPU. Radii in window pixels, one for
// each path point.
struct OracleResult {
  std::map<TileAddress, TileMask> written;
  // Texels so near to a threshold of the tool, the window or the depth test that rounding decides.
  std::map<TileAddress, TileMask> undecided;
  int count = 0;
};
OracleResult oracle_edit(const Scene& scene, const StrokeBatch& stroke,
                         const std::vector<double>& radii_px, const std::vector<float>& depth);

struct Difference {
  int surface = 0;    // texels that differ and are decided
  int undecided = 0;  // texels that differ within rounding
  int compared = 0;   // written by at least one of them
};
Difference compare(const OracleResult& expected, const render::StrokeOutcome& outcome);

// Limits of a comparison: the oracle must write `at_least` texels for a meaningful result, and one
// in `undecided_one_in` of the compared texels, and two more, may differ within rounding. No other
// texel may differ.
struct OracleBounds {
  int at_least = 0;
  int undecided_one_in = 10'000;
};
// Paints the stroke on a new layer, of a new model of the scene unless one is given, and expects
// the texels of the oracle.
void expect_as_oracle(TestRenderer& renderer, const Scene& scene, const StrokeBatch& stroke,
                      OracleBounds bounds, std::optional<render::ModelHandle> model = {});

int written_texels(const render::StrokeOutcome& outcome);  // of all tiles

}  // namespace strata::test
