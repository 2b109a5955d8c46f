#include "render/gpu_memory.h"

#include <string>
#include <utility>

namespace strata::render {

GpuMemory::Share::Share(Share&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

GpuMemory::Share& GpuMemory::Share::operator=(Share&& other) noexcept {
  if (this != &other) {
    reset();
    memory_ = std::exchange(other.memory_, nullptr);
    bytes_ = std::exchange(other.bytes_, 0);
  }
  return *this;
}

void GpuMemory::Share::reset() {
  if (memory_) std::exchange(memory_, nullptr)->used_bytes_ -= std::exchange(bytes_, 0);
}

Result<GpuMemory::Share> GpuMemory::reserve(std::uint64_t bytes, std::string_view what) {
  while (used_bytes_ + bytes > budget_bytes_) {
    if (evict_one_ && evict_one_()) continue;
    const auto mib = [](std::uint64_t n) { return std::to_string((n + (1 << 20) - 1) >> 20) + " MiB"; };
    return fail(503, "GPU memory used up",
                "The GPU memory budget of " + mib(budget_bytes_) + " is used up: " + mib(bytes) +
                    " more are needed for " + std::string(what) + ", and " + mib(used_bytes_) +
                    " are in use. Close models or layers, or start the server with a larger --gpu-memory.");
  }
  used_bytes_ += bytes;
  return Share(this, bytes);
}

}  // namespace strata::render
