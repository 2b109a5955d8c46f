#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "media/picture.h"
#include "render/renderer.h"

namespace strata::stream {

// One JPEG for each rectangle of a frame, in order.
using Jpegs = std::shared_ptr<const std::vector<std::vector<std::uint8_t>>>;

// A few threads that encode frames, each frame once for any number of viewers. The queue contains
// at most one frame per viewer.
class JpegPool {
 public:
  using Done = std::function<void(const Jpegs&, double)>;
  explicit JpegPool(int threads);
  ~JpegPool();
  // Calls `done` on a pool thread with the JPEGs and the encoding time in milliseconds. The JPEGs
  // are null if the encoding failed, which is logged. `done` is not called for frames that still
  // wait when the pool is destroyed.
  void encode(render::SharedFrame frame, JpegSettings settings, Done done);
  std::uint64_t encoded() const;  // number of encoded frames so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
