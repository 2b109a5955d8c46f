#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace strata::render {

// Lists of segment numbers of a path, stored one after another. Neighboring blocks usually share a
// list.
class SegmentLists {
 public:
  // Returns the position of the list's first number. A list that equals the previous one shares its
  // numbers.
  std::uint32_t add(std::span<const std::uint32_t> list) {
    const auto last = std::span(numbers_).subspan(last_list_);
    if (numbers_.empty() || !std::ranges::equal(last, list)) {
      last_list_ = numbers_.size();
      numbers_.insert(numbers_.end(), list.begin(), list.end());
    }
    return static_cast<std::uint32_t>(last_list_);
  }
  // Appends other lists. Returns the position of their first number.
  std::uint32_t append(const SegmentLists& others) {
    const std::size_t begin = numbers_.size();
    last_list_ = begin + others.last_list_;
    numbers_.insert(numbers_.end(), others.numbers_.begin(), others.numbers_.end());
    return static_cast<std::uint32_t>(begin);
  }
  std::span<const std::uint32_t> at(std::uint32_t first, std::uint32_t count) const {
    return std::span(numbers_).subspan(first, count);
  }
  const std::vector<std::uint32_t>& numbers() const { return numbers_; }

 private:
  std::vector<std::uint32_t> numbers_;
  std::size_t last_list_ = 0;
};

}  // namespace strata::render
