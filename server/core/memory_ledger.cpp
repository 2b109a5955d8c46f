#include "core/memory_ledger.h"

#include <utility>

namespace strata {
namespace {

std::string mib(std::uint64_t bytes) {
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB";
}

}  // namespace

MemoryLedger::Share::Share(Share&& other) noexcept
    : ledger_(std::exchange(other.ledger_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

MemoryLedger::Share& MemoryLedger::Share::operator=(Share&& other) noexcept {
  if (this != &other) {
    reset();
    ledger_ = std::exchange(other.ledger_, nullptr);
    bytes_ = std::exchange(other.bytes_, 0);
  }
  return *this;
}

void MemoryLedger::Share::recount(std::uint64_t bytes) {
  ledger_->used_bytes_ += bytes - bytes_;  // also correct if `bytes` is less: modulo 2^64
  bytes_ = bytes;
}

void MemoryLedger::Share::reset() {
  if (ledger_) std::exchange(ledger_, nullptr)->used_bytes_ -= std::exchange(bytes_, 0);
}

Result<MemoryLedger::Share> MemoryLedger::reserve(std::uint64_t bytes, std::string_view what) {
  for (std::uint64_t used = used_bytes_;;) {
    if (used + bytes <= budget_bytes_) {
      if (used_bytes_.compare_exchange_weak(used, used + bytes)) return Share(this, bytes);
      continue;
    }
    if (!evict_one_ || !evict_one_()) return tl::unexpected(used_up(bytes, what));
    used = used_bytes_;
  }
}

Error MemoryLedger::used_up(std::uint64_t bytes, std::string_view what) const {
  return {ErrorCode::out_of_memory,
          kind_ + " exhausted",
          "The budget of " + mib(budget_bytes_) + " of " + kind_ + " is exhausted: " + mib(bytes) +
              " more are needed for " + std::string(what) + ", and " + mib(used_bytes_) +
              " are in use. Close models or layers, or start the " + "server with a larger " +
              option_ + ".",
          {}};
}

}  // namespace strata
