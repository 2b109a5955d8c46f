#include "mesh/rollout/fit_axis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "mesh/rollout/face_samples.h"

namespace strata::mesh {
namespace {

constexpr int kRounds = 6;        // of reweighted least squares
constexpr double kSpread = 0.03;  // as a share of the model's size: see `improved`
// The axis is unique if the costs of every other axis are larger by this factor, and not almost 0.
constexpr double kUniqueFactor = 1.5, kMinCost = 0.09;
constexpr double kSameAxisCosine = 0.94;  // 20°
constexpr double kPatches = 64;           // along the diagonal of the model
// The axis of a general cylinder is unique if the normals deviate this many times more from the
// plane across every other direction: in the first round, and in the last.
constexpr double kFirstUnique = 1.2, kLastUnique = 4;
// A face whose normal has this cosine to the axis of a general cylinder has half of its weight.
constexpr double kAcross = 0.2;
constexpr double kMinBend = 1e-3;  // of the normals, for a unique point of the axis

// Returns the surface as patches, each in a cell of a grid. The normals of single triangles of a
// scan contain much noise, which has no effect on the mean normal of a patch. A cell of a thin wall
// has a patch for each side.
std::vector<FaceSample> patches_of(const Geometry& geometry, const glm::dvec3& center,
                                   double size) {
  struct Patch {
    glm::dvec3 place{0}, normal{0};  // sums, weighted by area
    double area = 0;
  };
  std::unordered_map<std::uint32_t, std::array<Patch, 2>> cells;
  for_each_face(geometry, center, [&](const FaceSample& sample) {
    const glm::dvec3 cell = glm::floor((sample.place / size + 0.5) * (kPatches - 1e-6));
    const auto key = static_cast<std::uint32_t>((cell.z * kPatches + cell.y) * kPatches + cell.x);
    auto& sides = cells[key];
    Patch& patch = sides[glm::dot(sides[0].normal, sample.normal) < 0 ? 1 : 0];
    patch.place += sample.area * sample.place;
    patch.normal += sample.area * sample.normal;
    patch.area += sample.area;
  });
  std::vector<FaceSample> patches;
  for (const auto& [key, sides] : cells)
    for (const Patch& patch : sides)
      if (const double area = glm::length(patch.normal); area > 0)
        patches.push_back({patch.place / patch.area, patch.normal / area, area});
  return patches;
}

struct Eigenvectors {
  std::array<double, 3> values;  // ascending
  std::array<glm::dvec3, 3> vectors;
};

Eigenvectors eigenvectors_of(const glm::dmat3& symmetric) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix(i, j) = symmetric[j][i];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  Eigenvectors found;
  for (int i = 0; i < 3; ++i) {
    found.values[i] = std::max(0.0, solver.eigenvalues()[i]);
    const Eigen::Vector3d vector = solver.eigenvectors().col(i);
    found.vectors[i] = {vector.x(), vector.y(), vector.z()};
  }
  return found;
}

// Directions without normals, such as the axis of a cylinder, have no inverse.
glm::dmat3 pseudo_inverse(const glm::dmat3& m) {
  const Eigenvectors eigen = eigenvectors_of(m);
  glm::dmat3 inverse(0.0);
  for (int i = 0; i < 3; ++i)
    if (eigen.values[i] > 1e-4 * eigen.values[2])
      inverse += glm::outerProduct(eigen.vectors[i], eigen.vectors[i]) / eigen.values[i];
  return inverse;
}

// The rotation whose velocities are most nearly tangential to the surface: shift + turn × place.
struct Rotation {
  glm::dvec3 turn{0}, shift{0};

  // The distance at which the line along the normal misses the axis.
  double miss(const FaceSample& patch) const {
    return glm::dot(shift, patch.normal) + glm::dot(turn, glm::cross(patch.place, patch.normal));
  }
};

// Returns the rotations with the smallest sums of squares, best first. A patch that misses `before`
// by `spread` has half of its weight.
std::array<Rotation, 3> fit_rotations(const std::vector<FaceSample>& patches,
                                      const std::optional<Rotation>& before, double spread) {
  glm::dmat3 nn(0.0), nm(0.0), mm(0.0);
  double total = 0;
  for (const FaceSample& patch : patches) {
    const glm::dvec3 moment = glm::cross(patch.place, patch.normal);
    const double e = before ? before->miss(patch) / spread : 0;
    const double weight = patch.area / (1 + e * e);
    nn += weight * glm::outerProduct(patch.normal, patch.normal);
    nm += weight * glm::outerProduct(patch.normal, moment);
    mm += weight * glm::outerProduct(moment, moment);
    total += weight;
  }
  const glm::dmat3 to_shift = -(pseudo_inverse(nn) * nm);
  const Eigenvectors eigen = eigenvectors_of((mm + glm::transpose(nm) * to_shift) / total);
  std::array<Rotation, 3> rotations;
  for (int i = 0; i < 3; ++i) rotations[i] = {eigen.vectors[i], to_shift * eigen.vectors[i]};
  return rotations;
}

// Improves a rotation with weights that do not depend on far patches, such as those of a handle.
Rotation improved(const std::vector<FaceSample>& patches, Rotation rotation, double spread) {
  for (int round = 0; round < kRounds; ++round) {
    const auto all = fit_rotations(patches, rotation, spread);
    rotation = *std::ranges::max_element(all, {}, [&](const Rotation& each) {
      return std::abs(glm::dot(each.turn, rotation.turn));
    });
  }
  return rotation;
}

// The sum that `improved` reduces, for each unit of the area.
double cost_of(const std::vector<FaceSample>& patches, const Rotation& rotation, double spread) {
  double cost = 0, area = 0;
  for (const FaceSample& patch : patches) {
    const double e = rotation.miss(patch) / spread;
    cost += patch.area * std::log1p(e * e);
    area += patch.area;
  }
  return cost / area;
}

// Returns nullopt if another axis is almost as good, as in a sphere or cube.
std::optional<Rotation> unique_rotation(const std::vector<FaceSample>& patches, double size) {
  if (patches.empty()) return std::nullopt;
  const double spread = kSpread * size;
  std::array<Rotation, 3> rotations = fit_rotations(patches, std::nullopt, spread);
  std::array<double, 3> costs;
  for (int i = 0; i < 3; ++i) {
    rotations[i] = improved(patches, rotations[i], spread);
    costs[i] = cost_of(patches, rotations[i], spread);
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_other =
        std::abs(glm::dot(rotations[i].turn, rotations[best].turn)) < kSameAxisCosine;
    if (is_other && costs[i] < std::max(kUniqueFactor * costs[best], kMinCost)) return std::nullopt;
  }
  return improved(patches, rotations[best], spread / 4);
}

// The patches of a model, relative to the middle of its box.
struct Patches {
  glm::dvec3 center;
  double size;  // of the diagonal of the box
  std::vector<FaceSample> all;
};

Patches patches_of(const Geometry& geometry) {
  Patches patches{
      geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) / 2.0,
      glm::length(glm::dvec3(geometry.box_max - geometry.box_min)),
      {},
  };
  patches.all = patches_of(geometry, patches.center, patches.size);
  return patches;
}

// Returns the direction to which the normals are perpendicular.
std::optional<glm::dvec3> cylinder_direction(const std::vector<FaceSample>& patches) {
  std::optional<glm::dvec3> direction;
  for (int round = 0; round < kRounds; ++round) {
    glm::dmat3 normals(0.0);
    for (const FaceSample& patch : patches) {
      const double e = direction ? glm::dot(patch.normal, *direction) / kAcross : 0;
      normals += patch.area / (1 + e * e) * glm::outerProduct(patch.normal, patch.normal);
    }
    const Eigenvectors eigen = eigenvectors_of(normals);
    const double unique = round == 0 ? kFirstUnique : round == kRounds - 1 ? kLastUnique : 0;
    if (!(eigen.values[1] > unique * eigen.values[0])) return std::nullopt;
    if (!(eigen.values[1] > kMinBend * eigen.values[2])) return std::nullopt;
    direction = eigen.vectors[0];
  }
  return direction;
}

}  // namespace

std::optional<FittedAxis> fit_revolution_axis(const Geometry& geometry) {
  const Patches patches = patches_of(geometry);
  const auto rotation = unique_rotation(patches.all, patches.size);
  if (!rotation) return std::nullopt;
  return FittedAxis{patches.center + glm::cross(rotation->turn, rotation->shift), rotation->turn};
}

std::optional<FittedAxis> fit_cylinder_axis(const Geometry& geometry) {
  const Patches patches = patches_of(geometry);
  const auto direction = cylinder_direction(patches.all);
  if (!direction) return std::nullopt;
  // The sum of the squared distances of a point from the lines along the normals is smallest where
  // the sum of squares · point equals the sum of squares · place.
  glm::dmat3 squares(0.0);
  glm::dvec3 sum(0);
  for (const FaceSample& patch : patches.all) {
    const double e = glm::dot(patch.normal, *direction) / kAcross;
    const glm::dvec3 across = glm::cross(patch.normal, *direction);
    const glm::dmat3 square = patch.area / (1 + e * e) * glm::outerProduct(across, across);
    squares += square;
    sum += square * patch.place;
  }
  return FittedAxis{patches.center + pseudo_inverse(squares) * sum, *direction};
}

}  // namespace strata::mesh
