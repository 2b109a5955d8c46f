#include "query/statistics/quantiles.h"

#include <bit>
#include <map>

#include "domain/people/question.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

// Returns a 32-bit code for a value of a type. Codes have the same order as values.
std::uint32_t code_of(ValueType type, double value) {
  if (!is_float(type)) return static_cast<std::uint32_t>(value - lowest_value(type));
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value) + 0.0f);  // -0 becomes 0
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

double value_of(ValueType type, std::uint32_t code) {
  if (!is_float(type)) return lowest_value(type) + code;
  return double{std::bit_cast<float>((code >> 31) != 0 ? code & 0x7fffffffu : ~code)};
}

// Finds the value at which each share of the total area is reached. `add` receives pairs of value
// and area, in ascending order of values.
class Reached {
 public:
  explicit Reached(double area) : area_(area) {}
  void add(double value, double area) {
    sum_ += area;
    while (found_ < kQuantiles.size() && sum_.value() >= kQuantiles[found_] * area_)
      values_[found_++] = value;
    last_ = value;
  }
  Quantiles finish() {
    // rounding of the sum may leave some quantiles without a value
    while (found_ < kQuantiles.size()) values_[found_++] = last_;
    return values_;
  }

 private:
  const double area_;
  CompensatedSum sum_;
  double last_ = 0;
  std::size_t found_ = 0;
  Quantiles values_{};
};

}  // namespace

std::optional<Quantiles> quantiles(const LayerView& view, const mesh::SurfaceMap& map,
                                   const TexelSelection* within, const TileSums& sums) {
  const double whole = sums.area.value();
  if (!(whole > 0)) return std::nullopt;
  const ValueType type = view.layer.type;
  Reached reached(whole);
  if (!sums.keys.empty()) {
    std::map<double, double> area_of;
    for (const auto& key : sums.keys) area_of[decode_value(type, key.bits)] += key.area.value();
    for (const auto& [value, area] : area_of) reached.add(value, area);
    return reached.finish();
  }

  // Splits each code into two 16-bit digits. The first pass sums the area of each upper digit. The
  // second pass sums the area of each lower digit where a share is reached.
  constexpr std::size_t kDigits = std::size_t{1} << 16;
  const QuestionTurn turn;
  const auto for_each = [&](auto visit) {
    for (const auto& [address, tile] : view.snapshot.tiles) {
      turn.check(kTexelsPerTile);
      for_each_value(
          *tile, address, type, map, within,
          [&](std::uint32_t slot, int texel, std::uint32_t, double value) {
            visit(code_of(type, value),
                  double{map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)]});
          });
    }
  };
  std::vector<double> upper(kDigits, 0.0);
  for_each([&](std::uint32_t code, double area) { upper[code >> 16] += area; });
  std::vector<std::vector<double>> lower(kDigits);
  double below = 0;
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    const double until = below + upper[digit];
    for (const double share : kQuantiles)
      if (upper[digit] > 0 && until >= share * whole * (1 - 1e-9) &&
          below <= share * whole * (1 + 1e-9))
        lower[digit].resize(kDigits, 0.0);
    below = until;
  }
  for_each([&](std::uint32_t code, double area) {
    if (auto& digits = lower[code >> 16]; !digits.empty()) digits[code & 0xffffu] += area;
  });
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    if (lower[digit].empty()) {
      if (upper[digit] > 0)
        reached.add(value_of(type, static_cast<std::uint32_t>(digit << 16 | 0xffffu)),
                    upper[digit]);
      continue;
    }
    for (std::size_t low = 0; low < kDigits; ++low)
      if (const double area = lower[digit][low]; area > 0)
        reached.add(value_of(type, static_cast<std::uint32_t>(digit << 16 | low)), area);
  }
  return reached.finish();
}

}  // namespace strata::query
