#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// Accounts for one kind of memory: every large object holds a share of the budget as long as it
// exists. Thread-safe except `set_budget` and `set_evictor`: call these at the start and the end.
class MemoryLedger {
 public:
  // A counted number of bytes, released on destruction. Move-only; must not outlive the ledger.
  class Share {
   public:
    Share() = default;
    Share(Share&& other) noexcept;
    Share& operator=(Share&& other) noexcept;
    ~Share() { reset(); }
    std::uint64_t bytes() const { return bytes_; }
    // Corrects the size of an object that has grown or shrunk already, also beyond the budget. Not
    // for an empty share.
    void recount(std::uint64_t bytes);
    void reset();

   private:
    friend class MemoryLedger;
    Share(MemoryLedger* ledger, std::uint64_t bytes) : ledger_(ledger), bytes_(bytes) {}
    MemoryLedger* ledger_ = nullptr;
    std::uint64_t bytes_ = 0;
  };

  // `kind` and `option` appear in messages: "GPU memory", "--gpu-memory".
  MemoryLedger(std::string kind, std::string option, std::uint64_t budget_bytes)
      : kind_(std::move(kind)), option_(std::move(option)), budget_bytes_(budget_bytes) {}
  void set_budget(std::uint64_t budget_bytes) { budget_bytes_ = budget_bytes; }
  std::uint64_t budget() const { return budget_bytes_; }
  std::uint64_t used() const { return used_bytes_; }
  // without eviction
  bool fits(std::uint64_t bytes) const { return used_bytes_ + bytes <= budget_bytes_; }
  bool exceeded() const { return used_bytes_ > budget_bytes_; }

  // Frees one object that is unused or can be made again; false if no such object exists. `reserve`
  // calls it on its thread.
  void set_evictor(std::function<bool()> evict_one) { evict_one_ = std::move(evict_one); }
  // Error `out_of_memory`: `bytes` do not fit even after eviction; `what` names their use in the
  // message.
  Result<Share> reserve(std::uint64_t bytes, std::string_view what);
  Error used_up(std::uint64_t bytes, std::string_view what) const;

 private:
  const std::string kind_, option_;
  std::uint64_t budget_bytes_;
  std::atomic<std::uint64_t> used_bytes_{0};
  std::function<bool()> evict_one_;
};

}  // namespace strata
