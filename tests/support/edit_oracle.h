#pragma once

#include <map>
#include <optional>

#include "support/gl_scene.h"

namespace strata::test {

// The edit in plain C++ and double: which owned texels a stroke writes, by the definition of
// invariant 6 and the depth read back from the GPU. Radii in window pixels, one a path point.
struct OracleResult {
  std::map<TileAddress, TileMask> written;
  // Texels so near to a threshold of the tool, the window or the depth test that rounding decides.
  std::map<TileAddress, TileMask> undecided;
  int count = 0;
};
OracleResult oracle_edit(const Scene& scene, const StrokeBatch& stroke,
                         const std::vector<double>& radii_px, const std::vector<float>& depth);

struct Difference {
  int surface = 0;    // texels that differ and are not undecided
  int undecided = 0;  // texels that differ within rounding
  int compared = 0;   // written by either
};
Difference compare(const OracleResult& expected, const render::StrokeOutcome& outcome);

// What a comparison allows: the oracle must write `at_least` texels for it to mean anything, and of
// those that are compared one in `undecided_one_in`, and two more, may differ within rounding. No
// other may.
struct OracleBounds {
  int at_least = 0;
  int undecided_one_in = 10'000;
};
// Paints the stroke on a new layer, of a new model of the scene unless one is given, and expects
// what the oracle says.
void expect_as_oracle(TestRenderer& renderer, const Scene& scene, const StrokeBatch& stroke,
                      OracleBounds bounds, std::optional<render::ModelHandle> model = {});

int written_texels(const render::StrokeOutcome& outcome);  // of all tiles

}  // namespace strata::test
