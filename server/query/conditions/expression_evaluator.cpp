#include "query/conditions/expression_evaluator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

#include "domain/people/question.h"
#include "expression/operators.h"
#include "mesh/parallel.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/evaluation_plan.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

using Op = Expression::Op;
using Bits = std::uint64_t;  // one bit per texel of a block

constexpr int kTexels = kBlockSize * kBlockSize;
constexpr Bits kAll = ~Bits{0};

template <class Test>
Bits bits_where(Test test) {
  Bits bits = 0;
  for (int i = 0; i < kTexels; ++i) bits |= Bits{test(i)} << i;
  return bits;
}

// The values of an expression at the 64 texels of a block.
struct Numbers {
  std::array<double, kTexels> value{};  // finite where known
  Bits known = 0;
};
struct Truths {
  Bits holds = 0;  // a subset of `known`
  Bits known = 0;
};

// The inputs of a formula; constant during the evaluation.
struct Inputs {
  const std::vector<PlanSource>& sources;
  const std::vector<RecordNumbers>& records;
  const mesh::SurfaceMap& map;
  const Frame& frame;
};

// The decoded values of layers, kept so that a block decodes each layer only once.
class Decoded {
 public:
  explicit Decoded(std::size_t sources) : of_source_(sources) {}
  void clear() {
    for (Entry& entry : of_source_) entry.is_here = false;
  }
  template <class Make>
  const Numbers& get(int source, Make make) {
    Entry& entry = of_source_[static_cast<std::size_t>(source)];
    if (!entry.is_here) entry.numbers = make();
    entry.is_here = true;
    return entry.numbers;
  }

 private:
  struct Entry {
    bool is_here = false;
    Numbers numbers;
  };
  std::vector<Entry> of_source_;
};

class Block {
 public:
  Block(const Inputs& inputs, std::uint32_t slot, Decoded& decoded)
      : inputs_(inputs),
        decoded_(decoded),
        slot_(slot),
        bx_(static_cast<int>(inputs.map.block_of_slot[slot]) % inputs.map.blocks_per_side),
        by_(static_cast<int>(inputs.map.block_of_slot[slot]) / inputs.map.blocks_per_side) {
    decoded_.clear();
  }
  // Makes a block that is not part of the map. The values of its only source are the
  // 64 successive bit patterns from `first` on. If `first` is empty, the source has no values.
  Block(const Inputs& inputs, std::optional<std::uint32_t> first, Decoded& decoded)
      : inputs_(inputs),
        decoded_(decoded),
        slot_(0),
        bx_(0),
        by_(0),
        is_pattern_(true),
        first_pattern_(first) {
    decoded_.clear();
  }

  Truths truths(const PlanNode& e) const {
    if (e.table) return by_table(e);
    const auto part = [&](std::size_t i) { return truths(e.parts[i]); };
    switch (e.op) {
      case Op::truth: return {e.number != 0 ? kAll : 0, kAll};
      case Op::valid: return {validity(e.source), kAll};
      case Op::known: return {numbers(e.parts[0]).known, kAll};
      case Op::record_truth: {
        const Numbers answer = of_records(e);
        return {bits_where([&](int i) { return answer.value[i] != 0; }) & answer.known,
                answer.known};
      }
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

  // Returns the numbers of an expression. The number of a condition is 1 where it is true, and
  // unknown elsewhere.
  Numbers any(const PlanNode& e) const {
    if (!e.is_condition()) return numbers(e);
    Numbers result;
    result.value.fill(1);
    result.known = truths(e).holds;
    return result;
  }

  Numbers numbers(const PlanNode& e) const {
    switch (e.op) {
      case Op::number: {
        Numbers constant;
        const bool known = std::isfinite(e.number);
        constant.value.fill(known ? e.number : 0);
        constant.known = known ? kAll : 0;
        return constant;
      }
      case Op::layer: return layer(e.source);
      case Op::record_number: return of_records(e);
      case Op::choose: return choice(e);
      case Op::x:
      case Op::y:
      case Op::z: return coordinate(static_cast<int>(e.op) - static_cast<int>(Op::x));
      case Op::area: return texel_area();
      default: return computed(e);
    }
  }

 private:
  Truths comparison(const PlanNode& e) const {
    if (e.set) return among(e);
    const Numbers a = numbers(e.parts[0]);
    const PlanNode& right = e.parts[1];
    const Operator& row = *find_operator(e.op);
    if (right.op == Op::number && std::isfinite(right.number))
      return {row.compare_with(a.value, right.number) & a.known, a.known};
    const Numbers b = numbers(right);
    const Bits known = a.known & b.known;
    return {row.compare(a.value, b.value) & known, known};
  }

  Truths among(const PlanNode& e) const {
    const Numbers a = numbers(e.parts[0]);
    Bits holds = 0;
    double last = std::numeric_limits<double>::quiet_NaN();
    bool found = false;
    for (Bits rest = a.known; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      const double value = a.value[static_cast<std::size_t>(i)];
      if (value != last) {  // neighboring texels mostly have the same value
        last = value;
        found = e.set->contains(value);
      }
      holds |= Bits{found} << i;
    }
    return {holds, a.known};
  }

  Truths by_table(const PlanNode& e) const {
    const PlanSource& source = inputs_.sources[static_cast<std::size_t>(e.source)];
    const TruthTable& table = *e.table;
    Truths result;
    const auto put = [&](int i, Bits truth) {
      result.holds |= (truth & 1u) << i;
      result.known |= (truth >> 1u) << i;
    };
    if (source.resolution != inputs_.map.resolution) {
      for_each_under(source, [&](int i, const TileData* tile, int texel) {
        const bool has_value = tile != nullptr && tile->valid.test(texel);
        put(i, has_value ? table.of_bits[tile->bits(texel)] : table.of_nothing);
      });
      return result;
    }
    const TileData* tile = source.tiles.of_block(bx_, by_);
    const int bx = bx_ % kBlocksPerTile, by = by_ % kBlocksPerTile;
    const Bits valid = tile == nullptr ? 0 : block_bits(tile->valid, bx, by);
    if (valid != kAll) {
      if (table.of_nothing & 1u) result.holds = ~valid;
      if (table.of_nothing & 2u) result.known = ~valid;
    }
    if (valid == 0) return result;
    const auto take = [&]<class TexelBits>(TexelBits) {
      for (int row = 0; row < kBlockSize; ++row) {
        const std::size_t first =
            (static_cast<std::size_t>(by) * kBlockSize + static_cast<std::size_t>(row)) *
                kTileSize +
            static_cast<std::size_t>(bx) * kBlockSize;
        std::array<TexelBits, kBlockSize> bits;
        std::memcpy(bits.data(), tile->values.data() + first * sizeof(TexelBits), sizeof bits);
        Bits holds = 0, known = 0;
        for (int x = 0; x < kBlockSize; ++x) {
          const Bits truth = table.of_bits[bits[static_cast<std::size_t>(x)]];
          holds |= (truth & 1u) << x;
          known |= (truth >> 1u) << x;
        }
        const Bits in_row = valid >> (row * kBlockSize) & 0xffu;
        result.holds |= (holds & in_row) << (row * kBlockSize);
        result.known |= (known & in_row) << (row * kBlockSize);
      }
    };
    if (bytes_per_texel(source.type) == 1)
      take(std::uint8_t{});
    else
      take(std::uint16_t{});
    return result;
  }

  Numbers choice(const PlanNode& e) const {
    const Truths when = truths(e.parts[0]);
    const Numbers then = numbers(e.parts[1]), otherwise = numbers(e.parts[2]);
    Numbers result;
    for (int i = 0; i < kTexels; ++i)
      result.value[i] = (when.holds >> i) & 1u ? then.value[i] : otherwise.value[i];
    result.known = when.known & ((when.holds & then.known) | (~when.holds & otherwise.known));
    return result;
  }

  Numbers computed(const PlanNode& e) const {
    const Operator& row = *find_operator(e.op);
    Numbers result = numbers(e.parts[0]);
    if (e.parts.size() == 1) row.apply(result.value, {});
    for (std::size_t part = 1; part < e.parts.size(); ++part) {
      const Numbers next = numbers(e.parts[part]);
      row.apply(result.value, next.value);
      result.known &= next.known;
    }
    return only_finite(std::move(result));
  }

  // Replaces unknown numbers by 0, so that computations with them are not slow and do not trap.
  static Numbers only_finite(Numbers result) {
    const Bits finite = bits_where([&](int i) { return std::isfinite(result.value[i]); });
    if (finite != kAll)
      for (int i = 0; i < kTexels; ++i)
        if (((finite >> i) & 1u) == 0) result.value[i] = 0;
    result.known &= finite;
    return result;
  }

  Numbers coordinate(int axis) const {
    Numbers result;
    for (std::uint64_t rest = inputs_.map.surface_mask[slot_]; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest);
      result.value[static_cast<std::size_t>(texel)] =
          inputs_.frame.origin[axis] + double{inputs_.map.position(slot_, texel)[axis]};
    }
    result.known = inputs_.map.surface_mask[slot_];
    return result;
  }

  Numbers texel_area() const {
    Numbers result;
    const double m2 = inputs_.frame.metres * inputs_.frame.metres;
    for (std::size_t i = 0; i < kTexels; ++i)
      result.value[i] = m2 * inputs_.map.area[std::size_t{slot_} * kTexels + i];
    result.known = inputs_.map.surface_mask[slot_];
    return result;
  }

  // Looks up the numbers of the records whose keys the layer stores.
  Numbers of_records(const PlanNode& e) const {
    const RecordNumbers& records = inputs_.records[e.index];
    Numbers result = layer(e.source);
    // neighboring texels mostly have the same key
    double last = -1, found = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < kTexels; ++i) {
      if (((result.known >> i) & 1u) == 0) continue;
      if (result.value[i] != last) {
        last = result.value[i];
        constexpr double kMaxRecordKey = std::numeric_limits<std::uint32_t>::max();
        found = last >= 0 && last <= kMaxRecordKey ? records.of(static_cast<std::uint32_t>(last))
                                                   : std::numeric_limits<double>::quiet_NaN();
      }
      result.value[i] = found;
    }
    return only_finite(std::move(result));
  }

  const Numbers& layer(int number) const {
    return decoded_.get(
        number, [&] { return decode(inputs_.sources[static_cast<std::size_t>(number)], true); });
  }
  // Returns the texels where the layer has a value, without decoding the layer.
  Bits validity(int number) const {
    return decode(inputs_.sources[static_cast<std::size_t>(number)], false).known;
  }

  Numbers decode(const PlanSource& source, bool decoded) const {
    if (is_pattern_) return pattern(source, decoded);
    if (source.resolution == inputs_.map.resolution) return same_block(source, decoded);
    Numbers result;
    for_each_under(source, [&](int i, const TileData* tile, int texel) {
      if (tile == nullptr || !tile->valid.test(texel)) return;
      const auto place = static_cast<std::size_t>(i);
      if (decoded) result.value[place] = decode_value(source.type, tile->bits(texel));
      // A float layer from an imported raster may contain infinity.
      if (!decoded || std::isfinite(result.value[place])) result.known |= Bits{1} << i;
    });
    return decoded ? only_finite(std::move(result)) : result;
  }

  // Calls visit(texel of the block, tile or null, texel in the tile) for each texel of the block.
  // The tile and its texel belong to a layer with another resolution.
  template <class Visit>
  void for_each_under(const PlanSource& source, Visit visit) const {
    for (int i = 0; i < kTexels; ++i) {
      const int x = source.tiles.texel_under(bx_ * kBlockSize + i % kBlockSize,
                                             inputs_.map.resolution),
                y = source.tiles.texel_under(by_ * kBlockSize + i / kBlockSize,
                                             inputs_.map.resolution);
      visit(i, source.tiles.of_texel(x, y), (y % kTileSize) * kTileSize + x % kTileSize);
    }
  }

  Numbers pattern(const PlanSource& source, bool decoded) const {
    Numbers result;
    if (!first_pattern_) return result;
    result.known = kAll;
    if (!decoded) return result;
    const double* values = values_of_bits(source.type);
    for (std::size_t i = 0; i < kTexels; ++i) result.value[i] = values[*first_pattern_ + i];
    return only_finite(std::move(result));
  }

  // Reads the block of a layer with the resolution of the map.
  Numbers same_block(const PlanSource& source, bool decoded) const {
    Numbers result;
    const TileData* tile = source.tiles.of_block(bx_, by_);
    if (tile == nullptr) return result;
    const int bx = bx_ % kBlocksPerTile, by = by_ % kBlocksPerTile;
    result.known = block_bits(tile->valid, bx, by);
    if (!decoded || result.known == 0) return result;
    const auto take = [&]<class TexelBits>(TexelBits, auto value_of) {
      for (int row = 0; row < kBlockSize; ++row) {
        const std::size_t first =
            (static_cast<std::size_t>(by) * kBlockSize + static_cast<std::size_t>(row)) *
                kTileSize +
            static_cast<std::size_t>(bx) * kBlockSize;
        std::array<TexelBits, kBlockSize> bits;
        std::memcpy(bits.data(), tile->values.data() + first * sizeof(TexelBits), sizeof bits);
        for (int x = 0; x < kBlockSize; ++x)
          result.value[static_cast<std::size_t>(row) * kBlockSize + static_cast<std::size_t>(x)] =
              value_of(bits[static_cast<std::size_t>(x)]);
      }
    };
    const double* values = values_of_bits(source.type);
    switch (source.type) {
      case ValueType::f32: take(float{}, [](float value) { return double{value}; }); break;
      case ValueType::u32:
        take(std::uint32_t{}, [](std::uint32_t value) { return static_cast<double>(value); });
        break;
      case ValueType::i32:
        take(std::int32_t{}, [](std::int32_t value) { return static_cast<double>(value); });
        break;
      case ValueType::u8:
      case ValueType::i8:
        take(std::uint8_t{}, [values](std::uint8_t bits) { return values[bits]; });
        break;
      default: take(std::uint16_t{}, [values](std::uint16_t bits) { return values[bits]; }); break;
    }
    return only_finite(std::move(result));
  }

  const Inputs& inputs_;
  Decoded& decoded_;
  const std::uint32_t slot_;
  const int bx_, by_;
  const bool is_pattern_ = false;
  const std::optional<std::uint32_t> first_pattern_{};
};

// A block takes a few microseconds, or some hundred microseconds for a long condition.
constexpr std::size_t kBlocksBetweenChecks = 64;

void spend(std::uint64_t steps) {
  if (Question* question = Question::current()) question->spend(steps);
}

// A condition with fewer steps is as fast as its table.
constexpr std::uint64_t kMinSteps = 3;

TruthTable table_of(const PlanNode& condition, const Inputs& inputs) {
  const ValueType type = inputs.sources[static_cast<std::size_t>(condition.source)].type;
  Decoded decoded(inputs.sources.size());
  const auto truth_of = [](const Truths& truths, int i) {
    return static_cast<std::uint8_t>((truths.holds >> i & 1u) | (truths.known >> i & 1u) << 1u);
  };
  TruthTable table;
  table.of_bits.resize(std::size_t{1} << (8 * bytes_per_texel(type)));
  for (std::uint32_t first = 0; first < table.of_bits.size(); first += kTexels) {
    const Truths truths = Block(inputs, std::optional(first), decoded).truths(condition);
    for (int i = 0; i < kTexels; ++i)
      table.of_bits[first + static_cast<std::uint32_t>(i)] = truth_of(truths, i);
  }
  table.of_nothing =
      truth_of(Block(inputs, std::optional<std::uint32_t>(), decoded).truths(condition), 0);
  return table;
}

// Replaces the largest suitable conditions by tables, if the map has enough texels.
void make_tables(PlanNode& node, const Inputs& inputs) {
  if (node.is_condition() && steps_of(node) >= kMinSteps) {
    const int source = only_source(node);
    const int bytes =
        source < 0 ? 4 : bytes_per_texel(inputs.sources[static_cast<std::size_t>(source)].type);
    const std::size_t blocks = (std::size_t{1} << (8 * bytes)) / kTexels;
    if (bytes <= 2 && inputs.map.block_of_slot.size() >= 2 * blocks) {
      PlanNode looked_up;
      looked_up.op = node.op;
      node.source = source;
      looked_up.source = source;
      looked_up.table = std::make_shared<const TruthTable>(table_of(node, inputs));
      node = std::move(looked_up);
      return;
    }
  }
  for (PlanNode& part : node.parts) make_tables(part, inputs);
}

// Writes the numbers of one block to its tile. Returns the bits of the texels whose numbers do not
// fit the type.
Bits write_block(const Numbers& numbers, Bits mask, ValueType type, int block_x, int block_y,
                 TileData& tile) {
  Bits unfit = 0;
  for (Bits rest = numbers.known & mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const double number = numbers.value[static_cast<std::size_t>(i)];
    const auto bits = encode_value(type, is_float(type) ? number : std::round(number));
    const int x = block_x % kBlocksPerTile * kBlockSize + i % kBlockSize,
              y = block_y % kBlocksPerTile * kBlockSize + i / kBlockSize;
    if (bits)
      tile.write(y * kTileSize + x, *bits);
    else
      unfit |= Bits{1} << i;
  }
  return unfit;
}

}  // namespace

Result<TexelSelection> select_where(const BoundExpression& condition,
                                    const std::vector<LayerView>& layers,
                                    const mesh::SurfaceMap& map, const std::string& field,
                                    int threads, const Frame& frame, const TexelSelection* within) {
  auto plan = STRATA_TRY(plan_evaluation(condition.expression, layers, field));
  const Inputs inputs{plan.sources, condition.records, map, frame};
  make_tables(plan.root, inputs);
  const std::size_t slots = map.block_of_slot.size();
  const auto candidates = [&](std::size_t slot) {
    return within ? map.surface_mask[slot] & (*within)[slot] : map.surface_mask[slot];
  };
  std::size_t blocks = 0;
  for (std::size_t slot = 0; slot < slots; ++slot) blocks += candidates(slot) != 0;
  const std::uint64_t steps = steps_of(plan.root) * kTexels;
  spend(steps * blocks);
  TexelSelection selection(slots, 0);
  constexpr std::size_t kSlotsAtOnce = 1024;
  mesh::parallel_for(
      threads, static_cast<int>((slots + kSlotsAtOnce - 1) / kSlotsAtOnce), [&](int part) {
        Decoded decoded(plan.sources.size());
        const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce;
        const QuestionTurn turn;
        std::size_t done = 0;
        for (std::size_t slot = first; slot < std::min(slots, first + kSlotsAtOnce); ++slot) {
          if (candidates(slot) == 0) continue;
          if (++done % kBlocksBetweenChecks == 0) turn.check(steps * kBlocksBetweenChecks);
          const Block block(inputs, static_cast<std::uint32_t>(slot), decoded);
          selection[slot] = block.truths(plan.root).holds & candidates(slot);
        }
      });
  return selection;
}

Result<TileMap> compute_tiles(const BoundExpression& expression,
                              const std::vector<LayerView>& layers, const mesh::SurfaceMap& map,
                              const Frame& frame, ValueType type, const std::string& field,
                              int threads) {
  auto plan = STRATA_TRY(plan_evaluation(expression.expression, layers, field));
  const Inputs inputs{plan.sources, expression.records, map, frame};
  make_tables(plan.root, inputs);
  std::size_t blocks = 0;
  for (const std::uint64_t mask : map.surface_mask) blocks += mask != 0;
  spend(steps_of(plan.root) * kTexels * blocks);
  const int tiles_per_side = map.resolution / kTileSize;
  std::vector<std::shared_ptr<TileData>> tiles(static_cast<std::size_t>(tiles_per_side) *
                                               static_cast<std::size_t>(tiles_per_side));
  std::atomic<bool> fits = true;
  std::mutex mutex;
  double unfit = 0;
  mesh::parallel_for(threads, static_cast<int>(tiles.size()), [&](int number) {
    auto tile = std::make_shared<TileData>(type);
    Decoded decoded(plan.sources.size());
    for (int i = 0; i < kBlocksPerTile * kBlocksPerTile && fits; ++i) {
      const int bx = number % tiles_per_side * kBlocksPerTile + i % kBlocksPerTile,
                by = number / tiles_per_side * kBlocksPerTile + i / kBlocksPerTile;
      const std::uint32_t slot = mesh::slot_at(map, bx, by);
      if (slot == mesh::kNoSlot || map.surface_mask[slot] == 0) continue;
      const Numbers numbers = Block(inputs, slot, decoded).any(plan.root);
      const Bits wrong = write_block(numbers, map.surface_mask[slot], type, bx, by, *tile);
      if (wrong == 0) continue;
      const std::lock_guard lock(mutex);
      fits = false;
      unfit = numbers.value[static_cast<std::size_t>(std::countr_zero(wrong))];
    }
    if (tile->valid.any()) tiles[static_cast<std::size_t>(number)] = std::move(tile);
  });
  if (!fits) {
    Error problem = encode_value(type, is_float(type) ? unfit : std::round(unfit)).error();
    problem.field = "type";
    return tl::unexpected(std::move(problem));
  }
  const auto tile_of = [&](std::uint32_t slot) -> std::shared_ptr<TileData>& {
    const int block = static_cast<int>(map.block_of_slot[slot]);
    return tiles[static_cast<std::size_t>(block / map.blocks_per_side / kBlocksPerTile *
                                              tiles_per_side +
                                          block % map.blocks_per_side / kBlocksPerTile)];
  };
  const auto texel_of = [&](mesh::SlotTexel place) {
    const int block = static_cast<int>(map.block_of_slot[place.slot]);
    const int x = block % map.blocks_per_side % kBlocksPerTile * kBlockSize +
                  place.texel % kBlockSize,
              y = block / map.blocks_per_side % kBlocksPerTile * kBlockSize +
                  place.texel / kBlockSize;
    return y * kTileSize + x;
  };
  mesh::for_each_gutter_texel(map, [&](mesh::SlotTexel gutter, mesh::SlotTexel owner) {
    const auto& from = tile_of(owner.slot);
    const int texel = texel_of(owner);
    if (!from || !from->valid.test(texel)) return;
    auto& to = tile_of(gutter.slot);
    if (!to) to = std::make_shared<TileData>(type);
    to->write(texel_of(gutter), from->bits(texel));
  });
  TileMap content;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (tiles[i])
      content[{static_cast<std::uint16_t>(i % static_cast<std::size_t>(tiles_per_side)),
               static_cast<std::uint16_t>(i / static_cast<std::size_t>(tiles_per_side))}] =
          std::move(tiles[i]);
  return content;
}

}  // namespace strata::query
