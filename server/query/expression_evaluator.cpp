#include "query/expression_evaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

#include "mesh/parallel.h"
#include "query/texel_values.h"
#include "query/tile_table.h"

namespace strata::query {
namespace {

using Op = Expression::Op;
using Bits = std::uint64_t;  // one a texel of a block

constexpr int kTexels = kBlockSize * kBlockSize;
constexpr Bits kAll = ~Bits{0};

template <class Test>
Bits bits_where(Test test) {
  Bits bits = 0;
  for (int i = 0; i < kTexels; ++i) bits |= Bits{test(i)} << i;
  return bits;
}

// What an expression is at the 64 texels of a block.
struct Numbers {
  std::array<double, kTexels> value{};  // finite where known
  Bits known = 0;
};
struct Truths {
  Bits holds = 0;  // a part of `known`
  Bits known = 0;
};

struct Source {
  TileTable tiles;
  ValueType type;
  int resolution;
};
using Sources = std::map<std::string, Source>;

class Block {
 public:
  Block(const Sources& sources, int resolution, int bx, int by)
      : sources_(sources), resolution_(resolution), bx_(bx), by_(by) {}

  Truths truths(const Expression& e) const {
    const auto part = [&](std::size_t i) { return truths(e.parts[i]); };
    switch (e.op) {
      case Op::truth: return {e.number != 0 ? kAll : 0, kAll};
      case Op::valid: return {layer(e.layer, false).known, kAll};
      case Op::known: return {numbers(e.parts[0]).known, kAll};
      case Op::negation: {
        const Truths inside = part(0);
        return {inside.known & ~inside.holds, inside.known};
      }
      case Op::all: {
        Truths result{kAll, kAll};
        Bits fails = 0;
        for (std::size_t i = 0; i < e.parts.size(); ++i) {
          const Truths each = part(i);
          fails |= each.known & ~each.holds;
          result.holds &= each.holds;
        }
        result.known = fails | result.holds;
        return result;
      }
      case Op::any: {
        Bits holds = 0, fails = kAll;
        for (std::size_t i = 0; i < e.parts.size(); ++i) {
          const Truths each = part(i);
          holds |= each.holds;
          fails &= each.known & ~each.holds;
        }
        return {holds, holds | fails};
      }
      default: return comparison(e);
    }
  }

 private:
  Truths comparison(const Expression& e) const {
    const Numbers a = numbers(e.parts[0]), b = numbers(e.parts[1]);
    const auto where = [&](auto test) { return bits_where([&](int i) { return test(a.value[i], b.value[i]); }); };
    const Bits known = a.known & b.known;
    Bits holds = 0;
    switch (e.op) {
      case Op::less: holds = where([](double x, double y) { return x < y; }); break;
      case Op::less_equal: holds = where([](double x, double y) { return x <= y; }); break;
      case Op::greater: holds = where([](double x, double y) { return x > y; }); break;
      case Op::greater_equal: holds = where([](double x, double y) { return x >= y; }); break;
      case Op::equal: holds = where([](double x, double y) { return x == y; }); break;
      default: holds = where([](double x, double y) { return x != y; }); break;
    }
    return {holds & known, known};
  }

  Numbers numbers(const Expression& e) const {
    switch (e.op) {
      case Op::number: {
        Numbers constant;
        const bool known = std::isfinite(e.number);
        constant.value.fill(known ? e.number : 0);
        constant.known = known ? kAll : 0;
        return constant;
      }
      case Op::layer: return layer(e.layer, true);
      case Op::choose: return choice(e);
      case Op::negate: return mapped(e, [](double x) { return -x; });
      case Op::absolute: return mapped(e, [](double x) { return std::abs(x); });
      case Op::add: return folded(e, [](double x, double y) { return x + y; });
      case Op::subtract: return folded(e, [](double x, double y) { return x - y; });
      case Op::multiply: return folded(e, [](double x, double y) { return x * y; });
      case Op::divide: return folded(e, [](double x, double y) { return x / y; });
      case Op::power: return folded(e, [](double x, double y) { return std::pow(x, y); });
      case Op::remainder: return folded(e, [](double x, double y) { return std::fmod(x, y); });
      case Op::whole_division: return folded(e, [](double x, double y) { return std::trunc(x / y); });
      case Op::square_root: return mapped(e, [](double x) { return std::sqrt(x); });
      case Op::exponential: return mapped(e, [](double x) { return std::exp(x); });
      case Op::natural_log: return mapped(e, [](double x) { return std::log(x); });
      case Op::decimal_log: return mapped(e, [](double x) { return std::log10(x); });
      case Op::floor: return mapped(e, [](double x) { return std::floor(x); });
      case Op::ceiling: return mapped(e, [](double x) { return std::ceil(x); });
      case Op::round: return mapped(e, [](double x) { return std::round(x); });
      case Op::sine: return mapped(e, [](double x) { return std::sin(x); });
      case Op::cosine: return mapped(e, [](double x) { return std::cos(x); });
      case Op::tangent: return mapped(e, [](double x) { return std::tan(x); });
      case Op::arc_sine: return mapped(e, [](double x) { return std::asin(x); });
      case Op::arc_cosine: return mapped(e, [](double x) { return std::acos(x); });
      case Op::arc_tangent: return mapped(e, [](double x) { return std::atan(x); });
      case Op::radians: return mapped(e, [](double x) { return x * (std::numbers::pi / 180); });
      case Op::degrees: return mapped(e, [](double x) { return x * (180 / std::numbers::pi); });
      case Op::least: return folded(e, [](double x, double y) { return std::min(x, y); });
      default: return folded(e, [](double x, double y) { return std::max(x, y); });
    }
  }

  Numbers choice(const Expression& e) const {
    const Truths when = truths(e.parts[0]);
    const Numbers then = numbers(e.parts[1]), otherwise = numbers(e.parts[2]);
    Numbers result;
    for (int i = 0; i < kTexels; ++i) result.value[i] = (when.holds >> i) & 1u ? then.value[i] : otherwise.value[i];
    result.known = when.known & ((when.holds & then.known) | (~when.holds & otherwise.known));
    return result;
  }

  template <class Function>
  Numbers mapped(const Expression& e, Function function) const {
    Numbers result = numbers(e.parts[0]);
    for (double& value : result.value) value = function(value);
    return only_finite(std::move(result));
  }

  template <class Function>
  Numbers folded(const Expression& e, Function function) const {
    Numbers result = numbers(e.parts[0]);
    for (std::size_t part = 1; part < e.parts.size(); ++part) {
      const Numbers next = numbers(e.parts[part]);
      for (int i = 0; i < kTexels; ++i) result.value[i] = function(result.value[i], next.value[i]);
      result.known &= next.known;
    }
    return only_finite(std::move(result));
  }

  // A number that is not known is 0, so that nothing that is computed from it is slow or traps.
  static Numbers only_finite(Numbers result) {
    const Bits finite = bits_where([&](int i) { return std::isfinite(result.value[i]); });
    if (finite != kAll)
      for (int i = 0; i < kTexels; ++i)
        if (((finite >> i) & 1u) == 0) result.value[i] = 0;
    result.known &= finite;
    return result;
  }

  // Validity alone costs no decoding.
  Numbers layer(const std::string& slug, bool decoded) const {
    const Source& source = sources_.at(slug);
    if (source.resolution == resolution_) return same_block(source, decoded);
    Numbers result;
    for (int i = 0; i < kTexels; ++i) {
      const int x = source.tiles.texel_under(bx_ * kBlockSize + i % kBlockSize, resolution_),
                y = source.tiles.texel_under(by_ * kBlockSize + i / kBlockSize, resolution_);
      const TileData* tile = source.tiles.of_texel(x, y);
      const int texel = (y % kTileSize) * kTileSize + x % kTileSize;
      if (tile == nullptr || !tile->valid.test(texel)) continue;
      if (decoded) result.value[i] = decode_value(source.type, tile->bits(texel));
      // A raster may have brought infinity into a float layer.
      if (!decoded || std::isfinite(result.value[i])) result.known |= Bits{1} << i;
    }
    return result;
  }

  // Of a layer that has the map's own texels.
  Numbers same_block(const Source& source, bool decoded) const {
    Numbers result;
    const TileData* tile = source.tiles.of_block(bx_, by_);
    if (tile == nullptr) return result;
    const int bx = bx_ % kBlocksPerTile, by = by_ % kBlocksPerTile;
    result.known = block_bits(tile->valid, bx, by);
    if (!decoded || result.known == 0) return result;
    const auto take = [&]<class TexelBits>(TexelBits, auto value_of) {
      for (int row = 0; row < kBlockSize; ++row) {
        const auto first = static_cast<std::size_t>((by * kBlockSize + row) * kTileSize + bx * kBlockSize);
        std::array<TexelBits, kBlockSize> bits;
        std::memcpy(bits.data(), tile->values.data() + first * sizeof(TexelBits), sizeof bits);
        for (int x = 0; x < kBlockSize; ++x)
          result.value[static_cast<std::size_t>(row * kBlockSize + x)] = value_of(bits[static_cast<std::size_t>(x)]);
      }
    };
    const double* values = values_of_bits(source.type);
    switch (source.type) {
      case ValueType::f32: take(float{}, [](float value) { return double{value}; }); break;
      case ValueType::u32: take(std::uint32_t{}, [](std::uint32_t value) { return static_cast<double>(value); }); break;
      case ValueType::i32: take(std::int32_t{}, [](std::int32_t value) { return static_cast<double>(value); }); break;
      case ValueType::u8:
      case ValueType::i8: take(std::uint8_t{}, [values](std::uint8_t bits) { return values[bits]; }); break;
      default: take(std::uint16_t{}, [values](std::uint16_t bits) { return values[bits]; }); break;
    }
    return only_finite(std::move(result));
  }

  const Sources& sources_;
  const int resolution_;
  const int bx_, by_;
};

}  // namespace

Result<TexelSelection> select_where(const Expression& condition, const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field, int threads) {
  Sources sources;
  for (const std::string& slug : layers_of(condition)) {
    const auto found = std::find_if(layers.begin(), layers.end(), [&](const auto& v) { return v.layer.slug == slug; });
    if (found == layers.end())
      return fail(
          422, "Expression not understood",
          "This model has no layer '" + slug + "'. Layers are named by their slugs; a subtraction needs spaces.",
          field);
    const Layer& layer = found->layer;
    sources.try_emplace(slug, Source{TileTable(found->snapshot.tiles, layer.resolution), layer.type, layer.resolution});
  }
  const std::size_t slots = map.block_of_slot.size();
  TexelSelection selection(slots, 0);
  constexpr std::size_t kSlotsAtOnce = 1024;
  mesh::parallel_for(threads, static_cast<int>((slots + kSlotsAtOnce - 1) / kSlotsAtOnce), [&](int part) {
    for (std::size_t slot = part * kSlotsAtOnce; slot < std::min(slots, (part + 1) * kSlotsAtOnce); ++slot) {
      const auto block = static_cast<int>(map.block_of_slot[slot]);
      if (map.surface_mask[slot] == 0) continue;
      const Block values(sources, map.resolution, block % map.blocks_per_side, block / map.blocks_per_side);
      selection[slot] = values.truths(condition).holds & map.surface_mask[slot];
    }
  });
  return selection;
}

}  // namespace strata::query
