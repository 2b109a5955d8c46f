#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/error.h"
#include "gl/object.h"

namespace strata::gl {

// A buffer with immutable storage. Empty if default-constructed or moved from.
class Buffer {
 public:
  enum class Use {
    fixed,      // filled at creation or by `upload`, read by the GPU
    read_back,  // always mapped; the GPU writes, the CPU reads after a fence
  };

  Buffer() = default;
  // Returns the Error `out_of_memory` if the driver has no memory for the buffer.
  static Result<Buffer> create(std::size_t bytes, Use use, std::string_view label);

  GLuint id() const { return object_.id(); }
  std::size_t size() const { return size_; }
  explicit operator bool() const { return static_cast<bool>(object_); }

  // `offset + data.size()` must be inside the buffer.
  void upload(std::size_t offset, std::span<const std::byte> data);
  template <class T>
  void upload_values(std::size_t offset, std::span<const T> values) {
    upload(offset, std::as_bytes(values));
  }
  // Ranges must be inside the buffers, and must begin and end at multiples of 4. If shaders wrote
  // the range, a barrier must precede these calls.
  void clear(std::size_t offset, std::size_t bytes) const;  // writes zeros
  // Copies to the target's start.
  void copy_to(const Buffer& target, std::size_t offset, std::size_t bytes) const;
  void bind_storage(GLuint binding) const;
  void bind_uniform(GLuint binding) const;

  // Empty unless the use is `read_back`.
  std::span<const std::byte> mapped() const { return {mapped_, mapped_ ? size_ : 0}; }

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_BUFFER;
    static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
  };
  Object<Traits> object_;
  std::size_t size_ = 0;
  const std::byte* mapped_ = nullptr;
};

}  // namespace strata::gl
