#pragma once

#include <span>

#include "bench/peers/octree.h"
#include "domain/scene/camera.h"
#include "render/view/depth_copy.h"

namespace strata::bench {

// A layer of an octree in main memory: values, and the colours that are sent to the GPU to be
// shown.
struct OctreeLayer {
  std::vector<std::uint8_t> values;
  std::vector<std::uint32_t> colors;
  std::vector<std::uint8_t> dirty;  // of each kLeavesPerRange leaves
  static constexpr std::size_t kLeavesPerRange = 4096;

  explicit OctreeLayer(const Octree& tree)
      : values(tree.leaf_count()),
        colors(tree.leaf_count()),
        dirty((tree.leaf_count() + kLeavesPerRange - 1) / kLeavesPerRange) {}
  std::size_t bytes() const {
    return values.size() + colors.size() * sizeof(colors[0]) + dirty.size();
  }
};

// A dab of a disc; `center` in window pixels, origin top left.
struct OctreeDab {
  Camera camera;
  glm::dvec3 origin{0};  // of the model
  glm::dvec2 center{0};
  double radius_px = 0;
  std::uint8_t value = 0;
  std::uint32_t color = 0;
};

// As published: one ray through each pixel's centre under the tool, one thread; the first leaf on
// its way is painted. The way through the tree is that of Revelles et al. 2000. Answers how many
// rays met a leaf.
std::size_t paint_by_rays(const Octree& tree, const OctreeDab& dab, OctreeLayer& layer);

// The fair variant: every leaf is painted whose centre lies under the tool and not behind the depth
// buffer by more than two cells, so that no leaf is missed where cells are smaller than pixels.
// Goes down the tree by planes around the tool, leaves out what the coarse depth hides, and works
// on `threads` threads. Answers how many leaves were painted.
std::size_t paint_by_descent(const Octree& tree, const OctreeDab& dab,
                             const render::DepthCopy& depth, int threads, OctreeLayer& layer);

// How far behind the depth buffer a leaf may lie, in window depth · w²: two cells.
double octree_depth_tolerance(const Octree& tree, const Camera& camera);

}  // namespace strata::bench
