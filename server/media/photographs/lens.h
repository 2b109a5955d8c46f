#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string_view>

namespace strata::photo {

// The distortion of a lens. All models map a direction (x, y) = (X/Z, Y/Z) in camera axes (x to the
// right, y down, z into the scene) to a distorted (x', y'), with r² = x² + y²:
// - pinhole:  x' = x
// - brown:    x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶ + k4 r⁸) + T_x
//             the model of Brown and Conrady, as in Metashape, RealityCapture, Bundler, and COLMAP
//             (SIMPLE_RADIAL, RADIAL, OPENCV)
// - rational: x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶) + T_x
//             FULL_OPENCV of COLMAP
// - fisheye:  x' = x/r (θ + k1 θ³ + k2 θ⁵ + k3 θ⁷ + k4 θ⁹), with θ = atan r
//             OPENCV_FISHEYE of COLMAP, and its simpler forms
// - division: x' = x / (1 + k1 r²)
//             the division model of RealityCapture
// y' is formed alike. T is the tangential distortion:
//   T_x = (p_x (r² + 2x²) + 2 p_y x y) (1 + p3 r² + p4 r⁴)
//   T_y = (p_y (r² + 2y²) + 2 p_x x y) (1 + p3 r² + p4 r⁴)
// p_x is P1 of Metashape, t1 of RealityCapture and p2 of OpenCV; p_y is P2, t2 and p1. Only
// Metashape 1 has p3 and p4.
//
// Sources: Agisoft Metashape User Manual, appendix "Camera models"; M. Hornáček, "On the Coordinate
// Systems Employed in the Import, Estimation, and Export of Camera Geometry by RealityScan" (2026),
// section 4; COLMAP, src/colmap/sensor/models.h; OpenCV, documentation of calib3d; Bundler v0.4
// User's Manual.
enum class LensModel { pinhole, brown, rational, fisheye, division };
inline constexpr std::array<std::string_view, 5> kLensModelNames{"pinhole", "brown", "rational",
                                                                 "fisheye", "division"};
constexpr std::string_view name(LensModel model) {
  return kLensModelNames[static_cast<std::size_t>(model)];
}
std::optional<LensModel> lens_model_named(std::string_view name);

struct Lens {
  LensModel model = LensModel::pinhole;
  std::array<double, 6> radial{};      // k1, k2, …; those that the model does not have are 0
  std::array<double, 4> tangential{};  // p_x, p_y, p3, p4; only brown and rational
  bool operator==(const Lens&) const = default;
};

// The largest r for which a lens is used: 0.6° less than a right angle from the axis.
inline constexpr double kMaxRadius = 100;
inline constexpr double kMaxCoefficient = 1e12;

// Returns whether all coefficients are finite and at most kMaxCoefficient.
bool is_bounded(const Lens& lens);

// Returns the r up to which a larger r also has a larger distorted radius, at most kMaxRadius.
// Beyond it, polynomials bend back: two directions would have the same pixel. Ignores tangential
// distortion. The lens must be bounded.
double valid_radius(const Lens& lens);

struct Distorted {
  glm::dvec2 point;
  glm::dmat2 jacobian;  // column i is the derivative by component i of the direction
};
// `direction` must be finite.
Distorted distort(const Lens& lens, const glm::dvec2& direction);

// Inverts `distort` by Newton's method. `radius` is the valid radius of the lens. `tolerance` is
// the largest length of distort(result) - point. Returns nothing if no direction within the valid
// radius is that close.
std::optional<glm::dvec2> undistort(const Lens& lens, double radius, const glm::dvec2& point,
                                    double tolerance);

}  // namespace strata::photo
