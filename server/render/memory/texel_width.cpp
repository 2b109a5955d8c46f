#include "render/memory/texel_width.h"

namespace strata::render {

GLenum texel_format(int texel_bytes) {
  return texel_bytes == 1 ? GL_R8UI : texel_bytes == 2 ? GL_R16UI : GL_R32UI;
}

GLenum texel_component(int texel_bytes) {
  return texel_bytes == 1   ? GL_UNSIGNED_BYTE
         : texel_bytes == 2 ? GL_UNSIGNED_SHORT
                            : GL_UNSIGNED_INT;
}

}  // namespace strata::render
