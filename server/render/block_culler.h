#pragma once

#include <optional>
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
  bool is_fixed = false;
  double fixed = 0, scale = 0, slope_factor = 0, slope_limit = 0;
};

struct CandidateBlock {
  std::uint32_t slot;
  TileAddress tile;
  std::uint32_t block_in_tile;  // x | y << 4
  std::uint32_t segments;       // first in `segment_lists`
  std::uint32_t segment_count;
};
struct Candidates {
  std::vector<CandidateBlock> blocks;  // all blocks of a tile together
  std::vector<std::uint32_t> segment_lists;

  std::size_t count_tiles() const;
};

// Blocks of the surface map that a stroke may touch: bounds of 128, 32 and 8 texels are projected to the window and tested
// against the window, the tool's segments and the depth grid. Conservative: never leaves out a texel that the edit would
// write. Each block gets the list of segments it may lie under.
Candidates cull_blocks(const mesh::SurfaceMap& map, const glm::dmat4& clip_from_model, int width, int height,
                       const ToolPath& path, const DepthBias& bias, const DepthGrid& grid);

// Exact window box of a sphere (`z0`: nearest window depth, `w0`: smallest w); empty when it is behind the eye; the whole
// window when the eye's plane cuts it.
struct WindowBox {
  PixelBox box;
  double z0 = 0, w0 = 0;
};
std::optional<WindowBox> project_sphere(const glm::dmat4& clip_from_model, int width, int height,
                                        const glm::dvec3& center, double radius);

}  // namespace strata::render
