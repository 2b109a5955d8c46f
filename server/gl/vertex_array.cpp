#include "gl/vertex_array.h"

namespace strata::gl {

VertexArray::VertexArray(std::string_view label) {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  object_ = Object<Traits>(id);
  object_.label(label);
}

VertexArray::VertexArray(const Buffer& vertices, int stride,
                         std::span<const VertexAttribute> attributes, const Buffer& indices,
                         std::string_view label)
    : VertexArray(label) {
  glVertexArrayVertexBuffer(id(), 0, vertices.id(), 0, stride);
  glVertexArrayElementBuffer(id(), indices.id());
  for (const VertexAttribute& attribute : attributes) {
    glVertexArrayAttribFormat(id(), attribute.location, attribute.components, attribute.type,
                              attribute.normalized ? GL_TRUE : GL_FALSE, attribute.offset);
    glVertexArrayAttribBinding(id(), attribute.location, 0);
    glEnableVertexArrayAttrib(id(), attribute.location);
  }
}

}  // namespace strata::gl
