#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "domain/scene/stroke.h"
#include "render/edit/block_culler.h"
#include "render/edit/facing_limit.h"
#include "render/view/depth_copy.h"

namespace strata::render {

// The data of a stroke that the test of a block needs.
struct BlockTest {
  glm::mat4 clip_from_model{1};
  const ToolPath* path = nullptr;
  const DepthCopy* depth = nullptr;  // null: the stroke also paints hidden surfaces
  int width = 0, height = 0;         // size of the window and of the depth copy
  ToolShape shape = ToolShape::disc;
  const ShapeTexture* texture = nullptr;  // for ToolShape::texture
  std::optional<FacingLimit> facing;      // used only with `depth`
  DepthBias bias;
  std::span<const glm::vec4> section;  // planes in model space that cut the model open
  PartSet hidden_parts{};              // tested by run_edit_kernel
};

// Returns the texels of an 8 × 8 block that the stroke writes, as bits y * 8 + x. Performs the
// tests of shaders/edit_pass.comp in C++. `positions` contains the block's 64 texel positions, and
// `segments` the numbers of the segments that may cover it. If `in_tool` is true, all texels are
// inside the tool, and that test is skipped.
using TestBlock = std::uint64_t (*)(const BlockTest& test, const std::uint64_t* positions,
                                    const mesh::SurfaceMap::PackedBox& box,
                                    std::span<const std::uint32_t> segments, bool in_tool);

// The instruction set that a test is compiled for. Results of different sets differ by rounding.
enum class VectorUnit { plain, avx2, avx512 };
VectorUnit best_vector_unit();        // returns the best set of this machine
TestBlock test_block_on(VectorUnit);  // the machine must support it

}  // namespace strata::render
