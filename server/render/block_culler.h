#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/tile.h"
#include "mesh/surface_map.h"
#include "render/tool_path.h"

namespace strata::render {

// Coarse grid of largest depths that hides blocks; see DepthBuffer.
struct DepthGrid {
  const float* cells = nullptr;  // null: nothing is hidden
  int width = 0, height = 0;     // cells
};

// How much nearer than the depth buffer a texel counts as: `fixed`, or (1 + slope_limit) · scale / w² at most.
struct DepthBias {
  std::optional<double> fixed;
  double scale = 0, slope_factor = 0, slope_limit = 0;
};

struct CandidateBlock {
  std::uint32_t slot;
  TileAddress tile;
  std::uint32_t block_in_tile;  // x | y << 4
  std::uint32_t segments;       // first in `segment_lists`
  std::uint32_t segment_count;
  bool in_tool;  // all of it lies under the one segment of its list
};
struct Candidates {
  std::vector<CandidateBlock> blocks;  // all blocks of a tile together
  std::vector<std::uint32_t> segment_lists;
  std::size_t last_list = 0;  // where the list that was added last begins

  std::size_t count_tiles() const;
};

// Exact window box of a sphere (`z0`: nearest window depth, `w0`: smallest w); empty when it is behind the eye; the whole
// window when the eye's plane cuts it.
struct WindowBox {
  PixelBox box;
  double z0 = 0, w0 = 0;
};
std::optional<WindowBox> project_sphere(const glm::dmat4& clip_from_model, int width, int height,
                                        const glm::dvec3& center, double radius);

// Blocks of the surface map that a stroke may touch: bounds of 128, 32 and 8 texels are projected to the window and tested
// against the window, the tool's segments and the depth grid. Conservative: never leaves out a texel that the edit would
// write. Each block gets the list of segments it may lie under. What it is made of must outlive it; const functions may run
// on several threads.
class BlockCuller {
 public:
  struct Tile {
    TileAddress address;
    std::vector<std::uint32_t> segments;  // it may lie under
  };

  BlockCuller(const mesh::SurfaceMap& map, const glm::dmat4& clip_from_model, int width, int height,
              const ToolPath& path, const DepthBias& bias, const DepthGrid& grid)
      : map_(map), clip_(clip_from_model), width_(width), height_(height), path_(path), bias_(bias), grid_(grid) {}

  std::vector<Tile> tiles() const;
  void add_blocks(const Tile& tile, Candidates& candidates) const;
  Candidates all() const;  // of all tiles

 private:
  struct Under {
    std::vector<std::uint32_t> segments;
    bool all_of_it = false;  // under the one segment that is left
  };
  bool passes(const mesh::SurfaceMap::Bounds& bounds, const std::vector<std::uint32_t>& parent, Under& under) const;
  std::optional<WindowBox> project(const mesh::SurfaceMap::Bounds& bounds) const;
  std::vector<std::uint32_t> segments_under(const WindowBox& box) const;
  bool lies_under(const WindowBox& window, std::uint32_t segment) const;
  bool keep_covering(const WindowBox& window, std::vector<std::uint32_t>& list) const;
  bool is_hidden(const WindowBox& window) const;

  const mesh::SurfaceMap& map_;
  const glm::dmat4 clip_;
  const int width_, height_;
  const ToolPath& path_;
  const DepthBias bias_;
  const DepthGrid grid_;
};

}  // namespace strata::render
