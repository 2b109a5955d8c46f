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

// The marks of a view on the GPU, as seen by the camera of its g-buffer.
struct FeatureBuffer {
  StreamBuffer segments{"marks"};
  std::size_t count = 0;
};

// Draws lines and points over a view's picture (shaders/feature_*). `test_sight` determines once
// for a camera which of their points the surface hides; `draw` then draws them completely where
// their points are visible, into one rectangle after the other. Both set all state they need, and
// reset scissor and blending.
class FeaturePass {
 public:
  static Result<FeaturePass> create(const std::filesystem::path& shader_dir);
  // `depth`: of the whole picture. `cut_open`: it contains the marks of a solid's inside
  // (shared/section.h).
  Result<void> test_sight(std::span<const shader::FeatureSegment> segments,
                          const gl::Texture& depth, bool cut_open, FeatureBuffer& features) const;
  // `target`: RGBA8 picture of `width` × `height`, already shaded; row 0 lowest. `rect`: origin top
  // left.
  Result<void> draw(const FeatureBuffer& features, const gl::Framebuffer& target, int width,
                    int height, const PixelRect& rect);

 private:
  gl::Program program_, sight_, gaps_;
  gl::VertexArray no_vertices_{"marks"};
  StreamBuffer uniforms_{"marks' uniforms"};
};

}  // namespace strata::render
