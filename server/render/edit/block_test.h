#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "domain/scene/stroke.h"
#include "render/edit/block_culler.h"
#include "render/edit/facing_limit.h"
#include "render/view/depth_copy.h"

namespace strata::render {

// The data of a stroke for the test of a block.
struct BlockTest {
  glm::mat4 clip_from_model{1};
  const ToolPath* path = nullptr;
  const DepthCopy* depth = nullptr;  // null: the stroke paints through
  int width = 0, height = 0;         // of the window, and of the depth
  ToolShape shape = ToolShape::disc;
  const ShapeTexture* texture = nullptr;  // for ToolShape::texture
  std::optional<FacingLimit> facing;      // with a depth only
  DepthBias bias;
  std::span<const glm::vec4> section;  // planes in model space that cut the model open
};

// Returns the texels of an 8 × 8 block that the stroke writes, bit (y * 8 + x): the tests of
// shaders/edit_pass.comp in C++. `positions` are the block's 64, `segments` those of the path that
// may cover it; with `in_tool` the tool is not tested.
using TestBlock = std::uint64_t (*)(const BlockTest& test, const std::uint64_t* positions,
                                    const mesh::SurfaceMap::PackedBox& box,
                                    std::span<const std::uint32_t> segments, bool in_tool);

// The test's loops are compiled for several instruction sets. The results differ by rounding.
enum class VectorUnit { plain, avx2, avx512 };
VectorUnit best_vector_unit();        // the best one of this machine
TestBlock test_block_on(VectorUnit);  // the machine must support it

}  // namespace strata::render
