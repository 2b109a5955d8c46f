#pragma once

#include <span>

#include "bench/peers/octree.h"
#include "domain/scene/camera.h"
#include "render/view/depth_copy.h"

namespace strata::bench {

// A layer of an octree in main memory: the values, and their colors for the GPU.
struct OctreeLayer {
  std::vector<std::uint8_t> values;
  std::vector<std::uint32_t> colors;
  std::vector<std::uint8_t> dirty;  // one flag for each kLeavesPerRange leaves
  static constexpr std::size_t kLeavesPerRange = 4096;

  explicit OctreeLayer(const Octree& tree)
      : values(tree.leaf_count()),
        colors(tree.leaf_count()),
        dirty((tree.leaf_count() + kLeavesPerRange - 1) / kLeavesPerRange) {}
  std::size_t bytes() const {
    return values.size() + colors.size() * sizeof(colors[0]) + dirty.size();
  }
};

// A dab with a disc. `center` is in window pixels from the top left.
struct OctreeDab {
  Camera camera;
  glm::dvec3 origin{0};  // the origin of the model
  glm::dvec2 center{0};
  double radius_px = 0;
  std::uint8_t value = 0;
  std::uint32_t color = 0;
};

// The published method: casts one ray through the center of each pixel under the tool, on one
// thread, and paints the first leaf that each ray meets. The traversal follows Revelles et al.
// 2000. Returns the number of rays that met a leaf.
std::size_t paint_by_rays(const Octree& tree, const OctreeDab& dab, OctreeLayer& layer);

// The improved method, for a fair comparison: paints every leaf whose center is under the tool and
// at most two cells behind the depth buffer. It misses no leaf even if cells are smaller than
// pixels. It descends the tree with planes around the tool, skips nodes that the coarse depth
// hides, and uses `threads` threads. Returns the number of painted leaves.
std::size_t paint_by_descent(const Octree& tree, const OctreeDab& dab,
                             const render::DepthCopy& depth, int threads, OctreeLayer& layer);

// Returns how far behind the depth buffer a leaf may be: two cells, as window depth · w².
double octree_depth_tolerance(const Octree& tree, const Camera& camera);

}  // namespace strata::bench
