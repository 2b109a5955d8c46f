#include "query/interpolation/matern_field.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "query/interpolation/surface_cells.h"

namespace strata::query {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Matrix>;

// Returns the lower half of κ²C + G.
Matrix matrix_of(const SurfaceCells& cells, double kappa_squared) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
    double diagonal = kappa_squared * cells.areas[cell];
    for (const auto& side : cells.sides_of(cell)) {
      diagonal += side.conductance;
      if (side.other < cell)
        entries.emplace_back(static_cast<int>(cell), static_cast<int>(side.other),
                             -side.conductance);
    }
    entries.emplace_back(static_cast<int>(cell), static_cast<int>(cell), diagonal);
  }
  const auto size = static_cast<Eigen::Index>(cells.count());
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Returns the diagonal of the inverse of the factored matrix. For the entries of the inverse Z
// below the diagonal that the factor L also has, from the last column to the first:
//   z_ij = −Σ_k z_ik l_kj,  z_jj = 1/d_j − Σ_k l_kj z_kj
Eigen::VectorXd diagonal_of_inverse(const Factor& factor) {
  const Matrix& lower = factor.matrixL().nestedExpression();
  const Eigen::VectorXd pivots = factor.vectorD();
  const int size = static_cast<int>(lower.cols());
  const int* first = lower.outerIndexPtr();
  const int* row = lower.innerIndexPtr();
  const double* value = lower.valuePtr();
  std::vector<double> inverse(static_cast<std::size_t>(lower.nonZeros()));
  Eigen::VectorXd diagonal(size);
  std::vector<int> entry_of_row(static_cast<std::size_t>(size), -1);  // in the current column
  std::vector<double> sums;
  for (int column = size - 1; column >= 0; --column) {
    const int begin = first[column], end = first[column + 1];
    for (int entry = begin; entry < end; ++entry)
      entry_of_row[static_cast<std::size_t>(row[entry])] = entry - begin;
    sums.assign(static_cast<std::size_t>(end - begin), 0);
    for (int entry = begin; entry < end; ++entry) {
      double& sum = sums[static_cast<std::size_t>(entry - begin)];
      sum += value[entry] * diagonal[row[entry]];
      for (int other = first[row[entry]]; other < first[row[entry] + 1]; ++other) {
        const int found = entry_of_row[static_cast<std::size_t>(row[other])];
        if (found < 0) continue;
        const double between = inverse[static_cast<std::size_t>(other)];
        sums[static_cast<std::size_t>(found)] += value[entry] * between;
        sum += value[begin + found] * between;
      }
    }
    diagonal[column] = 1 / pivots[column];
    for (int entry = begin; entry < end; ++entry) {
      const double sum = sums[static_cast<std::size_t>(entry - begin)];
      inverse[static_cast<std::size_t>(entry)] = -sum;
      diagonal[column] += value[entry] * sum;
      entry_of_row[static_cast<std::size_t>(row[entry])] = -1;
    }
  }
  return factor.permutationPinv() * diagonal;
}

}  // namespace

struct MaternField::Parts {
  Factor factor;
  Eigen::VectorXd areas, inverse_deviation;
};

Result<MaternField> MaternField::make(const SurfaceCells& cells, double range, Progress& progress,
                                      int threads) {
  // The error of the difference is about the square of the step.
  constexpr double kStep = 1e-3;
  const double kappa_squared = 8 / (range * range);
  auto parts = std::make_unique<Parts>();
  std::array<Eigen::VectorXd, 2> diagonals;
  mesh::parallel_for(threads, 3, [&](int number) {
    if (progress.cancelled()) return;
    if (number == 2) {
      parts->factor.compute(matrix_of(cells, kappa_squared));
    } else {
      const Factor factor(matrix_of(cells, kappa_squared * (number == 0 ? 1 - kStep : 1 + kStep)));
      diagonals[static_cast<std::size_t>(number)] = diagonal_of_inverse(factor);
    }
  });
  if (progress.cancelled()) return cancelled_problem();
  parts->areas = Eigen::Map<const Eigen::VectorXd>(cells.areas.data(),
                                                   static_cast<Eigen::Index>(cells.count()));
  parts->inverse_deviation =
      ((diagonals[0] - diagonals[1]) / (2 * kStep * kappa_squared)).cwiseSqrt().cwiseInverse();
  return MaternField(std::move(parts));
}

MaternField::MaternField(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
MaternField::MaternField(MaternField&&) noexcept = default;
MaternField& MaternField::operator=(MaternField&&) noexcept = default;
MaternField::~MaternField() = default;

Eigen::VectorXd MaternField::covariance_times(const Eigen::VectorXd& vector) const {
  const auto& [factor, areas, inverse_deviation] = *parts_;
  Eigen::VectorXd once = factor.solve(inverse_deviation.cwiseProduct(vector));
  return inverse_deviation.cwiseProduct(factor.solve(areas.cwiseProduct(once)));
}

}  // namespace strata::query
