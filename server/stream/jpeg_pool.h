#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "media/picture.h"
#include "render/renderer.h"

namespace strata::stream {

// One for each rectangle of a frame, in order.
using Jpegs = std::shared_ptr<const std::vector<std::vector<std::uint8_t>>>;

// A few threads that encode pictures, each picture once for any number of viewers. The viewers'
// credit limits the queue (one picture in work per viewer).
class JpegPool {
 public:
  using Done = std::function<void(const Jpegs&, double)>;
  explicit JpegPool(int threads);
  ~JpegPool();
  // `done` runs on a pool thread with the bytes and the milliseconds of the encoding; null if
  // encoding failed (logged). Not called for pictures that still wait when the pool is destroyed.
  void encode(render::SharedFrame frame, JpegSettings settings, Done done);
  std::uint64_t encoded() const;  // pictures so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
