#pragma once

#include <cmath>
#include <limits>
#include <vector>

namespace strata::mesh {

// An estimate with its standard error, which is infinite if nothing is known.
struct Estimate {
  double value = 0;
  double error = std::numeric_limits<double>::infinity();
  bool is_known() const { return std::isfinite(error); }
};

// Smooths the logarithms of radii at equal steps of the angle, all around. The result has the least
// sum of squared second differences of all that deviate from the estimates by their standard errors
// (Whittaker 1923, with the discrepancy principle of Morozov). So it is a straight line or circle
// where the estimates are bad, and it keeps details and corners where they are precise. At a second
// difference that is larger than the bend of a wall by about 6°, the sum grows only as the
// logarithm, so corners are not rounded (Geman and McClure 1985, by reweighting). Unknown values
// are filled linearly, and the sides of gaps of more than ten steps are smoothed separately.
// At least one estimate must be known. The known errors must be positive.
std::vector<double> smooth_section(const std::vector<Estimate>& estimates);

}  // namespace strata::mesh
