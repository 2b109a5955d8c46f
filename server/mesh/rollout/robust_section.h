#pragma once

#include <cstddef>
#include <vector>

namespace strata::mesh {

// A distance of a wall from its axis, as a logarithm.
struct DistanceSample {
  std::size_t row = 0;  // its height, in equal steps along the axis
  double log = 0;
};
using Direction = std::vector<DistanceSample>;  // by rows, with at most one sample for each

struct RobustSection {
  std::vector<double> radii;  // for each direction
  // The robust standard deviation of the samples, as a share of the radius: of the differences in
  // shape between the heights, and of the noise.
  double spread = 0;
};

// Fits distance = radius(direction) · scale(height) to the samples of directions at equal steps all
// around. The median scale is 1. So a pot, whose radius varies along the axis, has the section of
// its median radius. The steps are:
// - The scales come from a median polish (Tukey, Exploratory Data Analysis, 1977).
// - Each direction gets a robust mean by Tukey's biweight. Its standard error comes from the spread
//   of the samples around a straight line along the axis, from their number, and from the
//   correlation of neighboring samples.
// - smooth_section() smooths the radii as far as these errors permit.
// - Where many samples of a direction disagree, as at a handle, the mean of those near the section
//   of the other directions replaces the first mean. Then the section is smoothed again.
// At least one direction must have samples.
RobustSection fit_robust_section(std::vector<Direction> directions, std::size_t row_count);

}  // namespace strata::mesh
