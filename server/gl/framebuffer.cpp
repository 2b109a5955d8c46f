#include "gl/framebuffer.h"

#include <cassert>
#include <vector>

namespace strata::gl {

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colors, const Texture* depth, std::string_view label) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  object_ = Object<Traits>(id);
  object_.label(label);
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
  assert(complete());
}

bool Framebuffer::complete() const {
  return object_ && glCheckNamedFramebufferStatus(id(), GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace strata::gl
