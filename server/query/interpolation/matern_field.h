#pragma once

#include <Eigen/Dense>
#include <memory>

#include "core/error.h"

namespace strata {
class Progress;
}

namespace strata::query {

struct SurfaceCells;

// A Gaussian random field on the cells of a surface, with mean 0 and variance 1, that solves
//   (κ² − Δ) x = white noise,  κ = √8 / range
// (Lindgren, Rue and Lindström 2011, J. R. Stat. Soc. B 73). On a plane it is a Matérn field with
// smoothness 1. Its correlation is 0.14 at the distance `range`. Nothing flows over open edges.
//
// With C = diag(areas of the cells), G = the finite volumes of −Δ and K = κ²C + G, the covariance
// of the solution is K⁻¹CK⁻¹. Its diagonal is larger at open edges and on small pieces of surface,
// so it is divided by the standard deviations.
//
// The diagonal is −d(diag K⁻¹)/d(κ²), computed as a difference of two selected inverses (Takahashi,
// Fagan and Chin 1973). These need only the entries of the Cholesky factor.
class MaternField {
 public:
  // `cells` must outlive the field. Fails when cancelled.
  static Result<MaternField> make(const SurfaceCells& cells, double range, Progress& progress,
                                  int threads);
  MaternField(MaternField&&) noexcept;
  MaternField& operator=(MaternField&&) noexcept;
  ~MaternField();

  // Returns the product of the covariance matrix and a vector. Thread-safe.
  Eigen::VectorXd covariance_times(const Eigen::VectorXd& vector) const;

 private:
  struct Parts;
  explicit MaternField(std::unique_ptr<const Parts> parts);
  std::unique_ptr<const Parts> parts_;
};

}  // namespace strata::query
