#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/error.h"

namespace strata {

// Limits the total memory of large responses and request bodies. A response or body that is larger
// than the budget is accepted only while nothing else is reserved. Thread-safe.
class ByteBudget {
 public:
  explicit ByteBudget(std::uint64_t total) : total_(total) {}

  // Reserves the bytes until the last copy of the result is destroyed. Returns the error `busy` if
  // the other reservations leave too little of the budget.
  Result<std::shared_ptr<const void>> take(std::uint64_t bytes) {
    std::uint64_t held = held_->load();
    do {
      if (held > 0 && held + bytes > total_)
        return fail(ErrorCode::busy, "Too many rasters",
                    "The server is reading or writing other large rasters. Try again in a moment.");
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
