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
    bool bare = false;  // hatch and dots have neither tint nor border
  };
  // The placement of patterns on the image plane.
  struct Patterns {
    // The origin, in pixels from the bottom left: the model's center.
    glm::vec2 origin{0};
    float mm_per_pixel = 1;  // at the depth of the model's center
    float pixel_scale = 1;   // frame pixels per pixel of the camera's window
  };
  const gl::Texture& uv;
  const gl::Texture& light;
  const gl::Framebuffer& target;  // RGBA8 frame with the g-buffer's depth, lowest row first
  PixelRect rect;                 // origin top left, like all rectangles of frames
  PixelRect surface_rect;         // contains all pixels of `rect` that may show the surface
  Background background;
  glm::vec2 background_rows{0, 1};  // see FrameRequest::background_rows
  std::vector<Layer> layers;        // from bottom to top
  Patterns patterns{};
  bool shows_inside = false;  // a section may show the inside of a solid
};

// Colors a rectangle of a view's frame from its g-buffer (shaders/shade_pass.frag): first the
// background, then the surface, which the depth test selects. One draw shades all layers whose
// chunks fit into the texture units. Each further draw adds more layers. Sets all GL state that it
// needs, and resets scissor and blending.
class ShadePass {
 public:
  // Each chunk uses two texture units, and the pass uses three others. So the pass uses 15 of the
  // 16 units that all drivers have.
  static constexpr std::size_t kChunksPerDraw = 6;
  static constexpr std::size_t kLayersPerProgram = 4;

  // If `program_per_kinds` is true, each combination of the layers' palettes, types and chunks gets
  // its own program, with these as constants. Software renderers need this, because they run both
  // sides of each branch in all lanes. GPUs are faster with one program.
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
    std::vector<std::uint32_t> units;  // for each layer, the bits of the units with its chunks
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
  // Built at first use. The key: number of chunks, kinds of layers, shows_inside, first.
  std::map<std::tuple<std::size_t, std::string, bool, bool>, gl::Program> programs_;
  gl::VertexArray no_vertices_{"picture"};
  PaletteTextures palettes_;
  StreamBuffer uniforms_{"shade uniforms"}, layers_{"shade layers"};
};

}  // namespace strata::render
