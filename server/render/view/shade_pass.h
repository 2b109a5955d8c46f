#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/memory/layer_textures.h"
#include "render/memory/palette_textures.h"
#include "render/memory/stream_buffer.h"
#include "render/renderer.h"

namespace strata::render {

struct ShadeInput {
  struct Layer {
    const LayerTextures* textures;
    std::shared_ptr<const Palette> palette;
    float opacity;
    LayerBlend blend = LayerBlend::normal;
    bool bare = false;  // patterns without tint and border
  };
  // Placement of patterns on the picture's plane.
  struct Patterns {
    // their origin in pixels from the bottom left: the model's center
    glm::vec2 origin{0};
    float mm_per_pixel = 1;  // at the distance of the model's center
    float pixel_scale = 1;   // pixels of the picture for one of the camera's window
  };
  const gl::Texture& uv;
  const gl::Texture& light;
  const gl::Framebuffer& target;  // RGBA8 picture and the g-buffer's depth; row 0 lowest
  PixelRect rect;                 // origin top left, as all rectangles of pictures
  PixelRect surface_rect;         // contains all pixels of `rect` that may show surface
  Background background;
  glm::vec2 background_rows{0, 1};  // FrameRequest::background_rows
  std::vector<Layer> layers;        // bottom to top
  Patterns patterns{};
  bool shows_inside = false;  // of a solid that a section cuts open
};

// Colors a rectangle of a view's picture from its g-buffer (shaders/shade_pass.frag): the
// background, then the surface, which the depth test finds. Layers share a draw as long as their
// chunks fit into the texture units; otherwise there are several draws, each over the one before.
// Sets all state it needs, and resets scissor and blending.
class ShadePass {
 public:
  // pairs; with 3 more units, 15 of the 16 that every driver has
  static constexpr std::size_t kChunksPerDraw = 6;
  static constexpr std::size_t kLayersPerProgram = 4;

  // `program_per_kinds`: one program for each combination of the layers' palettes, types and
  // chunks, with these as constants. Software renderers run both sides of every branch in every
  // lane; GPUs are faster with one program.
  static Result<ShadePass> create(const std::filesystem::path& shader_dir, bool program_per_kinds);
  Result<void> shade(const ShadeInput& input, const PageTables& tables);

 private:
  struct Chunk {
    const PagePool* pool;
    std::uint32_t index;
    bool operator==(const Chunk&) const = default;
  };
  struct Batch {
    std::vector<shader::ShadeLayer> layers;
    std::vector<std::uint32_t> units;  // for each layer: bits of the units with its chunks
    std::vector<Chunk> chunks;
  };
  bool can_take(const Batch& batch, const Chunk& chunk, bool listed) const;
  Result<const gl::Program*> program(const Batch& batch, bool shows_inside, bool first);
  std::vector<Batch> plan(std::span<const ShadeInput::Layer> layers);
  Result<void> draw_background(const ShadeInput& input);
  Result<void> draw_surface(const ShadeInput& input, const Batch& batch, bool first,
                            const PageTables& tables);
  Result<void> draw(const ShadeInput& input, const gl::Program& program, const PixelRect& rect,
                    const shader::ShadeUniforms& uniforms);
  shader::ShadeLayer describe(const ShadeInput::Layer& layer);

  std::filesystem::path shader_dir_;
  bool program_per_kinds_ = false;
  gl::Program background_;
  // by chunks, kinds, whether they show insides and whether they draw first, built on first use
  std::map<std::tuple<std::size_t, std::string, bool, bool>, gl::Program> programs_;
  gl::VertexArray no_vertices_{"picture"};
  PaletteTextures palettes_;
  StreamBuffer uniforms_{"shade uniforms"}, layers_{"shade layers"};
};

}  // namespace strata::render
