#include "mesh/search_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

// A tree of boxes over the triangles in the order in which the geometry stores them. That order follows a Morton curve,
// so halving it gives compact boxes without any sorting: a million triangles take some tens of milliseconds, and any
// other order would only be slower, never wrong. Queries compute in double.

namespace strata::mesh {
namespace {

constexpr std::size_t kLeafTriangles = 4;
constexpr int kMaxDepth = 64;

struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};
  void grow(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

double squared_distance(const Box& box, const glm::dvec3& p) {
  const glm::dvec3 outside = glm::max(glm::max(glm::dvec3(box.low) - p, p - glm::dvec3(box.high)), glm::dvec3(0));
  return glm::dot(outside, outside);
}

// Weights of the corners at the point of triangle a, b, c that is nearest to p (Ericson, Real-Time Collision
// Detection, 5.1.5). Written with differences of products only where the denominators cannot vanish; a triangle without
// area falls to its edges.
glm::dvec3 nearest_weights(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
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

// A ray prepared for the watertight test of Woop, Benthin and Wald (2013): the axis along which it is longest becomes
// z, and the others are sheared. Edges shared by two triangles give the same numbers with opposite sign, so no ray
// slips between them.
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

  // Entry distance of the box, or infinity. The factor covers the rounding of the three divisions.
  double enter(const Box& box, double limit) const {
    double near = 0, far = limit;
    for (int axis = 0; axis < 3; ++axis) {
      double t0 = (box.low[axis] - origin[axis]) * inverse[axis], t1 = (box.high[axis] - origin[axis]) * inverse[axis];
      if (t0 > t1) std::swap(t0, t1);
      // 0 × infinity: the ray runs inside the face of the box, which bounds nothing.
      if (t0 > near) near = t0;
      if (t1 < far) far = t1;
    }
    return near <= far * (1 + 1e-14) ? near : std::numeric_limits<double>::infinity();
  }

  // Distance to the triangle, in front of the origin; fills `weights`.
  std::optional<double> hit(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, glm::dvec3& weights) const {
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

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

struct SearchTree::Impl {
  explicit Impl(std::shared_ptr<const Geometry> source) : geometry(std::move(source)) {
    leaves = (geometry->triangle_count() + kLeafTriangles - 1) / kLeafTriangles;
    if (leaves == 0) return;
    nodes.resize(2 * leaves - 1);
    build(0, 0, leaves);
  }

  // A node over the leaves [first, last): its left child follows it, its right child comes after the left one's subtree
  // of 2n-1 nodes, so that no links are stored.
  void build(std::size_t node, std::size_t first, std::size_t last) {
    if (last - first == 1) {
      const std::size_t end = std::min(geometry->triangle_count(), (first + 1) * kLeafTriangles);
      for (std::size_t t = first * kLeafTriangles; t < end; ++t) {
        for (std::size_t k = 0; k < 3; ++k) nodes[node].grow(geometry->vertices[geometry->indices[3 * t + k]].position);
      }
      return;
    }
    const std::size_t middle = first + (last - first) / 2;
    const std::size_t left = node + 1, right = node + 2 * (middle - first);
    build(left, first, middle);
    build(right, middle, last);
    nodes[node].low = glm::min(nodes[left].low, nodes[right].low);
    nodes[node].high = glm::max(nodes[left].high, nodes[right].high);
  }

  std::array<glm::dvec3, 3> corners(std::size_t triangle) const {
    const std::uint32_t* i = &geometry->indices[3 * triangle];
    return {geometry->vertices[i[0]].position, geometry->vertices[i[1]].position, geometry->vertices[i[2]].position};
  }

  // Visits leaves in the order of `key` (of a box: distance so far, infinity to skip) while it is below `limit`, which
  // `visit` may lower.
  template <class Key, class Visit>
  void search(double& limit, Key key, Visit visit) const {
    struct Entry {
      double key;
      std::size_t node, first, last;
    };
    if (leaves == 0) return;
    std::array<Entry, kMaxDepth + 1> stack;
    int depth = 0;
    stack[depth++] = {key(nodes[0]), 0, 0, leaves};
    while (depth > 0) {
      const Entry entry = stack[--depth];
      if (!(entry.key <= limit)) continue;
      if (entry.last - entry.first == 1) {
        const std::size_t end = std::min(geometry->triangle_count(), entry.last * kLeafTriangles);
        for (std::size_t t = entry.first * kLeafTriangles; t < end; ++t) visit(t);
        continue;
      }
      const std::size_t middle = entry.first + (entry.last - entry.first) / 2;
      const std::size_t left = entry.node + 1, right = entry.node + 2 * (middle - entry.first);
      Entry near{key(nodes[left]), left, entry.first, middle}, far{key(nodes[right]), right, middle, entry.last};
      if (far.key < near.key) std::swap(near, far);
      if (far.key <= limit) stack[depth++] = far;
      if (near.key <= limit) stack[depth++] = near;
    }
  }

  template <class Accept>
  std::optional<Hit> nearest(const glm::vec3& point, float max_distance, Accept accept) const {
    if (!is_finite(point) || !(max_distance >= 0)) return std::nullopt;
    const glm::dvec3 p(point);
    double limit = double{max_distance} * max_distance;
    std::size_t found = std::numeric_limits<std::size_t>::max();
    glm::dvec3 found_weights(0);
    search(
        limit, [&](const Box& box) { return squared_distance(box, p); },
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
    const Vertex &a = geometry->vertices[i[0]], &b = geometry->vertices[i[1]], &c = geometry->vertices[i[2]];
    const auto [pa, pb, pc] = corners(triangle);
    // World positions tell the sides of triangles that are flat in float.
    const glm::dvec3& base = geometry->positions[a.position_index];
    const glm::dvec3 cross =
        glm::cross(geometry->positions[b.position_index] - base, geometry->positions[c.position_index] - base);
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
  std::vector<Box> nodes;
};

SearchTree::SearchTree(std::shared_ptr<const Geometry> geometry) : impl_(std::make_unique<Impl>(std::move(geometry))) {}
SearchTree::~SearchTree() = default;

std::optional<SearchTree::Hit> SearchTree::nearest(const glm::vec3& point, float max_distance) const {
  return impl_->nearest(point, max_distance,
                        [](const glm::dvec3&, const glm::dvec3&, const glm::dvec3&) { return true; });
}

std::optional<SearchTree::Hit> SearchTree::nearest_facing(const glm::vec3& point, float max_distance,
                                                          const glm::vec3& normal, float least_cos) const {
  const glm::dvec3 n(normal);
  return impl_->nearest(point, max_distance, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    return glm::dot(cross, n) >= double{least_cos} * glm::length(cross);
  });
}

std::optional<SearchTree::Hit> SearchTree::first_hit(const glm::vec3& origin, const glm::vec3& direction) const {
  const double length = glm::length(glm::dvec3(direction));
  if (!is_finite(origin) || !is_finite(direction) || !(length > 0)) return std::nullopt;
  const PreparedRay ray(glm::dvec3(origin), glm::dvec3(direction) / length);
  double limit = std::numeric_limits<double>::max();
  std::size_t found = std::numeric_limits<std::size_t>::max();
  glm::dvec3 found_weights(0);
  impl_->search(
      limit, [&](const Box& box) { return ray.enter(box, limit); },
      [&](std::size_t triangle) {
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
