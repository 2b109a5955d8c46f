#pragma once

#include <algorithm>
#include <bit>
#include <span>
#include <string>

#include "gl/buffer.h"

namespace strata::render {

// A buffer with new content for each dispatch. Its size is doubled as required.
class StreamBuffer {
 public:
  explicit StreamBuffer(std::string label = {}) : label_(std::move(label)) {}

  template <class T>
  Result<void> replace(std::span<const T> values) {
    STRATA_TRY(make_room(values.size_bytes()));
    buffer_.upload_values(0, values);
    return {};
  }
  // Provides at least `bytes` bytes with undefined content.
  Result<void> make_room(std::size_t bytes) {
    const std::size_t needed = std::max<std::size_t>(bytes, 4096);
    if (buffer_.size() < needed) {
      auto buffer =
          STRATA_TRY(gl::Buffer::create(std::bit_ceil(needed), gl::Buffer::Use::fixed, label_));
      buffer_ = std::move(buffer);
    } else {
      // The driver need not wait for commands that read the old content.
      glInvalidateBufferData(buffer_.id());
    }
    return {};
  }
  const gl::Buffer& buffer() const { return buffer_; }
  void bind_storage(GLuint binding) const { buffer_.bind_storage(binding); }
  void bind_uniform(GLuint binding) const { buffer_.bind_uniform(binding); }

 private:
  std::string label_;
  gl::Buffer buffer_;
};

}  // namespace strata::render
