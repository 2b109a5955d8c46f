#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace strata::mesh {

inline std::uint64_t mix_hash(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

// A hash table (open addressing) of indices into other arrays. A slot has 4 bytes, and at most 3/4
// of the slots are used.
class IndexTable {
 public:
  explicit IndexTable(std::size_t expected)
      : slots_(std::bit_ceil(std::max<std::size_t>(16, expected + expected / 3 + 1)), kEmpty) {}

  // Returns an index inserted earlier that is `equal` to `index`. If no such index exists, inserts
  // `index` and returns it.
  template <class Equal>
  std::uint32_t find_or_insert(std::uint64_t hash, std::uint32_t index, Equal equal) {
    for (std::size_t slot = first(hash);; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == kEmpty) return slots_[slot] = index;
      if (equal(slots_[slot])) return slots_[slot];
    }
  }

  // Inserts `index` even if the table has an equal one.
  void insert(std::uint64_t hash, std::uint32_t index) {
    find_or_insert(hash, index, [](std::uint32_t) { return false; });
  }

  // Calls visit(index) for all indices inserted with this hash, and possibly for others.
  template <class Visit>
  void for_each(std::uint64_t hash, Visit visit) const {
    for (std::size_t slot = first(hash); slots_[slot] != kEmpty;
         slot = (slot + 1) & (slots_.size() - 1))
      visit(slots_[slot]);
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;
  std::size_t first(std::uint64_t hash) const { return (hash ^ hash >> 32) & (slots_.size() - 1); }

  std::vector<std::uint32_t> slots_;
};

}  // namespace strata::mesh
