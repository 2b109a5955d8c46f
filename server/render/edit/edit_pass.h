#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "gl/readback.h"
#include "gl/timer_query.h"
#include "render/edit/edit_culler.h"
#include "render/memory/layer_textures.h"
#include "render/memory/stream_buffer.h"
#include "render/memory/surface_map_textures.h"
#include "render/memory/texel_width.h"

namespace strata::render {

// A dispatch whose read-back is not complete.
struct DispatchedEdit {
  gl::Readback edited;  // an EditedTile for each entry of `tiles`
  std::vector<TileAddress> tiles;
  std::vector<TileAddress> fresh_tiles;  // the tiles that got new pages
};

// The result of a dispatch.
struct EditedTiles {
  std::map<TileAddress, TileMask> masks;     // only tiles with written texels
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the written parts
};

// Runs the texture editing and padding algorithms (TEA and TPA) in one compute dispatch
// (shaders/edit_pass.comp) over the parts that EditCuller listed.
class EditPass {
 public:
  static Result<EditPass> create(const std::filesystem::path& shader_dir,
                                 gl::ReadbackPool& readback);

  // Allocates pages for the touched tiles, unless the stroke erases. Then dispatches the parts that
  // `culler` listed for the stroke. If it fails, the layer is unchanged. `depth` may be null if the
  // stroke also paints hidden surfaces.
  Result<DispatchedEdit> dispatch(const StrokeBatch& stroke, TouchedTiles touched,
                                  const EditCuller& culler, const SurfaceMapTextures& map,
                                  const gl::Texture* depth, LayerTextures& layer,
                                  PageTables& tables);
  static EditedTiles edited(const DispatchedEdit& edit);  // requires that `edit.edited` is ready
  double gpu_ms() const { return timer_.elapsed_ms(); }   // time of the last dispatch

 private:
  Result<std::vector<TileAddress>> make_pages(const std::vector<TileAddress>& tiles,
                                              LayerTextures& layer);

  Result<void> send_shape(const StrokeBatch& stroke);

  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_, shape_programs_;
  gl::Texture shape_distances_;  // the distances of `shape_`, created at the first use
  std::shared_ptr<const ShapeTexture> shape_;  // the last used shape
  gl::TimerQuery timer_;
  StreamBuffer edited_{"edited tiles"};
};

}  // namespace strata::render
