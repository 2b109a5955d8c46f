#include "query/regions/place_permutations.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <unordered_set>
#include <utility>

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
                                     double neighbors, int permutations, const Progress& progress)
    : number_(std::floor(places.number)), permutations_(static_cast<std::size_t>(permutations)) {
  if (!(places.deviation > 0) || number_ < 2) return;
  const std::vector<float> values = values_of_places(places, areas, progress);
  if (progress.cancelled()) return;
  draw(values, static_cast<std::size_t>(std::min(number_, std::ceil(neighbors) + 2)), progress);
}

std::vector<float> PlacePermutations::values_of_places(const EqualPlaces& places,
                                                       std::span<const float> areas,
                                                       const Progress& progress) {
  const TexelsByArea texels(*places.valid, areas);
  std::vector<float> values;
  double sum = 0;
  values.reserve(static_cast<std::size_t>(number_));
  by_value_.reserve(static_cast<std::size_t>(number_));
  for (double place = 0; place < number_; ++place) {
    if (values.size() % (1u << 18) == 0 && progress.cancelled()) return values;
    const std::uint32_t texel = texels.at((place + 0.5) / number_ * texels.sum());
    values.push_back(std::bit_cast<float>(places.means.bits[texel]));
    sum += double{values.back()};
  }
  mean_ = sum / number_;
  for (std::uint32_t place = 0; place < values.size(); ++place) {
    values[place] -= static_cast<float>(mean_);
    by_value_.emplace_back(values[place], place);
  }
  std::ranges::sort(by_value_);
  return values;
}

void PlacePermutations::draw(const std::vector<float>& values, std::size_t longest,
                             const Progress& progress) {
  sums_.resize((longest + 1) * permutations_);
  drawn_.reserve(longest * permutations_);
  std::mt19937_64 random(kSeed);
  const auto below_1 = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::unordered_set<std::uint32_t> drawn;
  for (std::uint32_t permutation = 0; permutation < permutations_; ++permutation) {
    if (progress.cancelled()) return;
    double sum = 0;
    drawn.clear();
    for (std::uint32_t count = 1; count <= longest; ++count) {
      std::uint32_t place = 0;
      do {
        place = static_cast<std::uint32_t>(below_1() * number_);
      } while (!drawn.insert(place).second);
      drawn_.push_back({place, permutation, count});
      sum += double{values[place]};
      sums_[count * permutations_ + permutation] = static_cast<float>(sum);
    }
  }
  std::ranges::sort(drawn_);
}

std::pair<float, std::uint32_t> PlacePermutations::place_with(double value) const {
  const auto wanted = static_cast<float>(value - mean_);
  const auto above = std::ranges::lower_bound(by_value_, std::pair(wanted, std::uint32_t{0}));
  if (above == by_value_.begin()) return *above;
  const auto below = std::prev(above);
  return above == by_value_.end() || wanted - below->first < above->first - wanted ? *below
                                                                                   : *above;
}

float PlacePermutations::chance(double sum, double neighbors, double own) const {
  if (sums_.empty() || !(neighbors > 0) || neighbors + 1 >= number_) return 1;
  // The other places have another mean than all places.
  const auto [own_value, own_place] = place_with(own);
  const auto shift = static_cast<float>(neighbors * double{own_value} / (number_ - 1));
  // Equal sums differ by their rounding.
  const auto off =
      static_cast<float>((1 - 1e-5) * std::abs(sum - neighbors * mean_ + double{shift}));
  const auto whole = static_cast<std::size_t>(neighbors);
  const auto fraction = static_cast<float>(neighbors - static_cast<double>(whole));
  const auto is_as_far = [&](float fewer, float more) {
    return std::abs(fewer + fraction * (more - fewer) + shift) >= off;
  };
  const float* const fewer = &sums_[whole * permutations_];
  const float* const more = fewer + permutations_;
  std::uint32_t as_far = 1;
  for (std::size_t i = 0; i < permutations_; ++i) as_far += is_as_far(fewer[i], more[i]) ? 1 : 0;
  // A permutation with the place itself takes the next place instead.
  for (const Drawn& drawn : std::ranges::equal_range(drawn_, own_place, {}, &Drawn::place)) {
    if (drawn.rank > whole + 1) continue;
    const std::size_t i = drawn.permutation;
    const auto without = [&](std::size_t count) {
      return drawn.rank > count ? sums_[count * permutations_ + i]
                                : sums_[(count + 1) * permutations_ + i] - own_value;
    };
    as_far -= is_as_far(fewer[i], more[i]) ? 1 : 0;
    as_far += is_as_far(without(whole), without(whole + 1)) ? 1 : 0;
  }
  return static_cast<float>(as_far) / static_cast<float>(permutations_ + 1);
}

}  // namespace strata::query
