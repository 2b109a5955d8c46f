#include "mesh/analysis/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/analysis/tangent_frame.h"

namespace strata::mesh {
namespace {

constexpr int kTerms = 6;  // 1, x, y, x²/2, xy, y²/2
using Normals = std::array<std::array<double, kTerms>, kTerms>;
using Terms = std::array<double, kTerms>;

// Solves the normal equations (lower triangle) in place with the Cholesky method. Returns false if
// they are nearly singular.
bool solve(Normals& a, Terms& b) {
  for (int i = 0; i < kTerms; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i == j) {
        if (!(sum > 1e-9 * a[i][i])) return false;
        a[i][i] = std::sqrt(sum);
      } else {
        a[i][j] = sum / a[j][j];
      }
    }
  for (int i = 0; i < kTerms; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = kTerms - 1; i >= 0; --i) {
    for (int k = i + 1; k < kTerms; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

}  // namespace

std::optional<Curvature> curvature_at(const SurfaceSamples& samples, const glm::vec3& point,
                                      const glm::vec3& normal) {
  const double radius = samples.radius();
  const auto nearness = [&](float squared) {
    const double inside = 1 - squared / (radius * radius);
    return inside * inside;
  };
  struct Weighted {
    const SurfaceSamples::Sample* sample;
    double weight;
  };
  // Each thread reuses this array for all its points. The array stores the neighbors because
  // searching for them takes longer than using them.
  thread_local std::vector<Weighted> neighbours;
  neighbours.clear();
  glm::dvec3 mean_normal(0);
  samples.near(point, normal, [&](const SurfaceSamples::Sample& sample, float squared) {
    neighbours.push_back({&sample, nearness(squared) * sample.area});
    mean_normal += neighbours.back().weight * glm::dvec3(sample.normal);
  });
  const double length = glm::length(mean_normal);
  if (neighbours.size() < kTerms + 2 || !(length > 0)) return std::nullopt;

  // Lengths are in units of the radius, so the equations are well scaled.
  const TangentFrame frame(mean_normal / length);
  Normals a{};
  Terms b{};
  for (const auto& [sample, weight] : neighbours) {
    const glm::dvec3 offset = (glm::dvec3(sample->position) - glm::dvec3(point)) / radius;
    const double x = glm::dot(offset, frame.x), y = glm::dot(offset, frame.y),
                 z = glm::dot(offset, frame.z);
    const Terms terms{1, x, y, x * x / 2, x * y, y * y / 2};
    for (int i = 0; i < kTerms; ++i) {
      b[i] += weight * terms[i] * z;
      for (int j = 0; j <= i; ++j) a[i][j] += weight * terms[i] * terms[j];
    }
  }
  if (!solve(a, b)) return std::nullopt;
  // The fundamental forms of z = f(x, y) at x = y = 0. The sign is negative because heights
  // decrease away from the top of a bulge.
  const double fx = b[1], fy = b[2], root = std::sqrt(1 + fx * fx + fy * fy);
  const double e = 1 + fx * fx, f = fx * fy, g = 1 + fy * fy;
  const double l = -b[3] / root, m = -b[4] / root, n = -b[5] / root;
  const double determinant = e * g - f * f;
  const double mean = (e * n - 2 * f * m + g * l) / (2 * determinant),
               gaussian = (l * n - m * m) / determinant;
  const double spread = std::sqrt(std::max(0.0, mean * mean - gaussian));
  return Curvature{(mean + spread) / radius, (mean - spread) / radius};
}

std::optional<double> roughness_at(const SurfaceSamples& samples, const glm::vec3& point,
                                   const glm::vec3& normal) {
  glm::dvec3 sum(0);
  std::array<double, 6> products{};  // xx, xy, xz, yy, yz, zz
  double area = 0;
  int count = 0;
  samples.near(point, normal, [&](const SurfaceSamples::Sample& sample, float) {
    const double w = sample.area;
    const glm::dvec3 p =
        (glm::dvec3(sample.position) - glm::dvec3(point)) / double{samples.radius()};
    sum += w * p;
    area += w;
    ++count;
    const std::array<double, 6> own{p.x * p.x, p.x * p.y, p.x * p.z,
                                    p.y * p.y, p.y * p.z, p.z * p.z};
    for (int i = 0; i < 6; ++i) products[i] += w * own[i];
  });
  if (count < 3 || !(area > 0)) return std::nullopt;
  const glm::dvec3 mean = sum / area;
  const double xx = products[0] / area - mean.x * mean.x, xy = products[1] / area - mean.x * mean.y,
               xz = products[2] / area - mean.x * mean.z, yy = products[3] / area - mean.y * mean.y,
               yz = products[4] / area - mean.y * mean.z, zz = products[5] / area - mean.z * mean.z;
  // The direction of least variance. The smallest root of the characteristic polynomial has a
  // closed form. The direction is then the longest cross product of two rows of the matrix minus
  // root · identity.
  const double third = (xx + yy + zz) / 3;
  const double off = xy * xy + xz * xz + yz * yz;
  const double dx = xx - third, dy = yy - third, dz = zz - third;
  const double p = std::sqrt((dx * dx + dy * dy + dz * dz + 2 * off) / 6);
  if (!(p > 1e-9)) return std::nullopt;
  const double half_determinant =
      (dx * (dy * dz - yz * yz) - xy * (xy * dz - yz * xz) + xz * (xy * yz - dy * xz)) /
      (2 * p * p * p);
  const double angle = std::acos(std::clamp(half_determinant, -1.0, 1.0)) / 3;
  const double least = third + 2 * p * std::cos(angle + 2 * std::numbers::pi / 3);
  const glm::dvec3 rows[3] = {{xx - least, xy, xz}, {xy, yy - least, yz}, {xz, yz, zz - least}};
  glm::dvec3 direction(0);
  for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    const glm::dvec3 cross = glm::cross(rows[i], rows[j]);
    if (glm::dot(cross, cross) > glm::dot(direction, direction)) direction = cross;
  }
  const double length = glm::length(direction);
  if (!(length > 1e-12)) return std::nullopt;
  return std::abs(glm::dot(mean, direction / length)) * samples.radius();
}

}  // namespace strata::mesh
