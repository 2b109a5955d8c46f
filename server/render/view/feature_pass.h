#pragma once

#include <filesystem>
#include <span>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "render/memory/stream_buffer.h"
#include "render/renderer.h"
#include "shared/features.h"

namespace strata::render {

// The marks of a view as the camera of its g-buffer sees them, on the GPU.
struct FeatureBuffer {
  StreamBuffer segments{"marks"};
  std::size_t count = 0;
};

// Draws lines and points over a view's picture (shaders/mark_*). `look` finds out once for a camera
// which of their places the surface hides; `draw` then draws them whole where their place is
// visible, into one rectangle after the other. Both set all state they need, and leave neither
// scissor nor blending behind.
class FeaturePass {
 public:
  static Result<FeaturePass> create(const std::filesystem::path& shader_dir);
  // `depth`: of the whole picture. `cut_open`: it carries the marks of a solid's inside
  // (shared/section.h).
  Result<void> test_sight(std::span<const shader::FeatureSegment> segments,
                          const gl::Texture& depth, bool cut_open, FeatureBuffer& features) const;
  // `target`: RGBA8 picture of `width` × `height`, shaded already; row 0 lowest. `rect`: origin top
  // left.
  Result<void> draw(const FeatureBuffer& features, const gl::Framebuffer& target, int width,
                    int height, const PixelRect& rect);

 private:
  gl::Program program_, sight_, gaps_;
  gl::VertexArray no_vertices_{"marks"};
  StreamBuffer uniforms_{"marks' uniforms"};
};

}  // namespace strata::render
