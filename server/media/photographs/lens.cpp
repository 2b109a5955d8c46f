#include "media/photographs/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace strata::photo {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;
constexpr double kInside =
    1 - 1e-9;  // keeps away from the radius where the slope is 0 or a pole is

double value(std::span<const double> polynomial, double at) {
  double sum = 0;
  for (auto it = polynomial.rbegin(); it != polynomial.rend(); ++it) sum = sum * at + *it;
  return sum;
}

std::vector<double> derivative(std::span<const double> polynomial) {
  std::vector<double> out;
  for (std::size_t i = 1; i < polynomial.size(); ++i)
    out.push_back(static_cast<double>(i) * polynomial[i]);
  return out;
}

std::vector<double> product(std::span<const double> a, std::span<const double> b) {
  std::vector<double> out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  return out;
}

// Returns the places in (0, limit) where the polynomial changes its sign, in ascending order. It is
// monotonic between the roots of its derivative, so bisection finds each root between two of them.
std::vector<double> roots(std::span<const double> polynomial, double limit) {
  if (polynomial.size() < 2) return {};
  std::vector<double> ends = roots(derivative(polynomial), limit);
  ends.push_back(limit);
  std::vector<double> found;
  double low = 0;
  for (const double high : ends) {
    const bool is_positive = value(polynomial, low) > 0;
    if ((value(polynomial, high) > 0) != is_positive) {
      double left = low, right = high;
      for (double middle = (left + right) / 2; left < middle && middle < right;
           middle = (left + right) / 2)
        ((value(polynomial, middle) > 0) == is_positive ? left : right) = middle;
      found.push_back(right);
    }
    low = high;
  }
  return found;
}

double first_root(std::span<const double> polynomial, double limit) {
  const auto found = roots(polynomial, limit);
  return found.empty() ? limit : found.front();
}

// The derivative of r (1 + k1 r² + k2 r⁴ + …) as a polynomial in r².
std::vector<double> slope(std::span<const double> coefficients) {
  std::vector<double> out{1};
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    out.push_back(static_cast<double>(2 * i + 3) * coefficients[i]);
  return out;
}

struct Rational {
  std::array<double, 4> above, below;  // polynomials in r²
};
Rational rational(const Lens& lens) {
  const auto& k = lens.radial;
  return {{1, k[0], k[1], k[2]}, {1, k[3], k[4], k[5]}};
}

// The factor of x and y in the models without tangential distortion, and its derivative by r²: x' =
// x factor(r²).
struct Factor {
  double value, slope;
};
Factor radial_factor(const Lens& lens, double r2) {
  const auto& k = lens.radial;
  switch (lens.model) {
    case LensModel::pinhole: break;
    case LensModel::brown: {
      const std::array<double, 5> terms{1, k[0], k[1], k[2], k[3]};
      return {value(terms, r2), value(derivative(terms), r2)};
    }
    case LensModel::rational: {
      const auto [above, below] = rational(lens);
      const double n = value(above, r2), d = value(below, r2);
      return {n / d,
              (value(derivative(above), r2) * d - n * value(derivative(below), r2)) / (d * d)};
    }
    case LensModel::fisheye: {
      const double r = std::sqrt(r2), angle = std::atan(r), a2 = angle * angle;
      const std::array<double, 5> terms{1, k[0], k[1], k[2], k[3]};
      const double bent = angle * value(terms, a2);
      const double factor = r > 0 ? bent / r : 1;
      if (r < 1e-4) return {factor, k[0] - 1.0 / 3};  // the difference below has no digits left
      const double by_angle = value(slope({k.data(), 4}), a2);
      return {factor, (by_angle / (1 + r2) - factor) / (2 * r2)};
    }
    case LensModel::division: {
      const double d = 1 + k[0] * r2;
      return {1 / d, -k[0] / (d * d)};
    }
  }
  return {1, 0};
}

bool is_tangential(const Lens& lens) { return lens.tangential[0] != 0 || lens.tangential[1] != 0; }

// The direction without tangential distortion whose distorted radius is `bent`: Newton's method
// between two bounds, which halves the interval where a step would leave it.
double radius_of(const Lens& lens, double limit, double bent) {
  double low = 0, high = limit, r = std::min(bent, limit / 2);
  for (int step = 0; step < 200 && low < high; ++step) {
    const auto [factor, by_r2] = radial_factor(lens, r * r);
    const double error = r * factor - bent;
    if (error == 0) return r;
    (error < 0 ? low : high) = r;
    const double change = error / (factor + 2 * r * r * by_r2);
    if (std::abs(change) <= 1e-16 * r) break;
    const double next = r - change;
    r = next > low && next < high ? next : (low + high) / 2;
  }
  return r;
}

}  // namespace

std::optional<LensModel> lens_model_named(std::string_view name) {
  const auto* const found = std::ranges::find(kLensModelNames, name);
  if (found == kLensModelNames.end()) return std::nullopt;
  return static_cast<LensModel>(found - kLensModelNames.begin());
}

bool is_bounded(const Lens& lens) {
  const auto good = [](double value) { return std::abs(value) <= kMaxCoefficient; };  // not for NaN
  return std::ranges::all_of(lens.radial, good) && std::ranges::all_of(lens.tangential, good);
}

double valid_radius(const Lens& lens) {
  const auto& k = lens.radial;
  constexpr double kLimit = kMaxRadius * kMaxRadius;
  double r2 = kLimit;
  switch (lens.model) {
    case LensModel::pinhole: break;
    case LensModel::brown: r2 = first_root(slope({k.data(), 4}), kLimit); break;
    case LensModel::rational: {
      const auto [above, below] = rational(lens);
      // The derivative of r n(r²) / d(r²) is ((n + 2 r² n') d - 2 r² n d') / d².
      auto rising = product(slope({k.data(), 3}), below);
      const auto falling = product(above, derivative(below));
      for (std::size_t i = 0; i < falling.size(); ++i) rising[i + 1] -= 2 * falling[i];
      r2 = std::min(first_root(rising, kLimit), first_root(below, kLimit));
      break;
    }
    case LensModel::fisheye: {
      const double angle = std::sqrt(first_root(slope({k.data(), 4}), kRightAngle * kRightAngle));
      return std::min(std::tan(std::min(angle, std::atan(kMaxRadius))) * kInside, kMaxRadius);
    }
    case LensModel::division:
      if (k[0] != 0) r2 = std::min(kLimit, 1 / std::abs(k[0]));
      break;
  }
  return r2 < kLimit ? std::sqrt(r2) * kInside : kMaxRadius;
}

Distorted distort(const Lens& lens, const glm::dvec2& direction) {
  const double x = direction.x, y = direction.y, r2 = x * x + y * y;
  const auto [factor, by_r2] = radial_factor(lens, r2);
  Distorted out{direction * factor, {}};
  const double xy = 2 * x * y * by_r2;
  out.jacobian = {{factor + 2 * x * x * by_r2, xy}, {xy, factor + 2 * y * y * by_r2}};
  if (!is_tangential(lens)) return out;
  const auto [px, py, p3, p4] = lens.tangential;
  const double growth = 1 + r2 * (p3 + r2 * p4), growth_by_r2 = p3 + 2 * p4 * r2;
  const glm::dvec2 bend(px * (r2 + 2 * x * x) + 2 * py * x * y,
                        py * (r2 + 2 * y * y) + 2 * px * x * y);
  out.point += bend * growth;
  const glm::dvec2 by_x(6 * px * x + 2 * py * y, 2 * py * x + 2 * px * y);
  const glm::dvec2 by_y(2 * px * y + 2 * py * x, 6 * py * y + 2 * px * x);
  out.jacobian[0] += by_x * growth + bend * (2 * x * growth_by_r2);
  out.jacobian[1] += by_y * growth + bend * (2 * y * growth_by_r2);
  return out;
}

std::optional<glm::dvec2> undistort(const Lens& lens, double radius, const glm::dvec2& point,
                                    double tolerance) {
  const double bent = glm::length(point);
  if (!std::isfinite(bent)) return std::nullopt;
  glm::dvec2 direction(0);
  if (bent > 0) direction = point / bent * radius_of(lens, radius, bent);
  const auto is_close = [&](const Distorted& at) {
    return glm::determinant(at.jacobian) > 0 && glm::length(at.point - point) <= tolerance;
  };
  // The radial solution is exact without tangential distortion, and near the solution with it.
  for (int step = 0; step < 50; ++step) {
    const Distorted at = distort(lens, direction);
    const glm::dvec2 error = at.point - point;
    const double area = glm::determinant(at.jacobian);
    if (!is_tangential(lens) || !(area > 0)) break;
    const glm::dvec2 change = glm::inverse(at.jacobian) * error;
    direction -= change;
    const double length = glm::length(direction);
    if (!(length <= radius)) direction *= radius / length;  // a step beyond the valid radius
    if (glm::length(change) <= 1e-15 * std::max(length, 1.0)) break;
  }
  if (!(glm::length(direction) <= radius) || !is_close(distort(lens, direction)))
    return std::nullopt;
  return direction;
}

}  // namespace strata::photo
