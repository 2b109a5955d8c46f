#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "domain/layers/tile.h"
#include "mesh/texels/surface_map.h"
#include "render/edit/depth_bias.h"
#include "render/edit/segment_lists.h"
#include "render/edit/tool_path.h"

namespace strata::render {

// The coarse grid of largest depths, which shows whether a block is hidden. See DepthBuffer.
struct DepthGrid {
  const float* cells = nullptr;  // null: nothing is hidden
  int width = 0, height = 0;     // in cells
};

struct CandidateBlock {
  std::uint32_t slot;
  TileAddress tile;
  std::uint32_t block_in_tile;  // x | y << 4
  std::uint32_t segments;       // index of the list's first entry in `segment_lists`
  std::uint32_t segment_count;
  std::uint32_t part;  // of the block tree; kManyParts: several parts of this block may be touched
  bool in_tool;        // the only segment of its list covers the whole block

  static constexpr std::uint32_t kManyParts = 0xffffffffu;
  const mesh::BoundingSphere& bounds(const mesh::SurfaceMap& map) const {
    return part == kManyParts ? map.bounds_of_slot[slot] : map.tree.levels[0][part];
  }
};
struct Candidates {
  std::vector<CandidateBlock> blocks;
  SegmentLists segment_lists;
};

// The parts of the block tree that a stroke may touch, grouped by tile.
struct TouchedParts {
  struct Part {
    std::uint32_t part;
    std::uint32_t segments;  // index of the list's first entry in `segment_lists`
    std::uint32_t segment_count;
    bool in_tool;
  };
  struct Tile {
    TileAddress address;
    std::size_t first, count;  // range in `parts`
  };
  std::vector<Part> parts;
  std::vector<Tile> tiles;  // row-major
  SegmentLists segment_lists;
};

// The exact box of a sphere in the window, with its nearest window depth `z0` and its smallest w,
// `w0`. `project_sphere` returns nothing for a sphere behind the eye, and the whole window for a
// sphere that the eye's plane intersects.
struct WindowBox {
  PixelBox box;
  double z0 = 0, w0 = 0;
};
std::optional<WindowBox> project_sphere(const glm::dmat4& clip_from_model, int width, int height,
                                        const glm::dvec3& center, double radius);

// Finds the blocks of the surface map that a stroke may touch. Projects bounding spheres to the
// window, level by level, and tests them against the window, the tool's segments and the depth
// grid. The test is conservative: it never rejects a texel that the edit would write. Each block
// gets the list of segments that may cover it. The constructor's arguments must outlive the object.
// Several threads may call const functions.
class BlockCuller {
 public:
  BlockCuller(const mesh::SurfaceMap& map, const glm::dmat4& clip_from_model, int width, int height,
              const ToolPath& path, const DepthBias& bias, const DepthGrid& grid);

  // Uses up to `threads` threads for large strokes.
  TouchedParts find(int threads) const;
  // Adds the blocks of a tile to `candidates`, row by row.
  void add_blocks(const TouchedParts& touched, const TouchedParts::Tile& tile,
                  Candidates& candidates) const;

 private:
  struct Under {
    std::vector<std::uint32_t> segments;
    bool all_of_it = false;  // the only segment in the list covers the whole subtree
  };
  struct Subtree {  // a subtree that passed the tests
    std::size_t level, index;
    Under under;
  };
  struct Found {  // the parts found in a subtree
    std::vector<TouchedParts::Part> parts;
    SegmentLists segment_lists;
  };
  using Scratch = std::array<Under, 16>;  // one for each level of the tree
  template <class Take>
  void descend(std::size_t level, std::size_t index, const Under& under, std::size_t stop_level,
               Scratch& scratch, Take&& take) const;
  std::vector<Subtree> find_subtrees() const;
  Found find_parts(const Subtree& subtree) const;
  bool passes(const mesh::BoundingSphere& bounds, const Under& parent, Under& under) const;
  std::optional<WindowBox> project(const mesh::BoundingSphere& bounds) const;
  bool leaves_out(const mesh::BoundingSphere& bounds) const;
  bool lies_under(const WindowBox& window, std::uint32_t segment) const;
  bool keep_covering(const WindowBox& window, std::vector<std::uint32_t>& list) const;
  bool is_hidden(const WindowBox& window) const;

  const mesh::SurfaceMap& map_;
  const glm::dmat4 clip_;
  const int width_, height_;
  const ToolPath& path_;
  const DepthBias bias_;
  const DepthGrid grid_;
  std::array<glm::dvec4, 4> tool_planes_;
};

}  // namespace strata::render
