#include "gl/framebuffer.h"

#include <string>
#include <vector>

namespace strata::gl {

Result<Framebuffer> Framebuffer::create(std::initializer_list<const Texture*> colors,
                                        const Texture* depth, std::string_view label) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  Framebuffer framebuffer;
  framebuffer.object_ = Object<Traits>(id);
  framebuffer.object_.label(label);
  std::vector<GLenum> targets;
  for (const Texture* color : colors) {
    const auto target = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + targets.size());
    glNamedFramebufferTexture(id, target, color->id(), 0);
    targets.push_back(target);
  }
  if (depth) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth->id(), 0);
  if (targets.empty()) {
    glNamedFramebufferDrawBuffer(id, GL_NONE);
  } else {
    glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(targets.size()), targets.data());
  }
  const GLenum status = glCheckNamedFramebufferStatus(id, GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return framebuffer;
  return fail(ErrorCode::unavailable, "Framebuffer not supported",
              "The driver does not support the framebuffer '" + std::string(label) + "' (status " +
                  std::to_string(status) + "). Update the graphics driver.");
}

}  // namespace strata::gl
