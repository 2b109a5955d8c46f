#pragma once

#include <map>

#include "support/gl_scene.h"

namespace strata::test {

// The edit in plain C++ and double: which owned texels a stroke writes, by the definition of invariant 6 and the depth read
// back from the GPU. Radii in window pixels, one a path point.
struct OracleResult {
  std::map<TileAddress, TileMask> written;
  // Texels so near to a threshold of the tool, the window or the depth test that rounding decides.
  std::map<TileAddress, TileMask> undecided;
  int count = 0;
};
OracleResult oracle_edit(const Scene& scene, const StrokeBatch& stroke, const std::vector<double>& radii_px,
                         const std::vector<float>& depth);

struct Difference {
  int surface = 0;    // texels that differ and are not undecided
  int undecided = 0;  // texels that differ within rounding
  int compared = 0;   // written by either
};
Difference compare(const OracleResult& expected, const render::StrokeOutcome& outcome);

int written_texels(const render::StrokeOutcome& outcome);  // of all tiles

}  // namespace strata::test
