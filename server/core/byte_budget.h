#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/error.h"

namespace strata {

// Bounds the memory that large answers and bodies hold together. One larger than the budget may
// have it all. Thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(std::uint64_t total) : total_(total) {}

  // Held until the last copy goes; 503 where too much is held by others.
  Result<std::shared_ptr<const void>> take(std::uint64_t bytes) {
    std::uint64_t held = held_->load();
    do {
      if (held > 0 && held + bytes > total_)
        return fail(ErrorCode::busy, "Too many rasters",
                    "Other large rasters are being read or written; ask again in a moment.");
    } while (!held_->compare_exchange_weak(held, held + bytes));
    return std::shared_ptr<const void>(held_.get(),
                                       [held = held_, bytes](const void*) { *held -= bytes; });
  }

 private:
  const std::uint64_t total_;
  const std::shared_ptr<std::atomic<std::uint64_t>> held_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
};

}  // namespace strata
