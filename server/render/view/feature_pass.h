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

// The marks of a view on the GPU, projected by the camera of its g-buffer.
struct FeatureBuffer {
  StreamBuffer segments{"marks"};
  std::size_t count = 0;
};

// Draws lines and points over a view's frame (shaders/feature_*). `test_sight` determines the
// points that the surface hides, once for each camera. `draw` then draws the symbols of all visible
// points completely, for one rectangle per call. Both set all GL state that they need, and reset
// scissor and blending.
class FeaturePass {
 public:
  static Result<FeaturePass> create(const std::filesystem::path& shader_dir);
  // `depth` is the depth of the whole frame. If `cut_open` is true, it marks the visible inside of
  // solids (shared/section.h).
  Result<void> test_sight(std::span<const shader::FeatureSegment> segments,
                          const gl::Texture& depth, bool cut_open, FeatureBuffer& features) const;
  // `target` is a shaded RGBA8 frame of `width` × `height` pixels, lowest row first. `rect` has its
  // origin at the top left.
  Result<void> draw(const FeatureBuffer& features, const gl::Framebuffer& target, int width,
                    int height, const PixelRect& rect);

 private:
  gl::Program program_, sight_, gaps_;
  gl::VertexArray no_vertices_{"marks"};
  StreamBuffer uniforms_{"marks' uniforms"};
};

}  // namespace strata::render
