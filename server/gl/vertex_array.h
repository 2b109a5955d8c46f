#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "gl/buffer.h"
#include "gl/object.h"

namespace strata::gl {

struct VertexAttribute {
  GLuint location;
  GLint components;
  GLenum type;
  bool normalized;
  GLuint offset;  // in bytes, from the start of the vertex
};

// The layout of one interleaved vertex buffer and one index buffer. Both buffers must outlive it.
class VertexArray {
 public:
  VertexArray() = default;
  VertexArray(const Buffer& vertices, int stride, std::span<const VertexAttribute> attributes,
              const Buffer& indices, std::string_view label);
  // Makes a layout without buffers, for passes that generate their vertices.
  explicit VertexArray(std::string_view label);

  GLuint id() const { return object_.id(); }
  explicit operator bool() const { return static_cast<bool>(object_); }
  void bind() const { glBindVertexArray(id()); }

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_VERTEX_ARRAY;
    static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
  };
  Object<Traits> object_;
};

}  // namespace strata::gl
