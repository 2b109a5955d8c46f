#include "mesh/surface/search_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

// A tree of boxes over the triangles in the order of the geometry. That order follows a Hilbert
// curve, so runs of triangles have compact boxes without sorting. A million triangles take a few
// tens of milliseconds. Any other order would be slower but still correct. Each node has eight
// children. Their boxes are stored together, so vector instructions test several boxes at the same
// time. Triangles are computed in double precision.

namespace strata::mesh {
namespace {

constexpr std::size_t kLeafTriangles = 2;
constexpr std::size_t kWidth = 8;
constexpr std::size_t kMaxLevels = 12;  // 8^12 leaves

// The boxes of a node's children. The boxes of missing children are empty.
struct Boxes {
  Boxes() {
    for (auto& side : low) side.fill(std::numeric_limits<float>::infinity());
    for (auto& side : high) side.fill(-std::numeric_limits<float>::infinity());
  }
  void grow(std::size_t child, const glm::vec3& from, const glm::vec3& to) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis][child] = std::min(low[axis][child], from[axis]);
      high[axis][child] = std::max(high[axis][child], to[axis]);
    }
  }
  std::array<std::array<float, kWidth>, 3> low, high;
};
template <class Key>
using Keys = std::array<Key, kWidth>;

// Vectors that process several boxes at the same time. Compilers do not vectorize this code
// automatically, because they keep its branches.
template <class Number>
struct LanesOf {
  typedef Number Type __attribute__((vector_size(16)));
};
using Floats = LanesOf<float>::Type;
using Doubles = LanesOf<double>::Type;

template <class Lanes, class Number>
Lanes load(const Number* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

// Returns lower bounds of the squared distances of the boxes. The margin exceeds the rounding error
// of the floats and of the limit that they are compared with.
Keys<float> squared_distances(const Boxes& boxes, const glm::vec3& p) {
  constexpr std::size_t kLanes = sizeof(Floats) / sizeof(float);
  Keys<float> keys;
  for (std::size_t first = 0; first < kWidth; first += kLanes) {
    Floats sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float at = (&p.x)[axis];
      const Floats below = load<Floats>(&boxes.low[axis][first]) - at;
      const Floats above = at - load<Floats>(&boxes.high[axis][first]);
      const Floats farther = below > above ? below : above;
      const Floats outside = farther > 0.0f ? farther : Floats{};
      sum += outside * outside;
    }
    // The square of a very distant point may overflow float.
    const Floats most = Floats{} + std::numeric_limits<float>::max();
    const Floats lowered = (sum < most ? sum : most) * (1 - 1e-6f);
    std::memcpy(&keys[first], &lowered, sizeof lowered);
  }
  return keys;
}

// Returns the weights of the corners at the point of triangle a, b, c that is nearest to p
// (Ericson, Real-Time Collision Detection, 5.1.5). Uses differences of products only where the
// denominators cannot vanish. For a triangle without area, the nearest point is on its edges.
glm::dvec3 nearest_weights(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                           const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double e = d4 - d3, f = d5 - d6;
  if (va <= 0 && e >= 0 && f >= 0 && e + f > 0) return {0, 1 - e / (e + f), e / (e + f)};
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

// A ray prepared for the watertight test of Woop, Benthin and Wald (2013). The axis of the ray's
// longest component becomes z, and the other axes are sheared. Edges shared by two triangles give
// the same numbers with opposite signs, so no ray passes between the triangles.
struct PreparedRay {
  PreparedRay(const glm::dvec3& from, const glm::dvec3& along)
      : origin(from), direction(along + 0.0), inverse(1.0 / direction) {
    const glm::dvec3 size = glm::abs(direction);
    kz = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    if (direction[kz] < 0) std::swap(kx, ky);
    shear = glm::dvec3(direction[kx], direction[ky], 1.0) / direction[kz];
  }

  // Returns the entry distances of the boxes, or infinity. The factor 1 + 1e-14 allows for the
  // rounding errors of the distances.
  Keys<double> enter(const Boxes& boxes, double limit) const {
    constexpr std::size_t kLanes = sizeof(Doubles) / sizeof(double);
    Keys<double> keys;
    for (std::size_t begin = 0; begin < kWidth; begin += kLanes) {
      Doubles near{}, far = Doubles{} + limit;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = (&origin.x)[axis], scale = (&inverse.x)[axis];
        // `first` is the side that the ray enters first.
        const float* first = &(scale < 0 ? boxes.high : boxes.low)[axis][begin];
        const float* last = &(scale < 0 ? boxes.low : boxes.high)[axis][begin];
        const Doubles t0 = (Doubles{first[0], first[1]} - at) * scale,
                      t1 = (Doubles{last[0], last[1]} - at) * scale;
        // 0 × infinity means that the ray is in the plane of a face of the box. The face is then
        // not a bound.
        near = t0 > near ? t0 : near;
        far = t1 < far ? t1 : far;
      }
      const Doubles none = Doubles{} + std::numeric_limits<double>::infinity();
      const Doubles entry = near <= far * (1 + 1e-14) ? near : none;
      std::memcpy(&keys[begin], &entry, sizeof entry);
    }
    return keys;
  }

  // Returns the distance to the triangle in front of the origin and sets `weights`.
  std::optional<double> hit(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                            glm::dvec3& weights) const {
    const glm::dvec3 pa = a - origin, pb = b - origin, pc = c - origin;
    const double ax = pa[kx] - shear.x * pa[kz], ay = pa[ky] - shear.y * pa[kz];
    const double bx = pb[kx] - shear.x * pb[kz], by = pb[ky] - shear.y * pb[kz];
    const double cx = pc[kx] - shear.x * pc[kz], cy = pc[ky] - shear.y * pc[kz];
    const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const double sum = u + v + w;
    if (sum == 0) return std::nullopt;
    weights = glm::dvec3(u, v, w) / sum;
    const double t = shear.z * (weights.x * pa[kz] + weights.y * pb[kz] + weights.z * pc[kz]);
    if (!(t >= 0)) return std::nullopt;
    return t;
  }

  glm::dvec3 origin, direction, inverse, shear;
  int kx = 0, ky = 1, kz = 2;
};

bool is_finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

struct SearchTree::Impl {
  explicit Impl(std::shared_ptr<const Geometry> source) : geometry(std::move(source)) {
    leaves = (geometry->triangle_count() + kLeafTriangles - 1) / kLeafTriangles;
    if (leaves == 0) return;
    levels.emplace_back((leaves + kWidth - 1) / kWidth);
    for (std::size_t t = 0; t < geometry->triangle_count(); ++t) {
      const std::size_t leaf = t / kLeafTriangles;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3& corner = geometry->vertices[geometry->indices[3 * t + k]].position;
        levels.front()[leaf / kWidth].grow(leaf % kWidth, corner, corner);
      }
    }
    while (levels.back().size() > 1) {
      const auto& below = levels.back();
      std::vector<Boxes> nodes((below.size() + kWidth - 1) / kWidth);
      for (std::size_t i = 0; i < below.size(); ++i)
        for (std::size_t child = 0; child < kWidth; ++child) {
          const auto corner = [&](const auto& side) {
            return glm::vec3(side[0][child], side[1][child], side[2][child]);
          };
          nodes[i / kWidth].grow(i % kWidth, corner(below[i].low), corner(below[i].high));
        }
      levels.push_back(std::move(nodes));
    }
  }

  std::array<glm::dvec3, 3> corners(std::size_t triangle) const {
    const std::uint32_t* i = &geometry->indices[3 * triangle];
    return {geometry->vertices[i[0]].position, geometry->vertices[i[1]].position,
            geometry->vertices[i[2]].position};
  }

  // Visits the triangles of leaves in the order of the leaves' keys, up to the key `limit`. `visit`
  // may lower the limit. `keys_of` returns the keys of a node's children. A key is a distance, or
  // infinity to skip the child.
  template <class Key, class KeysOf, class Visit>
  void search(double& limit, KeysOf keys_of, Visit visit) const {
    struct Entry {
      Key key;
      std::uint32_t index;
      std::uint32_t level;  // level of nodes, beginning with 1 for the lowest; 0: a leaf
    };
    if (levels.empty()) return;
    std::array<Entry, kMaxLevels * kWidth> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, 0, static_cast<std::uint32_t>(levels.size())};
    while (depth > 0) {
      const Entry entry = stack[--depth];
      const Key most = static_cast<Key>(limit);
      if (!(entry.key <= most)) continue;
      if (entry.level == 0) {
        const std::size_t first = std::size_t{entry.index} * kLeafTriangles;
        const std::size_t end = std::min(geometry->triangle_count(), first + kLeafTriangles);
        for (std::size_t t = first; t < end; ++t) visit(t);
        continue;
      }
      const Keys<Key> keys = keys_of(levels[entry.level - 1][entry.index]);
      const std::size_t below = entry.level == 1 ? leaves : levels[entry.level - 2].size();
      const std::size_t first_child = std::size_t{entry.index} * kWidth;
      const std::size_t first = depth, children = std::min(kWidth, below - first_child);
      // The CPU cannot predict which children are near. Branches would therefore take longer than
      // the box tests.
      std::array<std::uint8_t, kWidth> near{};
      std::size_t count = 0;
      for (std::size_t child = 0; child < children; ++child) {
        near[count] = static_cast<std::uint8_t>(child);
        count += keys[child] <= most ? 1 : 0;
      }
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t child = near[i];
        // The nearest child is on top of the stack.
        std::size_t place = depth++;
        for (; place > first && stack[place - 1].key < keys[child]; --place)
          stack[place] = stack[place - 1];
        stack[place] = {keys[child], static_cast<std::uint32_t>(first_child + child),
                        entry.level - 1};
      }
    }
  }

  template <class Accept>
  std::optional<Hit> nearest(const glm::vec3& point, float max_distance, Accept accept) const {
    if (!is_finite(point) || !(max_distance >= 0)) return std::nullopt;
    const glm::dvec3 p(point);
    double limit = double{max_distance} * max_distance;
    std::size_t found = std::numeric_limits<std::size_t>::max();
    glm::dvec3 found_weights(0);
    search<float>(
        limit, [&](const Boxes& boxes) { return squared_distances(boxes, point); },
        [&](std::size_t triangle) {
          const auto [a, b, c] = corners(triangle);
          const glm::dvec3 weights = nearest_weights(p, a, b, c);
          const glm::dvec3 offset = weights.x * a + weights.y * b + weights.z * c - p;
          const double squared = glm::dot(offset, offset);
          if (squared > limit || (squared == limit && triangle > found) || !accept(a, b, c)) return;
          limit = squared;
          found = triangle;
          found_weights = weights;
        });
    if (found == std::numeric_limits<std::size_t>::max()) return std::nullopt;
    return make_hit(found, found_weights, std::sqrt(limit));
  }

  Hit make_hit(std::size_t triangle, const glm::dvec3& weights, double distance) const {
    const std::uint32_t* i = &geometry->indices[3 * triangle];
    const Vertex &a = geometry->vertices[i[0]], &b = geometry->vertices[i[1]],
                 &c = geometry->vertices[i[2]];
    const auto [pa, pb, pc] = corners(triangle);
    // Uses world positions, because some triangles have an area only in double precision.
    const glm::dvec3& base = geometry->positions[a.position_index];
    const glm::dvec3 cross = glm::cross(geometry->positions[b.position_index] - base,
                                        geometry->positions[c.position_index] - base);
    const double length = glm::length(cross);
    Hit hit;
    hit.position = glm::vec3(weights.x * pa + weights.y * pb + weights.z * pc);
    hit.normal = length > 0 ? glm::vec3(cross / length) : glm::vec3(0, 0, 1);
    hit.barycentric = glm::vec3(weights);
    hit.uv = hit.barycentric.x * a.uv + hit.barycentric.y * b.uv + hit.barycentric.z * c.uv;
    hit.distance = static_cast<float>(distance);
    hit.triangle = static_cast<std::uint32_t>(triangle);
    return hit;
  }

  std::shared_ptr<const Geometry> geometry;
  std::size_t leaves = 0;
  std::vector<std::vector<Boxes>> levels;  // lowest nodes first; their children are leaves
};

SearchTree::SearchTree(std::shared_ptr<const Geometry> geometry)
    : impl_(std::make_unique<Impl>(std::move(geometry))) {}
SearchTree::~SearchTree() = default;

std::optional<SearchTree::Hit> SearchTree::nearest(const glm::vec3& point,
                                                   float max_distance) const {
  return impl_->nearest(
      point, max_distance,
      [](const glm::dvec3&, const glm::dvec3&, const glm::dvec3&) { return true; });
}

std::optional<SearchTree::Hit> SearchTree::nearest_facing(const glm::vec3& point,
                                                          float max_distance,
                                                          const glm::vec3& normal,
                                                          float least_cos) const {
  const glm::dvec3 n(normal);
  return impl_->nearest(point, max_distance,
                        [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
                          const glm::dvec3 cross = glm::cross(b - a, c - a);
                          return glm::dot(cross, n) >= double{least_cos} * glm::length(cross);
                        });
}

std::optional<SearchTree::Hit> SearchTree::first_hit(const glm::vec3& origin,
                                                     const glm::vec3& direction,
                                                     const PartSet& hidden_parts) const {
  const double length = glm::length(glm::dvec3(direction));
  if (!is_finite(origin) || !is_finite(direction) || !(length > 0)) return std::nullopt;
  const PreparedRay ray(glm::dvec3(origin), glm::dvec3(direction) / length);
  const Geometry& geometry = *impl_->geometry;
  const bool hides = hidden_parts.any() && !geometry.part_ends.empty();
  const auto is_hidden = [&](std::size_t triangle) {
    return hidden_parts.test(
        static_cast<std::size_t>(geometry.part_of(static_cast<std::uint32_t>(triangle))));
  };
  double limit = std::numeric_limits<double>::max();
  std::size_t found = std::numeric_limits<std::size_t>::max();
  glm::dvec3 found_weights(0);
  impl_->search<double>(
      limit, [&](const Boxes& boxes) { return ray.enter(boxes, limit); },
      [&](std::size_t triangle) {
        if (hides && is_hidden(triangle)) return;
        const auto [a, b, c] = impl_->corners(triangle);
        glm::dvec3 weights(0);
        const auto distance = ray.hit(a, b, c, weights);
        if (!distance || *distance > limit || (*distance == limit && triangle > found)) return;
        limit = *distance;
        found = triangle;
        found_weights = weights;
      });
  if (found == std::numeric_limits<std::size_t>::max()) return std::nullopt;
  return impl_->make_hit(found, found_weights, limit);
}

}  // namespace strata::mesh
