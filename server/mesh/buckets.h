#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace strata::mesh {

// A row of buckets and the items in each of them. An item that extends over several buckets is in
// each of them.
class Buckets {
 public:
  Buckets() = default;
  // For each item from 0 to items - 1, reach_of(item) returns the pair of its first and last
  // bucket. It is called twice for each item.
  template <class ReachOf>
  Buckets(int count, std::uint32_t items, const ReachOf& reach_of)
      : first_(static_cast<std::size_t>(count) + 1, 0) {
    for_each(items, reach_of, [&](std::uint32_t, std::size_t bucket) { ++first_[bucket + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    auto cursor = first_;
    for_each(items, reach_of,
             [&](std::uint32_t item, std::size_t bucket) { items_[cursor[bucket]++] = item; });
  }

  std::span<const std::uint32_t> operator[](int bucket) const {  // ascending
    const auto at = static_cast<std::size_t>(bucket);
    return std::span(items_).subspan(first_[at], first_[at + 1] - first_[at]);
  }

 private:
  template <class ReachOf, class Visit>
  static void for_each(std::uint32_t items, const ReachOf& reach_of, const Visit& visit) {
    for (std::uint32_t item = 0; item < items; ++item) {
      const auto [low, high] = reach_of(item);
      for (int bucket = low; bucket <= high; ++bucket)
        visit(item, static_cast<std::size_t>(bucket));
    }
  }

  std::vector<std::uint32_t> first_, items_;
};

}  // namespace strata::mesh
