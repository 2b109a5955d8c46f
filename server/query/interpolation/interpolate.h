#pragma once

#include <cstddef>
#include <cstdint>
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

inline constexpr std::size_t kMinReadings = 3, kMaxReadings = 2000;
// The largest range, in diagonals of the box around the surface.
inline constexpr double kMaxRangeDiagonals = 2;
// The memory that `interpolated_values` needs in addition to that for texels.
inline constexpr std::uint64_t kInterpolationBytes = std::uint64_t{256} << 20;

enum class Interpolated {
  mean,   // the expected value
  error,  // its standard error
};

// Interpolates readings along the surface (readings.h), as f32. `type` is the type of `values`.
// `range` (model units) is the distance at which the correlation of two values is about 0.1.
//
// The model (kriging with an unknown constant mean):
//   reading = mean of the surface + mean of a field over the spot + noise
// The field is that of matern_field.h. Its variance, the sill, is constant. The variance of the
// noise is kNoiseShare of the sill. It is the inexactness of a reading, so two readings
// at one place may differ. The mean is estimated by generalized least squares, and the sill by
// restricted maximum likelihood, which has a closed form for a given range and share of noise.
// Both come from all readings together. The error is that of the value without noise and includes
// that of the estimated mean. It does not include that of the range and the sill.
//
// Because a spot of one value is one reading, the size of a spot does not change its weight.
//
// The result has no value on pieces of surface without a reading. It does not depend on the number
// of threads. Compared with dense matrices of the same model, means and errors differ by 2 % of the
// standard deviation of the field (root mean square), and by up to 10 % at the worst texel, which
// is next to a reading. Other seams of the atlas change them by 1 to 3 %, up to 10 %. If the range
// is less than ten cells, errors at readings are up to 30 % of that deviation instead of 10 %.
//
// The field is computed for at most 50 000 cells (surface_cells.h), and for fewer if there are many
// readings. Needs about 25 bytes of memory per texel of the map, and at most kInterpolationBytes.
// Fails when cancelled. Fails with an `invalid` error at `field` for a range that
// check_interpolation_range (query/regions/neighborhood_limits) refuses, that is too small for the
// cells or beyond kMaxRangeDiagonals, for fewer readings than kMinReadings or more than
// kMaxReadings, and for errors of readings that are all equal.
Result<SurfaceValues> interpolated_values(Interpolated what, const SurfaceValues& values,
                                          ValueType type, double range, const mesh::SurfaceMap& map,
                                          const mesh::TexelGraph& graph, const std::string& field,
                                          Progress& progress, int threads = 1);

}  // namespace strata::query
