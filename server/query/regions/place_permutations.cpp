#include "query/regions/place_permutations.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <unordered_set>

namespace strata::query {
namespace {

constexpr std::uint64_t kSeed = 1;

// Finds texels by the area of all texels before them.
class TexelsByArea {
 public:
  TexelsByArea(const std::vector<std::uint64_t>& valid, std::span<const float> areas)
      : valid_(valid), areas_(areas) {
    before_.reserve(valid.size() + 1);
    double sum = 0;
    for (std::uint32_t slot = 0; slot < valid.size(); ++slot) {
      before_.push_back(sum);
      for (std::uint64_t left = valid[slot]; left != 0; left &= left - 1)
        sum += area_of(slot, left);
    }
    before_.push_back(sum);
  }

  double sum() const { return before_.back(); }

  std::uint32_t at(double area) const {
    // The last slot with this much area before it has texels, because the next slot has more.
    const auto next = std::upper_bound(before_.begin(), before_.end() - 1, area);
    const auto slot = static_cast<std::uint32_t>(next - before_.begin() - 1);
    double left_over = area - before_[slot];
    std::uint64_t left = valid_[slot];
    for (; (left & (left - 1)) != 0; left &= left - 1) {
      left_over -= area_of(slot, left);
      if (left_over < 0) break;
    }
    return slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
  }

 private:
  double area_of(std::uint32_t slot, std::uint64_t left) const {
    return double{areas_[slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left))]};
  }

  const std::vector<std::uint64_t>& valid_;
  const std::span<const float> areas_;
  std::vector<double> before_;  // by slot, and the sum
};

}  // namespace

PlacePermutations::PlacePermutations(const EqualPlaces& places, std::span<const float> areas,
                                     double neighbors, int permutations)
    : mean_(places.mean),
      number_(std::floor(places.number)),
      permutations_(static_cast<std::size_t>(permutations)) {
  if (!(places.deviation > 0) || number_ < 2) return;
  const TexelsByArea texels(*places.valid, areas);
  const double longest = std::min(number_, std::ceil(neighbors) + 1);
  sums_.resize((static_cast<std::size_t>(longest) + 1) * permutations_);
  std::mt19937_64 random(kSeed);
  const auto below_1 = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::unordered_set<std::uint32_t> drawn;
  for (std::size_t permutation = 0; permutation < permutations_; ++permutation) {
    // The places of one permutation divide the surface into equal parts.
    const double offset = below_1();
    double sum = 0;
    drawn.clear();
    for (std::size_t count = 1; count <= static_cast<std::size_t>(longest); ++count) {
      std::uint32_t place = 0;
      do {
        place = static_cast<std::uint32_t>(below_1() * number_);
      } while (!drawn.insert(place).second);
      const std::uint32_t texel = texels.at((place + offset) / number_ * texels.sum());
      sum += double{std::bit_cast<float>(places.means.bits[texel])} - mean_;
      sums_[count * permutations_ + permutation] = static_cast<float>(sum);
    }
  }
}

float PlacePermutations::chance(double sum, double neighbors, double own) const {
  if (sums_.empty() || !(neighbors > 0) || neighbors + 1 >= number_) return 1;
  const double mean_of_others = mean_ + (mean_ - own) / (number_ - 1);
  // Equal sums differ by their rounding.
  const auto off = static_cast<float>((1 - 1e-5) * std::abs(sum - neighbors * mean_of_others));
  const auto whole = static_cast<std::size_t>(neighbors);
  const auto fraction = static_cast<float>(neighbors - static_cast<double>(whole));
  const float* const fewer = &sums_[whole * permutations_];
  const float* const more = fewer + permutations_;
  std::uint32_t as_far = 1;
  for (std::size_t i = 0; i < permutations_; ++i)
    as_far += std::abs(fewer[i] + fraction * (more[i] - fewer[i])) >= off ? 1 : 0;
  return static_cast<float>(as_far) / static_cast<float>(permutations_ + 1);
}

}  // namespace strata::query
