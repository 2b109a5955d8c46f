#pragma once

#include <filesystem>
#include <span>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/renderer.h"
#include "render/stream_buffer.h"
#include "shared/marks.h"

namespace strata::render {

// Draws lines and points into a rectangle of a view's picture that is shaded already (shaders/mark_pass.*), where nothing of the surface
// is before them. Sets all state it needs, and leaves neither scissor nor blending behind.
class MarkPass {
 public:
  static Result<MarkPass> create(const std::filesystem::path& shader_dir);
  // `target`: RGBA8 picture and the g-buffer's depth, of `width` × `height`; row 0 lowest. `rect`: origin top left.
  Result<void> draw(std::span<const shader::MarkSegment> segments, const gl::Framebuffer& target, int width, int height,
                    const PixelRect& rect);

 private:
  gl::Program program_;
  gl::VertexArray no_vertices_{"marks"};
  StreamBuffer uniforms_{"marks' uniforms"}, segments_{"marks"};
};

}  // namespace strata::render
