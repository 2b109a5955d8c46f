#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

#include "core/problem.h"

namespace strata::render {

// The ledger of GPU memory: every large object holds a share of the budget while it lives. `reserve` is called on the GPU
// thread; `used` from any.
class GpuMemory {
 public:
  // A reserved number of bytes, given back on destruction. Move-only; must not outlive the ledger.
  class Share {
   public:
    Share() = default;
    Share(Share&& other) noexcept;
    Share& operator=(Share&& other) noexcept;
    ~Share() { reset(); }
    std::uint64_t bytes() const { return bytes_; }
    void reset();

   private:
    friend class GpuMemory;
    Share(GpuMemory* memory, std::uint64_t bytes) : memory_(memory), bytes_(bytes) {}
    GpuMemory* memory_ = nullptr;
    std::uint64_t bytes_ = 0;
  };

  explicit GpuMemory(std::uint64_t budget_bytes) : budget_bytes_(budget_bytes) {}
  void set_budget(std::uint64_t budget_bytes) { budget_bytes_ = budget_bytes; }
  std::uint64_t used() const { return used_bytes_; }

  // Frees one thing that is not used or can be made again (empty pages, a depth buffer, a view's buffers); false when
  // there is none.
  void set_evictor(std::function<bool()> evict_one) { evict_one_ = std::move(evict_one); }
  // A Problem 503 when `bytes` do not fit even after eviction; `what` names their use in it.
  Result<Share> reserve(std::uint64_t bytes, std::string_view what);

 private:
  std::uint64_t budget_bytes_;
  std::atomic<std::uint64_t> used_bytes_{0};
  std::function<bool()> evict_one_;
};

}  // namespace strata::render
