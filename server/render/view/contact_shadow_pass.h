#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "mesh/analysis/contact_shadow.h"
#include "render/memory/stream_buffer.h"
#include "render/renderer.h"

namespace strata::render {

// Returns a box around the part of the floor that the shadow covers.
FrameRequest::Box box_of(const mesh::ContactShadow& shadow);

// Darkens the background of a frame with the model's shadow on the floor. Pixels that show the
// surface do not change. Sets all state it needs, and resets scissor, depth test and
// blending.
class ContactShadowPass {
 public:
  static Result<ContactShadowPass> create(const std::filesystem::path& shader_dir);

  // `target` contains the frame and the depth of its surface, `width` × `height` pixels, for
  // `camera`. `rect` is the part to draw, with its origin at the top left. Draws nothing if the eye
  // is below the floor.
  Result<void> draw(const std::shared_ptr<const mesh::ContactShadow>& shadow, const Camera& camera,
                    const glm::dvec3& origin, const gl::Framebuffer& target, int width, int height,
                    const PixelRect& rect);

 private:
  Result<const gl::Texture*> texture(const std::shared_ptr<const mesh::ContactShadow>& shadow);

  struct Entry {
    std::weak_ptr<const mesh::ContactShadow> shadow;
    gl::Texture cover;
  };
  gl::Program program_;
  gl::VertexArray no_vertices_{"contact shadow"};
  StreamBuffer uniforms_{"contact shadow uniforms"};
  std::vector<Entry> entries_;  // 16 KiB each, kept while a view has the shadow
};

}  // namespace strata::render
