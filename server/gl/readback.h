#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/fence.h"

namespace strata::gl {

class ReadbackPool;

// One transfer from the GPU. Fill `buffer()` with GL commands, call `submit()`, wait until
// `ready()` is true, and read `data()`. The destructor returns the memory to the pool, which must
// outlive this object.
class Readback {
 public:
  Readback() = default;
  Readback(Readback&& other) noexcept;
  Readback& operator=(Readback&& other) noexcept;
  ~Readback();

  explicit operator bool() const { return pool_ != nullptr; }
  const Buffer& buffer() const { return buffer_; }
  std::size_t size() const { return size_; }
  void submit();
  bool ready(std::uint64_t timeout_ns = 0) { return fence_.passed(timeout_ns); }
  std::span<const std::byte> data() const { return buffer_.mapped().first(size_); }

 private:
  friend class ReadbackPool;
  void release();

  ReadbackPool* pool_ = nullptr;
  Buffer buffer_;
  Fence fence_;
  std::size_t size_ = 0;
};

// Persistently mapped buffers that transfers reuse. Their sizes are powers of two. At most
// `kept_bytes` bytes of unused buffers are kept.
class ReadbackPool {
 public:
  explicit ReadbackPool(std::size_t kept_bytes = std::size_t{64} << 20) : kept_bytes_(kept_bytes) {}
  ReadbackPool(const ReadbackPool&) = delete;
  ReadbackPool& operator=(const ReadbackPool&) = delete;

  Result<Readback> begin(std::size_t bytes);
  void clear() { free_.clear(); }

 private:
  friend class Readback;
  void give_back(Buffer buffer);

  const std::size_t kept_bytes_;
  std::vector<Buffer> free_;
};

}  // namespace strata::gl
