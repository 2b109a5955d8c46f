#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/picture.h"

namespace strata::stream {

// A few threads that encode pictures; the queue is bounded by the viewers' credit (one picture in work per viewer).
class JpegPool {
 public:
  explicit JpegPool(int threads);
  ~JpegPool();
  // `done` runs on a pool thread with the bytes and the milliseconds it took; no bytes where encoding failed (logged).
  // Not called for pictures that still wait when the pool is destroyed.
  void encode(std::vector<std::uint8_t> rgba, int width, int height, JpegSettings settings,
              std::function<void(std::vector<std::uint8_t>, double)> done);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
