#include "bench/peers/octree_edit.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "mesh/parallel.h"
#include "render/edit/tool_path.h"
#include "shared/depth_probe.h"

namespace strata::bench {
namespace {

constexpr std::int64_t kMiss = -1;

glm::dmat4 clip_of(const OctreeDab& dab) {
  return dab.camera.projection * dab.camera.view * glm::translate(glm::dmat4(1.0), dab.origin);
}

void paint(const OctreeDab& dab, std::size_t leaf, OctreeLayer& layer) {
  layer.values[leaf] = dab.value;
  layer.colors[leaf] = dab.color;
  std::atomic_ref(layer.dirty[leaf / OctreeLayer::kLeavesPerRange])
      .store(1, std::memory_order_relaxed);
}

// -------------------------------------------------------------------------------------------------------------
// Painting by rays

// The distances along a ray at which it enters and leaves a node, one pair for each axis. The ray
// ascends on every axis.
struct Span {
  glm::vec3 enter, leave;
};

class RayWalk {
 public:
  // Bit i of `flipped` is set if the ray was mirrored on axis i to ascend.
  RayWalk(const Octree& tree, std::uint32_t flipped) : tree_(tree), flipped_(flipped) {}

  std::int64_t first_leaf(int depth, std::uint32_t node, const Span& span) const {
    if (span.leave.x < 0 || span.leave.y < 0 || span.leave.z < 0) return kMiss;
    if (depth == tree_.depth()) return node;
    const Octree::Node& here = tree_.level(depth)[node];
    const glm::vec3 middle = 0.5f * (span.enter + span.leave);
    // Selects the first child. On each axis the child is in the upper half if the ray passes the
    // middle before it enters the node.
    const float entered = std::max({span.enter.x, span.enter.y, span.enter.z});
    std::uint32_t child = 0;
    for (int axis = 0; axis < 3; ++axis) child |= middle[axis] < entered ? 1u << axis : 0u;
    for (;;) {
      Span part;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = child >> axis & 1;
        part.enter[axis] = upper ? middle[axis] : span.enter[axis];
        part.leave[axis] = upper ? span.leave[axis] : middle[axis];
      }
      const std::uint32_t stored = child ^ flipped_;
      if (here.mask >> stored & 1) {
        const auto before =
            static_cast<std::uint32_t>(std::popcount(here.mask & ((1u << stored) - 1)));
        const std::int64_t leaf = first_leaf(depth + 1, here.first + before, part);
        if (leaf != kMiss) return leaf;
      }
      const int axis = part.leave.x < part.leave.y ? (part.leave.x < part.leave.z ? 0 : 2)
                                                   : (part.leave.y < part.leave.z ? 1 : 2);
      if (child >> axis & 1) return kMiss;  // the ray leaves the node
      child |= 1u << axis;
    }
  }

 private:
  const Octree& tree_;
  const std::uint32_t flipped_;
};

// Returns the first leaf on a ray. `from` and `to` are points on the ray, in units of the cube.
std::int64_t cast(const Octree& tree, const glm::dvec3& from, const glm::dvec3& to) {
  glm::dvec3 start = from, way = glm::normalize(to - from);
  std::uint32_t flipped = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] >= 0) continue;
    start[axis] = 1 - start[axis];
    way[axis] = -way[axis];
    flipped |= 1u << axis;
  }
  way = glm::max(way, glm::dvec3(1e-12));
  const Span span{glm::vec3(-start / way), glm::vec3((1.0 - start) / way)};
  if (std::max({span.enter.x, span.enter.y, span.enter.z}) >=
      std::min({span.leave.x, span.leave.y, span.leave.z}))
    return kMiss;
  return RayWalk(tree, flipped).first_leaf(0, 0, span);
}

// ----------------------------------------------------------------------------------------------------------
// Painting by descent

constexpr int kPlanes = 8;  // an octagon around the disc

// The values for the tests of a node, which are linear in its center: the eight distances from the
// planes, and the clip coordinates x, y, z and w.
struct alignas(16) Place {
  float planes[kPlanes];
  float clip[4];
};

struct Pending {
  Place place;
  std::uint32_t node;
  int depth;
  bool inside;  // inside all planes
};

class Descent {
 public:
  Descent(const Octree& tree, const OctreeDab& dab, const render::DepthCopy& depth,
          OctreeLayer& layer)
      : tree_(tree), dab_(dab), depth_(depth), layer_(layer) {
    const glm::dmat4 clip = clip_of(dab), rows = glm::transpose(clip);
    const double width = dab.camera.width, height = dab.camera.height;
    center_ = {static_cast<float>(dab.center.x), static_cast<float>(height - dab.center.y)};
    // The product of window x and w is linear in the position, and so is each side of the octagon.
    const glm::dvec4 window_x = 0.5 * width * (rows[0] + rows[3]),
                     window_y = 0.5 * height * (rows[1] + rows[3]);
    const double half = std::sqrt(0.5);
    const glm::dvec2 normals[kPlanes] = {{1, 0},        {-1, 0},       {0, 1},
                                         {0, -1},       {half, half},  {half, -half},
                                         {-half, half}, {-half, -half}};
    glm::dvec4 linear[kPlanes + 4];
    for (int i = 0; i < kPlanes; ++i) {
      const glm::dvec2 n = normals[i];
      const double reach = dab.radius_px + glm::dot(n, glm::dvec2(center_));
      linear[i] = reach * rows[3] - n.x * window_x - n.y * window_y;
      linear[i] /= glm::length(glm::dvec3(linear[i]));
    }
    for (int i = 0; i < 4; ++i) linear[kPlanes + i] = rows[i];
    root_ = place_at(linear, glm::dvec3(tree.low()) + 0.5 * tree.side(), 1);
    double side = tree.side();
    for (int level = 0; level <= tree.depth(); ++level, side *= 0.5) {
      const double reach = side * std::sqrt(3.0) * 0.5;
      radius_.push_back(static_cast<float>(reach * 1.001));
      w_reach_.push_back(static_cast<float>(reach * 1.001 * glm::length(glm::dvec3(rows[3]))));
      auto& steps = steps_.emplace_back();  // from a parent on this level to its children
      for (std::uint32_t child = 0; child < 8; ++child) {
        const glm::dvec3 sign(child & 1 ? 1 : -1, child & 2 ? 1 : -1, child & 4 ? 1 : -1);
        steps[child] = place_at(linear, sign * side * 0.25, 0);
      }
    }
    pixels_per_w_ = static_cast<float>(0.5 * height * std::abs(dab.camera.projection[1][1]) *
                                       render::view_scale(dab.camera));
    tolerance_ = static_cast<float>(octree_depth_tolerance(tree, dab.camera));
    depth_scale_ =
        static_cast<float>(octree_depth_tolerance(tree, dab.camera) / (2 * tree.cell_side()));
    squared_radius_ = static_cast<float>(dab.radius_px * dab.radius_px);
  }

  std::size_t run(int threads) const {
    std::vector<Pending> front{{root_, 0, 0, false}};
    std::atomic<std::size_t> painted{0};
    // Descend level by level until there is work for all threads.
    while (!front.empty() && front.size() < 64 * static_cast<std::size_t>(threads) &&
           front[0].depth < tree_.depth()) {
      std::vector<Pending> next;
      for (const Pending& pending : front) {
        std::array<Pending, 8> children;
        const int count = open(pending, children.data());
        next.insert(next.end(), children.begin(), children.begin() + count);
      }
      front = std::move(next);
    }
    mesh::parallel_for(threads, static_cast<int>(front.size()),
                       [&](int i) { painted += walk(front[static_cast<std::size_t>(i)]); });
    return painted;
  }

 private:
  static Place place_at(const glm::dvec4* linear, const glm::dvec3& at, double one) {
    Place place;
    for (int i = 0; i < kPlanes; ++i)
      place.planes[i] = static_cast<float>(glm::dot(linear[i], glm::dvec4(at, one)));
    for (int i = 0; i < 4; ++i)
      place.clip[i] = static_cast<float>(glm::dot(linear[kPlanes + i], glm::dvec4(at, one)));
    return place;
  }

  std::size_t walk(const Pending& first) const {
    // Descend depth first, so at most seven nodes wait on each level.
    std::array<Pending, 8 * 16> stack;
    std::size_t waiting = 1, painted = 0;
    stack[0] = first;
    while (waiting > 0) {
      const Pending pending = stack[--waiting];
      if (pending.depth == tree_.depth()) {
        painted += paint_leaf(pending) ? 1 : 0;
        continue;
      }
      waiting += static_cast<std::size_t>(open(pending, &stack[waiting]));
    }
    return painted;
  }

  // Adds the children that the tool may reach to `children`. Returns their number.
  int open(const Pending& pending, Pending* children) const {
    const Octree::Node& node = tree_.level(pending.depth)[pending.node];
    const auto& steps = steps_[static_cast<std::size_t>(pending.depth)];
    std::uint32_t next = node.first;
    int count = 0;
    for (std::uint32_t mask = node.mask; mask != 0; mask &= mask - 1) {
      Pending& child = children[count];
      const Place& step = steps[static_cast<std::size_t>(std::countr_zero(mask))];
      for (int i = 0; i < kPlanes; ++i)
        child.place.planes[i] = pending.place.planes[i] + step.planes[i];
      for (int i = 0; i < 4; ++i) child.place.clip[i] = pending.place.clip[i] + step.clip[i];
      child.node = next++;
      child.depth = pending.depth + 1;
      child.inside = pending.inside;
      if (reaches(child)) ++count;
    }
    return count;
  }

  bool reaches(Pending& child) const {
    const float radius = radius_[static_cast<std::size_t>(child.depth)];
    if (!child.inside) {
      float nearest = child.place.planes[0];
      for (int i = 1; i < kPlanes; ++i) nearest = std::min(nearest, child.place.planes[i]);
      if (nearest < -radius) return false;
      child.inside = nearest > radius;
    }
    return child.depth == tree_.depth() || !is_hidden(child);
  }

  // Returns whether the node is behind the coarse depth of the depth cells that it covers. Returns
  // false for a large node, which would need too many tests.
  bool is_hidden(const Pending& node) const {
    const float w = node.place.clip[3] - w_reach_[static_cast<std::size_t>(node.depth)];
    if (w <= 0) return false;
    const float radius = radius_[static_cast<std::size_t>(node.depth)];
    const float radius_px = pixels_per_w_ * radius / w;
    if (!(radius_px < static_cast<float>(shader::kDepthCell))) return false;
    const glm::vec3 window = to_window(node.place);
    if (window.z - depth_scale_ * (radius + 3 * tree_.cell_side()) / (w * w) <= 0) return false;
    const float nearest = window.z - depth_scale_ * (radius + 3 * tree_.cell_side()) / (w * w);
    const int cells_x = (depth_.width + kCell - 1) / kCell,
              cells_y = (depth_.height + kCell - 1) / kCell;
    const auto cell = [](float pixel, int count) {
      return std::clamp(static_cast<int>(pixel) / kCell, 0, count - 1);
    };
    for (int y = cell(window.y - radius_px, cells_y); y <= cell(window.y + radius_px, cells_y); ++y)
      for (int x = cell(window.x - radius_px, cells_x); x <= cell(window.x + radius_px, cells_x);
           ++x)
        if (depth_.grid[static_cast<std::size_t>(y * cells_x + x)] >= nearest) return false;
    return true;
  }

  bool paint_leaf(const Pending& leaf) const {
    const float w = leaf.place.clip[3];
    if (w <= 0 || std::abs(leaf.place.clip[2]) > w) return false;
    const glm::vec3 window = to_window(leaf.place);
    const glm::vec2 from_center = glm::vec2(window) - center_;
    if (glm::dot(from_center, from_center) >= squared_radius_) return false;
    if (window.x < 0 || window.y < 0 || window.x >= static_cast<float>(depth_.width) ||
        window.y >= static_cast<float>(depth_.height))
      return false;
    const auto pixel = static_cast<std::size_t>(window.y) * static_cast<std::size_t>(depth_.width) +
                       static_cast<std::size_t>(window.x);
    if (window.z - tolerance_ / (w * w) > depth_.depth[pixel]) return false;
    paint(dab_, leaf.node, layer_);
    return true;
  }

  glm::vec3 to_window(const Place& place) const {
    const float inverse = 1 / place.clip[3];
    return {(place.clip[0] * inverse * 0.5f + 0.5f) * static_cast<float>(depth_.width),
            (place.clip[1] * inverse * 0.5f + 0.5f) * static_cast<float>(depth_.height),
            place.clip[2] * inverse * 0.5f + 0.5f};
  }

  static constexpr int kCell = static_cast<int>(shader::kDepthCell);
  const Octree& tree_;
  const OctreeDab& dab_;
  const render::DepthCopy& depth_;
  OctreeLayer& layer_;
  Place root_;
  std::vector<std::array<Place, 8>> steps_;
  std::vector<float> radius_, w_reach_;  // one value for each level
  glm::vec2 center_{0};
  float pixels_per_w_ = 0, tolerance_ = 0, depth_scale_ = 0, squared_radius_ = 0;
};

}  // namespace

double octree_depth_tolerance(const Octree& tree, const Camera& camera) {
  const auto& p = camera.projection;
  const double depth_per_unit = 0.5 * std::abs(p[2][2] * p[3][3] - p[3][2] * p[2][3]);
  return 2 * tree.cell_side() * render::view_scale(camera) * depth_per_unit;
}

std::size_t paint_by_rays(const Octree& tree, const OctreeDab& dab, OctreeLayer& layer) {
  const glm::dmat4 model_from_clip = glm::inverse(clip_of(dab));
  const double width = dab.camera.width, height = dab.camera.height;
  const auto in_cube = [&](double x, double y, double z) {
    const glm::dvec4 p = model_from_clip * glm::dvec4(2 * x / width - 1, 1 - 2 * y / height, z, 1);
    return (glm::dvec3(p) / p.w - glm::dvec3(tree.low())) / static_cast<double>(tree.side());
  };
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v))); };
  const double r = dab.radius_px;
  std::size_t hits = 0;
  for (int y = first(dab.center.y - r); y < std::min(height, dab.center.y + r); ++y) {
    for (int x = first(dab.center.x - r); x < std::min(width, dab.center.x + r); ++x) {
      const glm::dvec2 at(x + 0.5, y + 0.5), off = at - dab.center;
      if (glm::dot(off, off) >= r * r) continue;
      const std::int64_t leaf = cast(tree, in_cube(at.x, at.y, -1), in_cube(at.x, at.y, 1));
      if (leaf == kMiss) continue;
      paint(dab, static_cast<std::size_t>(leaf), layer);
      ++hits;
    }
  }
  return hits;
}

std::size_t paint_by_descent(const Octree& tree, const OctreeDab& dab,
                             const render::DepthCopy& depth, int threads, OctreeLayer& layer) {
  return Descent(tree, dab, depth, layer).run(threads);
}

}  // namespace strata::bench
