#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "query/regions/surface_values.h"

namespace strata::query {

// Sums of areas by value, in a neighborhood. Most neighborhoods have two or three values.
class ValueAreas {
 public:
  struct Entry {
    TexelValue value;
    std::uint64_t area = 0;
  };

  void clear() {
    entries_.clear();
    index_.clear();
    last_ = 0;
  }
  void add(TexelValue value, std::uint32_t area) {
    if (entries_.empty() || entries_[last_].value != value) last_ = find(value);
    entries_[last_].area += area;
  }

  // Returns the number of distinct values.
  std::size_t count() const { return entries_.size(); }

  // Returns the value with the largest area, or `own` if no area is larger by 1 in 10⁴.
  TexelValue largest(TexelValue own) const {
    std::uint64_t most = 0, of_own = 0;
    for (const Entry& entry : entries_) {
      most = std::max(most, entry.area);
      if (entry.value == own) of_own = entry.area;
    }
    const std::uint64_t enough = most - most / 10'000;
    if (of_own >= enough) return own;
    const Entry* best = nullptr;
    for (const Entry& entry : entries_)
      if (entry.area >= enough && (!best || comes_first(entry.value, best->value))) best = &entry;
    return best ? best->value : own;
  }

 private:
  static constexpr std::size_t kFew = 16;  // up to here, a search is faster than the index
  static std::uint64_t key(TexelValue value) {
    return (std::uint64_t{value.valid} << 32) | value.bits;
  }
  static bool comes_first(TexelValue a, TexelValue b) {
    return a.valid != b.valid ? a.valid : a.bits < b.bits;
  }
  std::size_t find(TexelValue value) {
    if (entries_.size() <= kFew) {
      for (std::size_t i = 0; i < entries_.size(); ++i)
        if (entries_[i].value == value) return i;
    } else if (index_.empty()) {
      for (std::size_t i = 0; i < entries_.size(); ++i) index_[key(entries_[i].value)] = i;
    }
    if (entries_.size() > kFew) {
      const auto [found, fresh] = index_.try_emplace(key(value), entries_.size());
      if (!fresh) return found->second;
    }
    entries_.push_back({value, 0});
    return entries_.size() - 1;
  }

  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::size_t last_ = 0;
};

}  // namespace strata::query
