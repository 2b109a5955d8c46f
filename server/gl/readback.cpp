#include "gl/readback.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace strata::gl {
namespace {

constexpr std::size_t kMin = std::size_t{64} << 10;

}  // namespace

Readback::Readback(Readback&& other) noexcept
    : pool_(std::exchange(other.pool_, nullptr)),
      buffer_(std::move(other.buffer_)),
      fence_(std::move(other.fence_)),
      size_(std::exchange(other.size_, 0)) {}

Readback& Readback::operator=(Readback&& other) noexcept {
  if (this != &other) {
    release();
    pool_ = std::exchange(other.pool_, nullptr);
    buffer_ = std::move(other.buffer_);
    fence_ = std::move(other.fence_);
    size_ = std::exchange(other.size_, 0);
  }
  return *this;
}

Readback::~Readback() { release(); }

void Readback::release() {
  if (pool_) std::exchange(pool_, nullptr)->give_back(std::move(buffer_));
}

void Readback::submit() {
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT);
  fence_ = Fence::place();
}

Result<Readback> ReadbackPool::begin(std::size_t bytes) {
  const std::size_t capacity = std::bit_ceil(std::max(bytes, kMin));
  Readback readback;
  readback.size_ = bytes;
  const auto fitting = std::find_if(free_.begin(), free_.end(),
                                    [&](const Buffer& b) { return b.size() == capacity; });
  if (fitting != free_.end()) {
    readback.buffer_ = std::move(*fitting);
    free_.erase(fitting);
  } else {
    auto buffer = STRATA_TRY(Buffer::create(capacity, Buffer::Use::read_back, "readback"));
    readback.buffer_ = std::move(buffer);
  }
  readback.pool_ = this;
  return readback;
}

void ReadbackPool::give_back(Buffer buffer) {
  std::size_t retained_bytes = buffer.size();
  if (retained_bytes > kept_bytes_) return;
  free_.push_back(std::move(buffer));
  // Frees the oldest unused buffers first.
  for (auto it = free_.rbegin() + 1; it != free_.rend(); ++it) retained_bytes += it->size();
  while (retained_bytes > kept_bytes_) {
    retained_bytes -= free_.front().size();
    free_.erase(free_.begin());
  }
}

}  // namespace strata::gl
