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

// A dispatch before its read-back.
struct DispatchedEdit {
  gl::Readback edited;                   // an EditedTile for each of…
  std::vector<TileAddress> tiles;        // …these
  std::vector<TileAddress> fresh_tiles;  // pages were made for these
};

// The result of a dispatch.
struct EditedTiles {
  std::map<TileAddress, TileMask> masks;     // of tiles with written texels
  glm::vec3 written_min{0}, written_max{0};  // model-space box of the written parts
};

// The texture editing and padding algorithms of the paper in one compute dispatch
// (shaders/edit_pass.comp) over the parts listed by EditCuller.
class EditPass {
 public:
  static Result<EditPass> create(const std::filesystem::path& shader_dir,
                                 gl::ReadbackPool& readback);

  // Allocates pages for the touched tiles (unless erasing) and dispatches the parts that `culler`
  // listed for the stroke. After an Error nothing is changed. `depth` may be null if the stroke
  // paints through.
  Result<DispatchedEdit> dispatch(const StrokeBatch& stroke, TouchedTiles touched,
                                  const EditCuller& culler, const SurfaceMapTextures& map,
                                  const gl::Texture* depth, LayerTextures& layer,
                                  PageTables& tables);
  static EditedTiles edited(const DispatchedEdit& edit);  // when `edit.edited` is ready
  double gpu_ms() const { return timer_.elapsed_ms(); }   // of the last dispatch

 private:
  Result<std::vector<TileAddress>> make_pages(const std::vector<TileAddress>& tiles,
                                              LayerTextures& layer);

  Result<void> send_shape(const StrokeBatch& stroke);

  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_, shape_programs_;
  gl::Texture shape_distances_;  // created for the first stroke that needs it; those of…
  std::shared_ptr<const ShapeTexture> shape_;  // …the last shape
  gl::TimerQuery timer_;
  StreamBuffer edited_{"edited tiles"};
};

}  // namespace strata::render
