#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "domain/scene/stroke.h"
#include "render/edit/block_culler.h"
#include "render/edit/facing_limit.h"
#include "render/view/depth_copy.h"

namespace strata::render {

// What the test of a block needs of its stroke.
struct BlockTest {
  glm::mat4 clip_from_model{1};
  const ToolPath* path = nullptr;
  const DepthCopy* depth = nullptr;  // null: the stroke goes through
  int width = 0, height = 0;         // of the window, which is the depth's
  ToolShape shape = ToolShape::disc;
  const ShapeTexture* texture = nullptr;  // of ToolShape::texture
  std::optional<FacingLimit> facing;      // with a depth only
  DepthBias bias;
  std::span<const glm::vec4> section;  // planes in model space that cut the model open
};

// The texels of an 8 × 8 block that the stroke writes, bit (y * 8 + x): the tests of
// shaders/edit_pass.comp in C++. `positions` are the block's 64, `segments` those of the path that
// it may lie under; with `in_tool` the tool is not asked.
using TestBlock = std::uint64_t (*)(const BlockTest& test, const std::uint64_t* positions,
                                    const mesh::SurfaceMap::PackedBox& box,
                                    std::span<const std::uint32_t> segments, bool in_tool);

// Loops that the compiler turns into vectors, compiled for several instruction sets. They differ by
// rounding.
enum class VectorUnit { plain, avx2, avx512 };
VectorUnit best_vector_unit();        // of this machine
TestBlock test_block_on(VectorUnit);  // which the machine must have

}  // namespace strata::render
