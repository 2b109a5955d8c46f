#include "gl/buffer.h"

#include <cassert>

#include "gl/debug_messages.h"

namespace strata::gl {

Result<Buffer> Buffer::create(std::size_t bytes, Use use, std::string_view label) {
  assert(bytes > 0);
  GLuint id = 0;
  glCreateBuffers(1, &id);
  Buffer buffer;
  buffer.object_ = Object<Traits>(id);
  constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const GLbitfield flags =
      use == Use::read_back ? kMapping | GL_CLIENT_STORAGE_BIT : GL_DYNAMIC_STORAGE_BIT;
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes), nullptr, flags);
  STRATA_TRY(check_memory(label, bytes));
  buffer.object_.label(label);
  buffer.size_ = bytes;
  if (use == Use::read_back) {
    buffer.mapped_ = static_cast<const std::byte*>(
        glMapNamedBufferRange(id, 0, static_cast<GLsizeiptr>(bytes), kMapping));
    if (!buffer.mapped_) {
      return fail(ErrorCode::out_of_memory, "GPU out of memory",
                  "The driver could not map the buffer '" + std::string(label) + "'.");
    }
  }
  return buffer;
}

void Buffer::upload(std::size_t offset, std::span<const std::byte> data) {
  assert(offset + data.size() <= size_);
  if (data.empty()) return;
  glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()),
                       data.data());
}

void Buffer::clear(std::size_t offset, std::size_t bytes) const {
  assert(offset + bytes <= size_);
  if (bytes == 0) return;
  glClearNamedBufferSubData(id(), GL_R32UI, static_cast<GLintptr>(offset),
                            static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT,
                            nullptr);
}

void Buffer::copy_to(const Buffer& target, std::size_t offset, std::size_t bytes) const {
  assert(offset + bytes <= size_ && bytes <= target.size());
  glCopyNamedBufferSubData(id(), target.id(), static_cast<GLintptr>(offset), 0,
                           static_cast<GLsizeiptr>(bytes));
}

void Buffer::bind_storage(GLuint binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

void Buffer::bind_uniform(GLuint binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

}  // namespace strata::gl
