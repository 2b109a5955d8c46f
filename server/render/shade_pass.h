#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "gl/program.h"
#include "render/layer_textures.h"
#include "render/palette_textures.h"
#include "render/renderer.h"
#include "render/stream_buffer.h"

namespace strata::render {

struct ShadeInput {
  struct Layer {
    const LayerTextures* textures;
    std::shared_ptr<const Palette> palette;
    float opacity;
  };
  const gl::Texture& uv;
  const gl::Texture& light;
  const gl::Texture& picture;  // RGBA8, row 0 on top
  PixelRect rect;
  PixelRect surface_rect;      // holds all pixels of `rect` that may show surface
  Rgba background_top, background_bottom;
  std::vector<Layer> layers;   // bottom to top
};

// Colours a rectangle of a view's picture from its g-buffer (shaders/shade_pass.comp). Layers share a dispatch as long as the
// chunks that hold them fit into the texture units; else there are several, each on top of the last.
class ShadePass {
 public:
  static constexpr std::size_t kChunksPerDispatch = 6;  // pairs; with 3 more, 15 of the 16 units every driver has

  // `one_layer_per_dispatch`: of one kind of palette and one chunk. CPUs run every side of a branch in every lane, so that
  // is faster there; GPUs are better off with fewer dispatches.
  static Result<ShadePass> create(const std::filesystem::path& shader_dir, bool one_layer_per_dispatch);
  Result<void> shade(const ShadeInput& input, const PageTables& tables);
  int dispatches() const { return dispatches_; }  // of the last call

 private:
  struct Chunk {
    const PagePool* pool;
    int index;
    bool operator==(const Chunk&) const = default;
  };
  struct Batch {
    std::vector<shader::ShadeLayer> layers;
    std::vector<Chunk> chunks;
    std::uint32_t modes = 0;  // bits: 1 linear, 2 step, 4 categorical
  };
  bool can_take(const Batch& batch, const Chunk& chunk) const;
  Result<const gl::Program*> program(std::size_t chunks, std::uint32_t modes);
  std::vector<Batch> plan(const ShadeInput& input);
  Result<void> dispatch(const ShadeInput& input, const Batch& batch, const PixelRect& rect, bool first, const PageTables& tables);
  shader::ShadeLayer describe(const ShadeInput::Layer& layer);

  std::filesystem::path shader_dir_;
  bool one_layer_per_dispatch_ = false;
  std::map<std::pair<std::size_t, std::uint32_t>, gl::Program> programs_;  // by chunks and modes, built when first used
  PaletteTextures palettes_;
  StreamBuffer uniforms_{"shade uniforms"}, layers_{"shade layers"};
  int dispatches_ = 0;
};

}  // namespace strata::render
