#include "mesh/rollout/fit_developed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "domain/people/question.h"

namespace strata::mesh {
namespace {

constexpr int kRounds = 6;        // of reweighted least squares
constexpr double kSpread = 0.03;  // as a share of the model's size: see `improved`
// The axis is unique if the costs of every other axis are larger by this factor, and not almost 0.
constexpr double kUniqueFactor = 1.5, kMinCost = 0.09;
constexpr double kSameAxisCosine = 0.94;  // 20°
// Faces at a smaller angle to the axis than about 20° are floors, lids and rims.
constexpr double kFloorCosine = 0.94;
constexpr double kMinWallShare = 0.1;  // of the area; below, the model is a flat sheet
constexpr double kMinAngle = std::numbers::pi / 6;
constexpr double kMaxDeviation = 1.0 / 3;  // as a share of the radius
constexpr double kMaxSlope = 3.7;          // tan 75°: steeper cones are almost flat
// A cone is chosen if it reduces the deviation by this factor and is not almost a cylinder.
constexpr double kConeGain = 0.7, kMinConeSlope = 0.0175;  // tan 1°
constexpr std::size_t kTrianglesAtOnce = 1u << 16;
constexpr double kPatches = 64;  // along the diagonal of the model

// A triangle or patch as a sample of the surface.
struct Sample {
  glm::dvec3 place;  // relative to the center
  glm::dvec3 normal;
  double area;
};

// Calls `see` with each triangle that has an area. The places are relative to `center`.
template <class See>
void for_each_sample(const Geometry& geometry, const glm::dvec3& center, See see) {
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    if (t % kTrianglesAtOnce == 0) check_question();
    const auto at = [&](std::size_t k) {
      return geometry.positions[geometry.vertices[geometry.indices[3 * t + k]].position_index];
    };
    const glm::dvec3 a = at(0), b = at(1), c = at(2);
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double twice = glm::length(cross);
    if (twice > 0) see(Sample{(a + b + c) / 3.0 - center, cross / twice, twice / 2});
  }
}

// Returns the surface as patches, each in a cell of a grid. The normals of single triangles of a
// scan contain much noise, which has no effect on the mean normal of a patch. A cell of a thin wall
// has a patch for each side.
std::vector<Sample> patches_of(const Geometry& geometry, const glm::dvec3& center, double size) {
  struct Patch {
    glm::dvec3 place{0}, normal{0};  // sums, weighted by area
    double area = 0;
  };
  std::unordered_map<std::uint32_t, std::array<Patch, 2>> cells;
  for_each_sample(geometry, center, [&](const Sample& sample) {
    const glm::dvec3 cell = glm::floor((sample.place / size + 0.5) * (kPatches - 1e-6));
    const auto key = static_cast<std::uint32_t>((cell.z * kPatches + cell.y) * kPatches + cell.x);
    auto& sides = cells[key];
    Patch& patch = sides[glm::dot(sides[0].normal, sample.normal) < 0 ? 1 : 0];
    patch.place += sample.area * sample.place;
    patch.normal += sample.area * sample.normal;
    patch.area += sample.area;
  });
  std::vector<Sample> patches;
  for (const auto& [key, sides] : cells)
    for (const Patch& patch : sides)
      if (const double area = glm::length(patch.normal); area > 0)
        patches.push_back({patch.place / patch.area, patch.normal / area, area});
  return patches;
}

struct Eigen3 {
  std::array<double, 3> values;  // ascending
  std::array<glm::dvec3, 3> vectors;
};

// The Jacobi method for a symmetric matrix.
Eigen3 eigen_of(glm::dmat3 m) {
  glm::dmat3 vectors(1.0);
  for (int sweep = 0; sweep < 32; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (m[q][p] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[q][p]);
      const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::hypot(theta, 1.0));
      const double c = 1 / std::hypot(t, 1.0), s = t * c;
      glm::dmat3 turn(1.0);
      turn[p][p] = turn[q][q] = c;
      turn[q][p] = s;
      turn[p][q] = -s;
      m = glm::transpose(turn) * m * turn;
      m[q][p] = m[p][q] = 0;
      vectors = vectors * turn;
    }
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](int i, int j) { return m[i][i] < m[j][j]; });
  Eigen3 eigen;
  for (int i = 0; i < 3; ++i) {
    eigen.values[i] = std::max(0.0, m[order[i]][order[i]]);
    eigen.vectors[i] = vectors[order[i]];
  }
  return eigen;
}

// Directions without normals, such as the axis of a cylinder, have no inverse.
glm::dmat3 pseudo_inverse(const glm::dmat3& m) {
  const Eigen3 eigen = eigen_of(m);
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
  double miss(const Sample& patch) const {
    return glm::dot(shift, patch.normal) + glm::dot(turn, glm::cross(patch.place, patch.normal));
  }
};

// Returns the rotations with the smallest sums of squares, best first. A patch that misses `before`
// by `spread` has half of its weight.
std::array<Rotation, 3> fit_rotations(const std::vector<Sample>& patches,
                                      const std::optional<Rotation>& before, double spread) {
  glm::dmat3 nn(0.0), nm(0.0), mm(0.0);
  double total = 0;
  for (const Sample& patch : patches) {
    const glm::dvec3 moment = glm::cross(patch.place, patch.normal);
    const double e = before ? before->miss(patch) / spread : 0;
    const double weight = patch.area / (1 + e * e);
    nn += weight * glm::outerProduct(patch.normal, patch.normal);
    nm += weight * glm::outerProduct(patch.normal, moment);
    mm += weight * glm::outerProduct(moment, moment);
    total += weight;
  }
  const glm::dmat3 to_shift = -(pseudo_inverse(nn) * nm);
  const Eigen3 eigen = eigen_of((mm + glm::transpose(nm) * to_shift) / total);
  std::array<Rotation, 3> rotations;
  for (int i = 0; i < 3; ++i) rotations[i] = {eigen.vectors[i], to_shift * eigen.vectors[i]};
  return rotations;
}

// Improves a rotation with weights that do not depend on far patches, such as those of a handle.
Rotation improved(const std::vector<Sample>& patches, Rotation rotation, double spread) {
  for (int round = 0; round < kRounds; ++round) {
    const auto all = fit_rotations(patches, rotation, spread);
    rotation = *std::ranges::max_element(all, {}, [&](const Rotation& each) {
      return std::abs(glm::dot(each.turn, rotation.turn));
    });
  }
  return rotation;
}

// The sum that `improved` reduces, for each unit of the area.
double cost_of(const std::vector<Sample>& patches, const Rotation& rotation, double spread) {
  double cost = 0, area = 0;
  for (const Sample& patch : patches) {
    const double e = rotation.miss(patch) / spread;
    cost += patch.area * std::log1p(e * e);
    area += patch.area;
  }
  return cost / area;
}

// Returns nullopt if another axis is almost as good, as in a sphere or cube.
std::optional<Rotation> unique_rotation(const std::vector<Sample>& patches, double size) {
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

// A meridian of the surface: radius = at_zero + slope · height.
struct Meridian {
  double at_zero = 0, slope = 0;
  double deviation = std::numeric_limits<double>::infinity();  // RMS distance
};

// A part of a wall in the coordinates of an axis.
struct WallSample {
  double radius, height, area;
};

double deviation_of(const std::vector<WallSample>& wall, const Meridian& line) {
  double squares = 0, area = 0;
  for (const WallSample& sample : wall) {
    const double e = sample.radius - line.at_zero - line.slope * sample.height;
    squares += sample.area * e * e;
    area += sample.area;
  }
  return std::sqrt(squares / area) / std::hypot(1.0, line.slope);
}

Meridian fit_meridian(const std::vector<WallSample>& wall, bool is_cone) {
  Meridian line;
  for (int round = 0; round < kRounds; ++round) {
    double w = 0, wh = 0, wr = 0, whh = 0, whr = 0;
    for (const WallSample& sample : wall) {
      double weight = sample.area;
      if (round > 0) {
        const double e = (sample.radius - line.at_zero - line.slope * sample.height) /
                         std::max(2 * line.deviation, 1e-9 * line.at_zero);
        weight /= 1 + e * e;
      }
      w += weight;
      wh += weight * sample.height;
      wr += weight * sample.radius;
      whh += weight * sample.height * sample.height;
      whr += weight * sample.height * sample.radius;
    }
    const double spread = whh - wh * wh / w;
    line.slope = is_cone && spread > 1e-12 * whh
                     ? std::clamp((whr - wh * wr / w) / spread, -kMaxSlope, kMaxSlope)
                     : 0;
    line.at_zero = (wr - line.slope * wh) / w;
    line.deviation = deviation_of(wall, line);
  }
  return line;
}

// The walls of a model around an axis.
struct Walls {
  std::vector<WallSample> outside, inside;
  double outside_area = 0, inside_area = 0, all_area = 0;
  double angle = 0;  // that the walls cover around the axis, in radians
};

// `axis` is a cylinder with the radius 0, whose heights are distances from the axis.
Walls walls_around(const Geometry& geometry, const DevelopedSurface& axis) {
  constexpr int kSectors = 72;
  std::array<bool, kSectors> is_covered{};
  Walls walls;
  for_each_sample(geometry, axis.point, [&](const Sample& sample) {
    walls.all_area += sample.area;
    if (std::abs(glm::dot(sample.normal, axis.axis)) > kFloorCosine) return;
    const auto place = axis.place_of(axis.point + sample.place);
    const double facing = glm::dot(sample.normal, axis.radial(place.angle));
    const WallSample wall{place.height, place.slant, sample.area};
    if (facing > 0) {
      walls.outside.push_back(wall);
      walls.outside_area += sample.area;
    } else if (facing < 0) {
      walls.inside.push_back(wall);
      walls.inside_area += sample.area;
    }
    const double sector = (place.angle / (2 * std::numbers::pi) + 0.5) * kSectors;
    is_covered[static_cast<std::size_t>(std::clamp(sector, 0.0, kSectors - 1.0))] = true;
  });
  walls.angle =
      static_cast<double>(std::ranges::count(is_covered, true)) * 2 * std::numbers::pi / kSectors;
  return walls;
}

tl::unexpected<Error> no_rollout(const std::string& why) {
  return fail(ErrorCode::invalid, "No cylinder or cone found",
              why + " Set the axis, or create a figure without a rollout.", "axis");
}

Result<void> find_axis(const Geometry& geometry, DevelopedSurface& surface, const glm::dvec3& up) {
  const double size = glm::length(glm::dvec3(geometry.box_max - geometry.box_min));
  const glm::dvec3 center = geometry.origin + glm::dvec3(geometry.box_min + geometry.box_max) / 2.0;
  const auto patches = patches_of(geometry, center, size);
  const auto rotation = unique_rotation(patches, size);
  if (!rotation)
    return no_rollout(
        "The model has no unique axis. It is similar to a sphere or cube, or it is flat.");
  surface.axis = rotation->turn;
  surface.point = center + glm::cross(rotation->turn, rotation->shift);
  // An axis that lies flat, as of a barrel vault, points along its largest coordinate.
  double along = glm::dot(surface.axis, up);
  if (std::abs(along) < 0.1) {
    const glm::dvec3 size_of = glm::abs(surface.axis);
    along = surface.axis[size_of.x >= size_of.y && size_of.x >= size_of.z ? 0
                         : size_of.y >= size_of.z                         ? 1
                                                                          : 2];
  }
  if (along < 0) surface.axis = -surface.axis;
  return {};
}

glm::dvec3 perpendicular(const glm::dvec3& axis, const glm::dvec3& wanted) {
  for (const glm::dvec3& each :
       {wanted, glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
    const glm::dvec3 flat = each - glm::dot(each, axis) * axis;
    if (glm::length(flat) > 0.1 * glm::length(each)) return glm::normalize(flat);
  }
  return {1, 0, 0};  // not reached: one of three axes is perpendicular enough
}

}  // namespace

Result<DevelopedFit> fit_developed_surface(const Geometry& geometry, const FitRequest& request) {
  DevelopedFit fit;
  DevelopedSurface& surface = fit.surface;
  surface.radius = 0;
  if (request.axis) {
    surface.point = request.axis->point;
    surface.axis = glm::normalize(request.axis->direction);
  } else {
    STRATA_TRY(find_axis(geometry, surface, request.up));
  }
  surface.zero = perpendicular(surface.axis, request.zero);
  const Walls walls = walls_around(geometry, surface);
  if (!request.axis && (walls.outside_area + walls.inside_area < kMinWallShare * walls.all_area ||
                        walls.angle < kMinAngle))
    return no_rollout("The model is flat.");
  fit.side = request.side.value_or(walls.outside_area >= walls.inside_area ? RolloutSide::outside
                                                                           : RolloutSide::inside);
  const bool is_outside = fit.side == RolloutSide::outside;
  const auto& wall = is_outside ? walls.outside : walls.inside;
  if (wall.empty())
    return fail(ErrorCode::invalid, "No surface on this side",
                std::string("No wall around the axis faces ") +
                    (is_outside ? "outward. Choose the inside" : "the axis. Choose the outside") +
                    ", or change the axis.",
                "side");
  Meridian line;
  if (!request.radius) line = fit_meridian(wall, request.is_cone.value_or(false));
  if (!request.is_cone && !request.radius) {
    const Meridian cone = fit_meridian(wall, true);
    if (cone.deviation < kConeGain * line.deviation && std::abs(cone.slope) > kMinConeSlope)
      line = cone;
  }
  if (request.radius) {
    line.at_zero = *request.radius;
    line.slope = std::tan(request.half_angle.value_or(0));
    line.deviation = deviation_of(wall, line);
  } else if (!request.axis) {
    // The plane through `point` is in the middle of the walls, so the radius is not negative there.
    const auto [low, high] = std::ranges::minmax_element(wall, {}, &WallSample::height);
    const double middle = (low->height + high->height) / 2;
    surface.point += middle * surface.axis;
    line.at_zero += line.slope * middle;
  }
  if (!(line.at_zero > 0))
    return fail(ErrorCode::invalid, "No radius at the point of the axis",
                "The fitted cone has its tip beyond the point of the axis. Move the point of the "
                "axis to the middle of the wall.",
                "axis.point");
  if (!request.axis && !(line.deviation <= kMaxDeviation * line.at_zero))
    return no_rollout("The walls of the model differ too much from a cylinder or cone.");
  surface.radius = line.at_zero;
  surface.half_angle = std::abs(line.slope) < 1e-9 ? 0 : std::atan(line.slope);
  fit.deviation = line.deviation;
  return fit;
}

}  // namespace strata::mesh
