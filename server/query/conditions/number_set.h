#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace strata::query {

// A set of numbers with lookup in constant time: a hash table with open addressing, at most half
// full.
class NumberSet {
 public:
  // `numbers` are finite, in any order, and possibly repeated.
  explicit NumberSet(std::span<const double> numbers) {
    while (places_.size() < 2 * numbers.size()) places_.resize(places_.size() * 2);
    shift_ = 64 - std::countr_zero(places_.size());
    used_.assign(places_.size(), 0);
    for (const double number : numbers) {
      const std::size_t place = place_of(number);
      size_ += used_[place] == 0;
      places_[place] = number;
      used_[place] = 1;
    }
  }

  std::size_t size() const { return size_; }
  bool contains(double number) const { return used_[place_of(number)] != 0; }

 private:
  // Returns the slot of a number, or the free slot for it. 0 and -0 are equal.
  std::size_t place_of(double number) const {
    const auto bits = std::bit_cast<std::uint64_t>(number == 0 ? 0.0 : number);
    std::size_t place = bits * 0x9e3779b97f4a7c15u >> shift_;
    while (used_[place] != 0 && places_[place] != number)
      place = (place + 1) & (places_.size() - 1);
    return place;
  }

  std::vector<double> places_ = std::vector<double>(4);
  std::vector<std::uint8_t> used_;
  int shift_ = 0;
  std::size_t size_ = 0;
};

}  // namespace strata::query
