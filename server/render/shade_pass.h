#pragma once

#include <array>
#include <filesystem>
#include <span>
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
  Rgba background_top, background_bottom;
  std::vector<Layer> layers;   // bottom to top
};

// Colours a rectangle of a view's picture from its g-buffer (shaders/shade_pass.comp). Layers share a dispatch as long as the
// chunks that hold them fit into the texture units; else there are several, each on top of the last.
class ShadePass {
 public:
  static constexpr std::size_t kChunksPerDispatch = 6;  // pairs; with 3 more, 15 of the 16 units every driver has

  static Result<ShadePass> create(const std::filesystem::path& shader_dir);
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
  };
  std::vector<Batch> plan(const ShadeInput& input);
  Result<void> dispatch(const ShadeInput& input, const Batch& batch, bool first, const PageTables& tables);
  shader::ShadeLayer describe(const ShadeInput::Layer& layer);

  std::array<gl::Program, kChunksPerDispatch + 1> programs_;  // by the number of chunks
  PaletteTextures palettes_;
  StreamBuffer uniforms_{"shade uniforms"}, layers_{"shade layers"};
  int dispatches_ = 0;
};

}  // namespace strata::render
