#include "render/edit_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "render/facing_limit.h"
#include "shared/edit.h"
#include "shared/pages.h"

namespace strata::render {
namespace {

shader::EditUniforms make_uniforms(const StrokeBatch& stroke, const glm::dvec3& origin, const DepthBias& bias) {
  static_assert(kMaxSectionPlanes == shader::kSectionPlanes);
  shader::EditUniforms uniforms{};
  uniforms.clip_from_model = clip_from_model(stroke.camera, origin);
  uniforms.window = glm::vec4(stroke.camera.width, stroke.camera.height, 0, 0);
  uniforms.bias = glm::vec4(bias.fixed.value_or(0), bias.scale, bias.slope_factor, bias.slope_limit);
  uniforms.value = stroke.value_bits;
  uniforms.flags = (stroke.erase ? shader::kEditErase : 0u) | (stroke.through ? shader::kEditThrough : 0u) |
                   (stroke.shape == ToolShape::square ? shader::kEditSquare : 0u) |
                   (bias.fixed ? shader::kEditFixedBias : 0u) | (stroke.max_angle_deg ? shader::kEditFacing : 0u);
  uniforms.section_count = static_cast<std::uint32_t>(stroke.camera.section.size());
  std::ranges::copy(section_in_model(stroke.camera, origin), uniforms.section);
  if (stroke.max_angle_deg) {
    const FacingLimit limit = make_facing_limit(stroke.camera, *stroke.max_angle_deg);
    uniforms.facing[0] = glm::vec4(limit.x_row, limit.least_squared_cosine);
    uniforms.facing[1] = glm::vec4(limit.y_row, 0);
    uniforms.facing[2] = glm::vec4(limit.w_row, 0);
    uniforms.facing[3] = glm::vec4(limit.far_row, 0);
  }
  return uniforms;
}

}  // namespace

// Window depth changes with the distance t along the axis by |P22 P33 - P32 P23| / (2 w²) per unit; a view matrix that
// scales makes its units of model units.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal) {
  DepthBias bias;
  bias.fixed = stroke.fixed_depth_bias;
  const auto& p = stroke.camera.projection;
  const double depth_per_unit = 0.5 * std::abs(p[2][2] * p[3][3] - p[3][2] * p[2][3]);
  bias.scale = kDepthBiasOfDiagonal * model_diagonal * view_scale(stroke.camera) * depth_per_unit;
  bias.slope_factor = kDepthBiasSlopeFactor;
  bias.slope_limit = kDepthBiasSlopeLimit;
  return bias;
}

Result<EditPass> EditPass::create(const std::filesystem::path& shader_dir, gl::ReadbackPool& readback) {
  EditPass pass;
  pass.readback_ = &readback;
  const auto format = [](int texel_bytes) { return "TEXEL_FORMAT r" + std::to_string(8 * texel_bytes) + "ui"; };
  auto programs = ProgramPerWidth::load(shader_dir, "edit_pass.comp", format);
  if (!programs) return tl::unexpected(programs.error());
  pass.programs_ = std::move(*programs);
  // Of their own, so that strokes of discs and squares do not carry what only a shape needs.
  auto shape_programs = ProgramPerWidth::load(shader_dir, "edit_pass.comp", format, {"TOOL_TEXTURE"});
  if (!shape_programs) return tl::unexpected(shape_programs.error());
  pass.shape_programs_ = std::move(*shape_programs);
  pass.timer_ = gl::TimerQuery::create("edit");
  return pass;
}

Result<void> EditPass::send_shape(const StrokeBatch& stroke) {
  if (stroke.shape != ToolShape::texture || stroke.texture == shape_) return {};
  static_assert(shader::kShapeCells == kShapeSide);
  if (!shape_distances_) {
    auto made = gl::Texture::create_2d(GL_R8UI, kShapeSide, kShapeSide, "tool shape");
    if (!made) return tl::unexpected(made.error());
    shape_distances_ = std::move(*made);
  }
  glTextureSubImage2D(shape_distances_.id(), 0, 0, 0, kShapeSide, kShapeSide, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                      stroke.texture->distances().data());
  shape_ = stroke.texture;
  return {};
}

Result<std::vector<TileAddress>> EditPass::make_pages(const std::vector<CandidateBlock>& blocks, LayerTextures& layer) {
  std::vector<TileAddress> fresh;
  for (const CandidateBlock& block : blocks) {
    if (layer.page(block.tile) != shader::kNoPage) continue;
    if (auto page = layer.ensure_page(block.tile); !page) {
      for (const TileAddress tile : fresh) layer.free_page(tile);
      return tl::unexpected(page.error());
    }
    fresh.push_back(block.tile);
  }
  return fresh;
}

Result<DispatchedEdit> EditPass::dispatch(const StrokeBatch& stroke, const glm::dvec3& origin, const ToolPath& path,
                                          const DepthBias& bias, Candidates candidates, const SurfaceMapTextures& map,
                                          const gl::Texture* depth, LayerTextures& layer, PageTables& tables) {
  DispatchedEdit edit;
  edit.blocks = std::move(candidates.blocks);
  if (edit.blocks.empty()) return edit;
  if (!stroke.erase) {
    auto fresh = make_pages(edit.blocks, layer);
    if (!fresh) return tl::unexpected(fresh.error());
    edit.fresh_tiles = std::move(*fresh);
  }
  const auto give_up = [&](const Problem& problem) {
    for (const TileAddress tile : edit.fresh_tiles) layer.free_page(tile);
    return tl::unexpected(problem);
  };
  if (auto flushed = tables.flush(); !flushed) return give_up(flushed.error());
  if (auto sent = send_shape(stroke); !sent) return give_up(sent.error());

  // One dispatch a chunk: only one pair of images is bound at a time. Blocks without a page (erasing) go with the first.
  const auto chunk_of = [&](const CandidateBlock& block) {
    const PageId page = layer.page(block.tile);
    return page == shader::kNoPage ? 0u : page >> shader::kPageChunkShift;
  };
  if (!std::ranges::is_sorted(edit.blocks, {}, chunk_of)) std::ranges::stable_sort(edit.blocks, {}, chunk_of);
  std::vector<shader::EditBlock> blocks;
  blocks.reserve(edit.blocks.size());
  for (const CandidateBlock& block : edit.blocks) {
    blocks.push_back(
        {block.slot, layer.page(block.tile), block.segments, block.block_in_tile | block.segment_count << 8});
  }
  const auto uniforms = make_uniforms(stroke, origin, bias);
  auto rows = readback_->begin(blocks.size() * shader::kEditRowsPerBlock * sizeof(std::uint32_t));
  if (!rows) return give_up(rows.error());
  for (auto sent :
       {uniforms_.replace(std::span(&uniforms, 1)), blocks_.replace(std::span<const shader::EditBlock>(blocks)),
        segments_.replace(std::span<const shader::EditSegment>(path.segments)),
        lists_.replace(std::span<const std::uint32_t>(candidates.segment_lists.numbers()))}) {
    if (!sent) return give_up(sent.error());
  }

  edit.bytes_up = sizeof uniforms + blocks.size() * sizeof(shader::EditBlock) +
                  path.segments.size() * sizeof(shader::EditSegment) +
                  candidates.segment_lists.numbers().size() * sizeof(std::uint32_t);

  const bool has_shape = stroke.shape == ToolShape::texture;
  const gl::Program& program = (has_shape ? shape_programs_ : programs_).of(layer.pool().texel_bytes());
  program.use();
  uniforms_.bind_uniform(0);
  blocks_.bind_storage(0);
  segments_.bind_storage(1);
  lists_.bind_storage(2);
  rows->buffer().bind_storage(3);
  map.boxes().bind_storage(4);
  map.positions().bind(0);
  if (depth) depth->bind(1);
  if (has_shape) shape_distances_.bind(2);
  const auto begin = std::chrono::steady_clock::now();
  timer_.begin();
  for (std::size_t first = 0; first < edit.blocks.size();) {
    const auto chunk = chunk_of(edit.blocks[first]);
    std::size_t last = first;
    while (last < edit.blocks.size() && chunk_of(edit.blocks[last]) == chunk) ++last;
    if (layer.pool().has_chunk(chunk)) {
      layer.pool().values(chunk).bind_image(0, GL_WRITE_ONLY);
      layer.pool().valid(chunk).bind_image(1, GL_WRITE_ONLY);
    }
    const auto count = static_cast<GLuint>(last - first);
    program.set(0, static_cast<GLuint>(first));
    program.set(1, count);
    const GLuint groups = (count + shader::kEditBlocksPerGroup - 1) / shader::kEditBlocksPerGroup;
    const GLuint columns = std::min(groups, shader::kEditGroupsPerRow);
    glDispatchCompute(columns, (groups + columns - 1) / columns, 1);
    first = last;
  }
  timer_.end();
  edit.executed_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  rows->submit();
  edit.rows = std::move(*rows);
  return edit;
}

std::map<TileAddress, TileMask> EditPass::written_masks(const DispatchedEdit& edit) {
  std::map<TileAddress, TileMask> masks;
  if (!edit.rows) return masks;
  const auto data = edit.rows.data();
  TileMask* mask = nullptr;
  TileAddress mask_tile;
  for (std::size_t i = 0; i < edit.blocks.size(); ++i) {
    const CandidateBlock& block = edit.blocks[i];
    std::array<std::uint32_t, shader::kEditRowsPerBlock> rows;
    std::memcpy(rows.data(), data.data() + i * sizeof(rows), sizeof(rows));
    if (std::all_of(rows.begin(), rows.end(), [](std::uint32_t row) { return row == 0; })) continue;
    if (!mask || mask_tile != block.tile) {
      mask = &masks[block.tile];
      mask_tile = block.tile;
    }
    const std::uint32_t x = (block.block_in_tile & 15) * 8, y = (block.block_in_tile >> 4) * 8;
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
      const std::uint32_t texel = (y + row) * kTileSize + x;
      mask->words[texel / 64] |= std::uint64_t{rows[row]} << (texel % 64);
    }
  }
  return masks;
}

}  // namespace strata::render
