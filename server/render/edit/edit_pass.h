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

// Dispatched and not read back yet.
struct DispatchedEdit {
  gl::Readback edited;                   // an EditedTile for each of…
  std::vector<TileAddress> tiles;        // …these
  std::vector<TileAddress> fresh_tiles;  // pages were made for these
};

// What a dispatch wrote.
struct EditedTiles {
  std::map<TileAddress, TileMask> masks;     // of tiles in which something was written
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the parts that were written in
};

// The texture editing and padding algorithms of the paper in one compute dispatch
// (shaders/edit_pass.comp) over what EditCuller listed.
class EditPass {
 public:
  static Result<EditPass> create(const std::filesystem::path& shader_dir,
                                 gl::ReadbackPool& readback);

  // Makes pages for the touched tiles (unless erasing) and dispatches what `culler` listed for the
  // stroke. On an Error nothing was changed. `depth` may be null when the stroke goes through.
  Result<DispatchedEdit> dispatch(const StrokeBatch& stroke, TouchedTiles touched,
                                  const EditCuller& culler, const SurfaceMapTextures& map,
                                  const gl::Texture* depth, LayerTextures& layer,
                                  PageTables& tables);
  static EditedTiles edited(const DispatchedEdit& edit);  // once `edit.edited` is ready
  double gpu_ms() const { return timer_.elapsed_ms(); }   // of the last dispatch

 private:
  Result<std::vector<TileAddress>> make_pages(const std::vector<TileAddress>& tiles,
                                              LayerTextures& layer);

  Result<void> send_shape(const StrokeBatch& stroke);

  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_, shape_programs_;
  gl::Texture shape_distances_;  // made when a stroke first needs it; holds those of…
  std::shared_ptr<const ShapeTexture> shape_;  // …the last one
  gl::TimerQuery timer_;
  StreamBuffer edited_{"edited tiles"};
};

}  // namespace strata::render
