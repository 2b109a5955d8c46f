#include "mesh/repair/resting_pose.h"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <memory>
#include <numeric>
#include <unordered_map>

namespace strata::mesh {
namespace {

// The prior share of each direction, independent of the shape, in the order of kUpDirections.
constexpr std::array<double, 6> kPrior{0.10, 0.28, 0.32, 0.08, 0.10, 0.12};
constexpr double kAnyPose = 0.005;    // share of a direction in which the object does not rest
constexpr double kTilt_degrees = 30;  // hull faces at a larger angle to an axis do not affect it
// as a share of the diagonal; points closer to the ground rest on it
constexpr double kContact = 0.008;
// as a share of the ways to drop the object; rarer poses are skipped
constexpr double kUnlikely = 0.004;
constexpr int kMaxPoses = 40;
// cosine of the largest slope of a surface that touches the ground
constexpr double kLevel = 0.85;
constexpr int kColumns = 128;               // per side, for the points of the hull
constexpr int kCells = 48;                  // per side, for hollows
constexpr double kTouching = 0.04;          // largest depth of rim cells, as a share of the height
constexpr double kRound = 2.5;              // weight of a round outline
constexpr double kHollow = 6;               // weight of hollows
constexpr double kSheet = 0.5, kFront = 3;  // limit for a sheet, and the weight of its front

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Uses Andrew's monotone chain. The result is counterclockwise.
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
  std::ranges::sort(
      points, [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  const auto add = [&](const glm::dvec2& point, std::size_t least) {
    while (hull.size() >= least + 2 &&
           cross(hull[hull.size() - 1] - hull[hull.size() - 2], point - hull[hull.size() - 1]) <= 0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const auto& point : points) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin(); point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

double area_of(std::span<const glm::dvec2> polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

bool is_inside(std::span<const glm::dvec2> convex, const glm::dvec2& point) {
  if (convex.size() < 3) return false;
  for (std::size_t i = 0; i < convex.size(); ++i)
    if (cross(convex[(i + 1) % convex.size()] - convex[i], point - convex[i]) < 0) return false;
  return true;
}

// A mesh scaled to a diagonal of 1, with the center of its surface at the origin.
struct Shape {
  std::vector<glm::dvec3> points;
  std::span<const std::uint32_t> triangles;
  glm::dvec3 low{0}, high{0};
  // mean of the normals by area, with length 1 for a flat sheet and 0 for a closed mesh
  glm::dvec3 facing{0};
};

std::optional<Shape> shape_of(const TriangleMesh& mesh) {
  Shape shape;
  shape.triangles = mesh.triangles;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low, middle(0), facing(0);
  for (const std::uint32_t index : mesh.triangles) {
    low = glm::min(low, mesh.positions[index]);
    high = glm::max(high, mesh.positions[index]);
  }
  const double diagonal = glm::length(high - low);
  if (!(diagonal > 0) || !std::isfinite(diagonal)) return std::nullopt;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const glm::dvec3 a = mesh.positions[mesh.triangles[t]] - low,
                     b = mesh.positions[mesh.triangles[t + 1]] - low,
                     c = mesh.positions[mesh.triangles[t + 2]] - low;
    const glm::dvec3 normal = glm::cross(b - a, c - a) / 2.0;
    const double size = glm::length(normal);
    area += size;
    middle += size * (a + b + c) / 3.0;
    facing += normal;
  }
  if (!(area > 0)) return std::nullopt;
  middle = low + middle / area;
  shape.facing = facing / area;
  shape.points.reserve(mesh.positions.size());
  for (const glm::dvec3& position : mesh.positions)
    shape.points.push_back((position - middle) / diagonal);
  shape.low = (low - middle) / diagonal;
  shape.high = (high - middle) / diagonal;
  return shape;
}

// Returns the two outermost points of each column along each axis. These are the points of the hull
// with the precision of a column's width.
std::vector<glm::dvec3> outer_points(const Shape& shape) {
  std::vector<glm::dvec3> outer;
  const glm::dvec3 size = glm::max(shape.high - shape.low, glm::dvec3(1e-12));
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto column = [&](const glm::dvec3& p, int along) {
      return std::clamp(static_cast<int>((p[along] - shape.low[along]) / size[along] * kColumns), 0,
                        kColumns - 1);
    };
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends(std::size_t{kColumns} * kColumns,
                                                              {kNone, kNone});
    for (const std::uint32_t index : shape.triangles) {
      const glm::dvec3& p = shape.points[index];
      auto& [lowest, highest] =
          ends[static_cast<std::size_t>(column(p, u) * kColumns + column(p, v))];
      if (lowest == kNone || p[axis] < shape.points[lowest][axis]) lowest = index;
      if (highest == kNone || p[axis] > shape.points[highest][axis]) highest = index;
    }
    for (const auto& [lowest, highest] : ends) {
      if (lowest == kNone) continue;
      outer.push_back(shape.points[lowest]);
      if (lowest != highest) outer.push_back(shape.points[highest]);
    }
  }
  return outer;
}

struct HullFacet {
  glm::dvec3 normal;  // outwards
  std::array<glm::dvec3, 3> corners;
  // the facet across the edge opposite to each corner
  std::array<int, 3> beyond;
};

// Returns the triangles of the convex hull. The result is empty for points in one plane.
std::vector<HullFacet> hull_of(std::vector<glm::dvec3> points) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere{std::fopen("/dev/null", "w"),
                                                                &std::fclose};
  if (!nowhere || points.size() < 4) return {};
  qhT context;
  qhT* qh = &context;
  qh_zero(qh, nowhere.get());
  char command[] = "qhull Qt Pp";
  std::vector<HullFacet> facets;
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(points.size()), &points[0].x, False,
                                  command, nowhere.get(), nowhere.get());
  if (failed == 0) {
    std::unordered_map<unsigned, int> number;
    facetT *facet, *neighbor, **neighborp;
    vertexT *vertex, **vertexp;
    FORALLfacets number.emplace(facet->id, static_cast<int>(number.size()));
    FORALLfacets {
      HullFacet made{{facet->normal[0], facet->normal[1], facet->normal[2]}, {}, {-1, -1, -1}};
      std::size_t k = 0;
      FOREACHvertex_(facet->vertices) if (k < 3)
          made.corners[k++] = {vertex->point[0], vertex->point[1], vertex->point[2]};
      k = 0;
      FOREACHneighbor_(facet) if (k < 3) made.beyond[k++] = number[neighbor->id];
      facets.push_back(made);
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int remaining = 0, bytes = 0;
  qh_memfreeshort(qh, &remaining, &bytes);
  return facets;
}

// Returns the solid angle seen from the origin (Van Oosterom and Strackee, 1983).
double solid_angle(const HullFacet& facet) {
  const auto& [a, b, c] = facet.corners;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double below =
      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2 * std::abs(std::atan2(glm::dot(a, glm::cross(b, c)), below));
}

// Returns the facet to which the object rolls from this facet, or this facet if the object rests on
// it.
int next_of(const std::vector<HullFacet>& facets, int at) {
  const HullFacet& facet = facets[static_cast<std::size_t>(at)];
  const auto& [a, b, c] = facet.corners;
  // the projection of the origin, which is the center of mass
  const glm::dvec3 foot = glm::dot(a, facet.normal) * facet.normal;
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const std::array<double, 3> weights{glm::dot(glm::cross(c - b, foot - b), across),
                                      glm::dot(glm::cross(a - c, foot - c), across),
                                      glm::dot(glm::cross(b - a, foot - a), across)};
  const auto least = std::ranges::min_element(weights);
  if (*least >= 0) return at;
  const int next = facet.beyond[static_cast<std::size_t>(least - weights.begin())];
  if (next < 0) return at;
  const auto height = [](const HullFacet& of) { return glm::dot(of.corners[0], of.normal); };
  return height(facets[static_cast<std::size_t>(next)]) < height(facet) ? next : at;
}

// Returns the breadth of the support, 0…1. It combines the share of the outline between the contact
// points with the share that touches the ground. A bust on its back has three contact points.
// Upright it rests on its whole base.
double support_share(const Shape& shape, const std::vector<glm::dvec3>& corners,
                     const HullFacet& facet) {
  const glm::dvec3 side = glm::normalize(facet.corners[1] - facet.corners[0]),
                   ahead = glm::cross(facet.normal, side);
  const double ground = glm::dot(facet.corners[0], facet.normal);
  std::vector<glm::dvec2> outline, contact;
  for (const glm::dvec3& corner : corners) {
    const glm::dvec2 flat(glm::dot(corner, side), glm::dot(corner, ahead));
    outline.push_back(flat);
    if (glm::dot(corner, facet.normal) > ground - kContact) contact.push_back(flat);
  }
  const double whole = area_of(convex_hull(std::move(outline)));
  if (!(whole > 0)) return 0;
  double touching = 0;
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const glm::dvec3 &a = shape.points[shape.triangles[t]],
                     &b = shape.points[shape.triangles[t + 1]],
                     &c = shape.points[shape.triangles[t + 2]];
    if (glm::dot(a + b + c, facet.normal) < 3 * (ground - kContact)) continue;
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double level = std::abs(glm::dot(across, facet.normal));
    if (level > kLevel * glm::length(across)) touching += level / 2;
  }
  return std::sqrt(area_of(convex_hull(std::move(contact))) / whole *
                   std::min(1.0, touching / whole));
}

std::array<double, 6> poses_of(const Shape& shape) {
  std::array<double, 6> poses{};
  const std::vector<HullFacet> facets = hull_of(outer_points(shape));
  std::vector<double> likely(facets.size(), 0);
  for (std::size_t i = 0; i < facets.size(); ++i) {
    int at = static_cast<int>(i);
    for (std::size_t step = 0; step < facets.size(); ++step) {
      const int next = next_of(facets, at);
      if (next == at) break;
      at = next;
    }
    likely[static_cast<std::size_t>(at)] += solid_angle(facets[i]) / (4 * glm::pi<double>());
  }
  std::vector<glm::dvec3> corners;
  for (const HullFacet& facet : facets)
    corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
  // Each facet needs a pass over all triangles, so only the most likely facets are examined, and of
  // these only the facets with an axis pointing up.
  std::vector<std::size_t> order(facets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, std::greater(), [&](std::size_t i) { return likely[i]; });
  int looked_at = 0;
  for (const std::size_t i : order) {
    if (likely[i] < kUnlikely || looked_at == kMaxPoses) break;
    std::array<double, 6> weights{};
    for (std::size_t d = 0; d < 6; ++d) {
      const double along = glm::dot(-facets[i].normal, up_frame(kUpDirections[d]).up);
      weights[d] =
          std::max(0.0, 1 - glm::degrees(std::acos(std::clamp(along, -1.0, 1.0))) / kTilt_degrees);
    }
    if (std::ranges::max(weights) <= 0) continue;
    ++looked_at;
    const double pose = likely[i] * support_share(shape, corners, facets[i]);
    for (std::size_t d = 0; d < 6; ++d) poses[d] += pose * weights[d];
  }
  return poses;
}

// The outline and the heights of the object along an axis, seen from both ends.
class Silhouette {
 public:
  Silhouette(const Shape& shape, int axis)
      : u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        low_(shape.low[axis]),
        height_(shape.high[axis] - shape.low[axis]) {
    const glm::dvec3 size = glm::max(shape.high - shape.low, glm::dvec3(1e-12));
    aspect_ = std::min(size[u_], size[v_]) / std::max(size[u_], size[v_]);
    const double cell = std::min(size[u_], size[v_]) / kCells;
    for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
      const glm::dvec3 &a = shape.points[shape.triangles[t]],
                       &b = shape.points[shape.triangles[t + 1]],
                       &c = shape.points[shape.triangles[t + 2]];
      const double facing = glm::cross(b - a, c - a)[axis];
      const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
      const int steps = std::clamp(static_cast<int>(std::ceil(longest / cell)), 1, 2 * kCells);
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const glm::dvec3 p = a + (b - a) * (double(i) / steps) + (c - a) * (double(j) / steps);
          const int x = std::clamp(static_cast<int>((p[u_] - shape.low[u_]) / size[u_] * kCells), 0,
                                   kCells - 1);
          const int y = std::clamp(static_cast<int>((p[v_] - shape.low[v_]) / size[v_] * kCells), 0,
                                   kCells - 1);
          put(static_cast<std::size_t>(y * kCells + x), p[axis], facing);
        }
    }
  }

  // Returns the mean depth of the surface below its highest points. Only the area enclosed by these
  // points contributes, so the result increases with this area. A surface seen from its back is not
  // a hollow, because the scan has a hole there where the object was standing.
  double hollow_above() const { return hollow(+1); }
  double hollow_below() const { return hollow(-1); }

  // Returns the likelihood (0…1) of production on a wheel or a lathe, judged by the outline. The
  // result for a square is 0.
  double roundness() const {
    int both = 0, either = 0;
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const double dx = 2 * (x + 0.5) / kCells - 1, dy = 2 * (y + 0.5) / kCells - 1;
        const bool in_circle = dx * dx + dy * dy <= 1,
                   in_object = cells_[static_cast<std::size_t>(y * kCells + x)].is_covered;
        both += in_circle && in_object;
        either += in_circle || in_object;
      }
    constexpr double kSquare = 0.85;
    return std::clamp((aspect_ * both / std::max(either, 1) - kSquare) / (1 - kSquare), 0.0, 1.0);
  }

 private:
  struct Cell {
    double lowest = 0, highest = 0;
    // for the lowest and the highest point
    bool is_covered = false, faces_down = false, faces_up = false;
  };

  void put(std::size_t at, double height, double facing) {
    Cell& cell = cells_[at];
    if (!cell.is_covered || height < cell.lowest) {
      cell.lowest = height;
      cell.faces_down = facing < 0;
    }
    if (!cell.is_covered || height > cell.highest) {
      cell.highest = height;
      cell.faces_up = facing > 0;
    }
    cell.is_covered = true;
  }

  double hollow(int sign) const {
    if (!(height_ > 0)) return 0;
    const auto depth = [&](const Cell& cell) {
      return sign > 0 ? (low_ + height_ - cell.highest) / height_ : (cell.lowest - low_) / height_;
    };
    std::vector<glm::dvec2> rim;
    int covered = 0;
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const Cell& cell = cells_[static_cast<std::size_t>(y * kCells + x)];
        covered += cell.is_covered;
        if (cell.is_covered && depth(cell) < kTouching) rim.emplace_back(x, y);
      }
    const auto polygon = convex_hull(std::move(rim));
    double sum = 0;
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const Cell& cell = cells_[static_cast<std::size_t>(y * kCells + x)];
        if (cell.is_covered && (sign > 0 ? cell.faces_up : cell.faces_down) &&
            is_inside(polygon, {x, y}))
          sum += depth(cell);
      }
    return covered > 0 ? sum / covered : 0;
  }

  int u_, v_;
  double low_, height_, aspect_ = 1;
  std::vector<Cell> cells_ = std::vector<Cell>(std::size_t{kCells} * kCells);
};

}  // namespace

std::array<double, 6> up_shares(const TriangleMesh& mesh) {
  std::array<double, 6> shares = kPrior;
  const auto shape = shape_of(mesh);
  if (!shape) return shares;
  const auto poses = poses_of(*shape);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Silhouette seen(*shape, static_cast<int>(axis));
    const double opens_up = seen.hollow_above() - seen.hollow_below(),
                 round = std::exp(kRound * seen.roundness());
    shares[axis] *= round * std::exp(kHollow * opens_up);
    shares[axis + 3] *= round * std::exp(-kHollow * opens_up);
  }
  double sum = 0;
  for (std::size_t d = 0; d < 6; ++d) {
    shares[d] *= kAnyPose + poses[d];
    if (glm::length(shape->facing) > kSheet)
      shares[d] *= std::exp(kFront * glm::dot(shape->facing, up_frame(kUpDirections[d]).up));
    sum += shares[d];
  }
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace strata::mesh
