#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "gl/readback.h"
#include "gl/timer_query.h"
#include "render/block_culler.h"
#include "render/layer_textures.h"
#include "render/stream_buffer.h"
#include "render/surface_map_textures.h"
#include "render/texel_width.h"

namespace strata::render {

// The slope-aware bias lets a texel pass that lies behind the depth buffer by this share of the model's diagonal (scan noise
// within a pixel), plus the depth that the surface's own slope makes within half a pixel, up to so many times the first.
constexpr double kDepthBiasOfDiagonal = 1.5e-4;
constexpr double kDepthBiasSlopeFactor = 1.5;
constexpr double kDepthBiasSlopeLimit = 64.0;

// The stroke's fixed bias where it has one, else the slope-aware one.
DepthBias depth_bias_of(const StrokeBatch& stroke, double model_diagonal);

// Dispatched and not read back yet. `blocks` are in the order of the rows.
struct DispatchedEdit {
  gl::Readback rows;
  std::vector<CandidateBlock> blocks;
  std::size_t bytes_up = 0;
  double executed_ms = 0;                // the calls of the dispatch: a software renderer executes in them
  std::vector<TileAddress> fresh_tiles;  // pages were made for these
};

// The texture editing and padding algorithms of the paper in one compute dispatch (shaders/edit_pass.comp).
class EditPass {
 public:
  static Result<EditPass> create(const std::filesystem::path& shader_dir, gl::ReadbackPool& readback);

  // Makes pages for the candidates' tiles (unless erasing) and dispatches. On a Problem nothing was changed. `depth` may
  // be null when the stroke goes through. `origin`: of the model.
  Result<DispatchedEdit> dispatch(const StrokeBatch& stroke, const glm::dvec3& origin, const ToolPath& path,
                                  const DepthBias& bias, Candidates candidates, const SurfaceMapTextures& map,
                                  const gl::Texture* depth, LayerTextures& layer, PageTables& tables);
  // The written texels of each tile, once `edit.rows` is ready; tiles without any are left out.
  static std::map<TileAddress, TileMask> written_masks(const DispatchedEdit& edit);
  double gpu_ms() const { return timer_.elapsed_ms(); }  // of the last dispatch

 private:
  Result<std::vector<TileAddress>> make_pages(const std::vector<CandidateBlock>& blocks, LayerTextures& layer);

  Result<void> send_shape(const StrokeBatch& stroke);

  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_, shape_programs_;
  gl::Texture shape_distances_;                // made when a stroke first needs it; holds those of…
  std::shared_ptr<const ShapeTexture> shape_;  // …the last one
  gl::TimerQuery timer_;
  StreamBuffer uniforms_{"edit uniforms"}, blocks_{"edit blocks"}, segments_{"edit segments"},
      lists_{"edit segment lists"};
};

}  // namespace strata::render
