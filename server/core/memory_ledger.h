#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// Counts the use of one kind of memory. Each large object holds a share of the budget while it
// exists. Thread-safe except `set_budget` and `set_evictor`: call these only at the start and at
// the end.
class MemoryLedger {
 public:
  // Bytes that are reserved until the destructor runs. Move-only. Must not outlive the ledger.
  class Share {
   public:
    Share() = default;
    Share(Share&& other) noexcept;
    Share& operator=(Share&& other) noexcept;
    ~Share() { reset(); }
    std::uint64_t bytes() const { return bytes_; }
    // Corrects the size after the object has grown or shrunk, even if the total then exceeds the
    // budget. The share must not be empty.
    void recount(std::uint64_t bytes);
    void reset();

   private:
    friend class MemoryLedger;
    Share(MemoryLedger* ledger, std::uint64_t bytes) : ledger_(ledger), bytes_(bytes) {}
    MemoryLedger* ledger_ = nullptr;
    std::uint64_t bytes_ = 0;
  };

  // The messages contain `kind` and `option`, such as "GPU memory" and "--gpu-memory".
  MemoryLedger(std::string kind, std::string option, std::uint64_t budget_bytes)
      : kind_(std::move(kind)), option_(std::move(option)), budget_bytes_(budget_bytes) {}
  void set_budget(std::uint64_t budget_bytes) { budget_bytes_ = budget_bytes; }
  std::uint64_t budget() const { return budget_bytes_; }
  std::uint64_t used() const { return used_bytes_; }
  // Returns whether the bytes fit without eviction.
  bool fits(std::uint64_t bytes) const { return used_bytes_ + bytes <= budget_bytes_; }
  bool exceeded() const { return used_bytes_ > budget_bytes_; }

  // Sets the function that frees one object that is unused or can be created again. The function
  // returns false if no such object exists. It runs on the thread that calls `reserve`.
  void set_evictor(std::function<bool()> evict_one) { evict_one_ = std::move(evict_one); }
  // Returns the error `out_of_memory` if `bytes` do not fit even after eviction. `what` names the
  // use of the bytes in the message.
  Result<Share> reserve(std::uint64_t bytes, std::string_view what);
  Error used_up(std::uint64_t bytes, std::string_view what) const;

 private:
  const std::string kind_, option_;
  std::atomic<std::uint64_t> budget_bytes_;
  std::atomic<std::uint64_t> used_bytes_{0};
  std::function<bool()> evict_one_;
};

}  // namespace strata
