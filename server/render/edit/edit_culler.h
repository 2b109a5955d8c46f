#pragma once

#include <filesystem>
#include <vector>

#include "gl/program.h"
#include "gl/readback.h"
#include "gl/timer_query.h"
#include "render/edit/depth_bias.h"
#include "render/edit/tool_path.h"
#include "render/memory/layer_textures.h"
#include "render/memory/stream_buffer.h"
#include "render/memory/surface_map_textures.h"

namespace strata::render {

// The parts and tiles of a layer that a stroke may touch, as computed by the GPU.
struct TouchedTiles {
  std::uint32_t parts = 0;         // number of parts of the block tree
  std::vector<TileAddress> tiles;  // in the order of EditTiles::tiles
};

// The GPU counterpart of BlockCuller (shaders/edit_cull_pass.comp). It tests all nodes of the tree
// within microseconds. The list of parts stays on the GPU for EditPass. The tiles are read back,
// because the CPU allocates their pages.
class EditCuller {
 public:
  static Result<EditCuller> create(const std::filesystem::path& shader_dir,
                                   gl::ReadbackPool& readback);

  // Uploads the stroke and lists the parts. `origin` is the model's origin. `depth_grid` is null if
  // the stroke also paints hidden surfaces.
  Result<gl::Readback> dispatch(const StrokeBatch& stroke, const glm::dvec3& origin,
                                const ToolPath& path, const DepthBias& bias,
                                const SurfaceMapTextures& map, const gl::Buffer* depth_grid,
                                const LayerTextures& layer);
  // Returns the listed parts and tiles. Requires that `read` is ready.
  static TouchedTiles touched(const gl::Readback& read, int resolution);

  // Binds the buffers of the last dispatch for edit_pass.comp.
  void bind(const SurfaceMapTextures& map) const;
  std::size_t bytes_up() const { return bytes_up_; }     // of the last dispatch
  double gpu_ms() const { return timer_.elapsed_ms(); }  // of the last dispatch

 private:
  gl::ReadbackPool* readback_ = nullptr;
  gl::Program program_;
  gl::TimerQuery timer_;
  gl::Buffer tiles_;
  StreamBuffer uniforms_{"edit uniforms"}, segments_{"edit segments"};
  std::size_t bytes_up_ = 0;
};

}  // namespace strata::render
