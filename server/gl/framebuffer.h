#pragma once

#include <initializer_list>
#include <string_view>

#include "core/error.h"
#include "gl/object.h"
#include "gl/texture.h"

namespace strata::gl {

// A framebuffer that renders into textures, which must outlive it. Empty if default-constructed or
// moved from.
class Framebuffer {
 public:
  Framebuffer() = default;
  // `depth` may be null. Returns the Error `unavailable` if the driver does not support this
  // combination of textures.
  static Result<Framebuffer> create(std::initializer_list<const Texture*> colors,
                                    const Texture* depth, std::string_view label);

  GLuint id() const { return object_.id(); }
  explicit operator bool() const { return static_cast<bool>(object_); }

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_FRAMEBUFFER;
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
  };
  Object<Traits> object_;
};

}  // namespace strata::gl
