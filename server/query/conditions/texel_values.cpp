#include "query/conditions/texel_values.h"

#include <algorithm>
#include <array>

namespace strata::query {
namespace {

std::vector<double> decode_all(ValueType type) {
  std::vector<double> values(std::size_t{1} << (8 * bytes_per_texel(type)));
  for (std::size_t bits = 0; bits < values.size(); ++bits)
    values[bits] = decode_value(type, static_cast<std::uint32_t>(bits));
  return values;
}

}  // namespace

std::vector<std::pair<TileAddress, const TileData*>> sorted_tiles(const TileMap& tiles) {
  std::vector<std::pair<TileAddress, const TileData*>> sorted;
  sorted.reserve(tiles.size());
  for (const auto& [address, tile] : tiles)
    if (tile) sorted.emplace_back(address, tile.get());
  std::ranges::sort(sorted, {}, [](const auto& tile) { return tile.first; });
  return sorted;
}

const double* values_of_bits(ValueType type) {
  static const std::vector<double> u8 = decode_all(ValueType::u8), i8 = decode_all(ValueType::i8),
                                   u16 = decode_all(ValueType::u16),
                                   i16 = decode_all(ValueType::i16),
                                   f16 = decode_all(ValueType::f16);
  switch (type) {
    case ValueType::u8: return u8.data();
    case ValueType::i8: return i8.data();
    case ValueType::u16: return u16.data();
    case ValueType::i16: return i16.data();
    case ValueType::f16: return f16.data();
    default: return nullptr;
  }
}

}  // namespace strata::query
