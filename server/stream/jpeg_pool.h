#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace strata::stream {

struct JpegSettings {
  int quality = 80;         // 1…100
  bool full_color = false;  // 4:4:4 instead of 4:2:0
};

// RGBA8 rows, top first → JPEG, which leaves alpha out. Thread-safe. Throws where `rgba` is not width × height × 4 bytes.
std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height, JpegSettings settings);
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height);

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
