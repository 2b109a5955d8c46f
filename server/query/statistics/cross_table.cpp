#include "query/statistics/cross_table.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

#include "core/compensated_sum.h"
#include "domain/people/question.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/tile_table.h"

namespace strata::query {
namespace {

constexpr std::uint64_t kNone = std::uint64_t{1} << 32;  // greater than the bits of any value

struct Sum {
  std::uint64_t texels = 0;
  CompensatedSum area;
};

// The values of one layer at the texels of a map.
class Values {
 public:
  Values(const LayerView& view, int map_resolution)
      : table_(view.snapshot.tiles, view.layer.resolution), map_resolution_(map_resolution) {}
  std::uint64_t at(int x, int y) const {
    x = table_.texel_under(x, map_resolution_);
    y = table_.texel_under(y, map_resolution_);
    const TileData* tile = table_.of_texel(x, y);
    const int texel = y % kTileSize * kTileSize + x % kTileSize;
    return tile && tile->valid.test(texel) ? tile->bits(texel) : kNone;
  }

 private:
  const TileTable table_;
  const int map_resolution_;
};

// The sorted values of one side of the table, and their indices.
class Side {
 public:
  Side(ValueType type, std::vector<std::uint64_t> all) : type_(type), bits_(std::move(all)) {
    std::ranges::sort(bits_, [this](std::uint64_t a, std::uint64_t b) {
      return a == kNone || b == kNone ? b == kNone && a != kNone : value(a) < value(b);
    });
    bits_.erase(std::ranges::unique(bits_).begin(), bits_.end());
    for (std::size_t i = 0; i < bits_.size(); ++i) place_[bits_[i]] = i;
  }
  std::size_t size() const { return bits_.size(); }
  std::size_t place(std::uint64_t bits) const { return place_.at(bits); }
  std::vector<CrossTable::Key> keys() const {
    std::vector<CrossTable::Key> keys;
    for (const auto bits : bits_)
      keys.push_back(bits == kNone ? CrossTable::Key() : CrossTable::Key(value(bits)));
    return keys;
  }

 private:
  double value(std::uint64_t bits) const {
    return decode_value(type_, static_cast<std::uint32_t>(bits));
  }
  const ValueType type_;
  std::vector<std::uint64_t> bits_;
  std::unordered_map<std::uint64_t, std::size_t> place_;
};

struct PairHash {
  std::size_t operator()(const std::pair<std::uint64_t, std::uint64_t>& pair) const {
    return std::hash<std::uint64_t>()(pair.first * 0x9e3779b97f4a7c15u ^ pair.second);
  }
};

}  // namespace

Result<CrossTable> cross_tabulate(const LayerView& rows, const LayerView& columns,
                                  const mesh::SurfaceMap& map, const TexelSelection* within,
                                  double metres_per_unit) {
  for (const auto& [view, field] : {std::pair{&rows, "rows"}, std::pair{&columns, "columns"}})
    if (is_float(view->layer.type))
      return fail(ErrorCode::invalid, "Layer contains fractions",
                  "'" + view->layer.slug +
                      "' contains fractions. A cross table requires whole numbers or keys.",
                  field);
  const auto too_many = [](const LayerView& view, const char* field) {
    return fail(ErrorCode::invalid, "Too many values",
                "'" + view.layer.slug + "' has more than " + std::to_string(kMaxCrossTableSide) +
                    " different values here. Choose a smaller part of the surface.",
                field);
  };
  const Values row_values(rows, map.resolution), column_values(columns, map.resolution);
  std::unordered_map<std::pair<std::uint64_t, std::uint64_t>, Sum, PairHash> sums;
  std::unordered_map<std::uint64_t, int> row_bits, column_bits;
  CompensatedSum neither;
  std::pair<std::uint64_t, std::uint64_t> last{kNone, kNone};
  Sum* last_sum = nullptr;  // neighbors mostly share both values; references stay valid
  const QuestionTurn turn;
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    if (slot % 256 == 0) turn.check(256 * kBlockSize * kBlockSize);
    const auto block = static_cast<int>(map.block_of_slot[slot]);
    const int x0 = block % map.blocks_per_side * kBlockSize,
              y0 = block / map.blocks_per_side * kBlockSize;
    std::uint64_t rest = map.surface_mask[slot];
    if (within) rest &= (*within)[slot];
    for (; rest != 0; rest &= rest - 1) {
      const int texel = std::countr_zero(rest);
      const int x = x0 + texel % kBlockSize, y = y0 + texel / kBlockSize;
      const std::pair pair{row_values.at(x, y), column_values.at(x, y)};
      const double area = map.area[std::size_t{slot} * 64 + static_cast<std::size_t>(texel)];
      if (pair.first == kNone && pair.second == kNone) {
        neither += area;
        continue;
      }
      if (!last_sum || pair != last) {
        last_sum = &sums[pair];
        last = pair;
        if (row_bits.try_emplace(pair.first).second && row_bits.size() > kMaxCrossTableSide)
          return too_many(rows, "rows");
        if (column_bits.try_emplace(pair.second).second && column_bits.size() > kMaxCrossTableSide)
          return too_many(columns, "columns");
      }
      ++last_sum->texels;
      last_sum->area += area;
    }
  }
  const auto keys_of = [](const auto& bits) {
    std::vector<std::uint64_t> keys;
    for (const auto& [key, unused] : bits) keys.push_back(key);
    return keys;
  };
  const Side row_side(rows.layer.type, keys_of(row_bits)),
      column_side(columns.layer.type, keys_of(column_bits));
  CrossTable table;
  table.rows = row_side.keys();
  table.columns = column_side.keys();
  table.area_m2.assign(row_side.size(), std::vector<double>(column_side.size(), 0.0));
  table.texels.assign(row_side.size(), std::vector<std::uint64_t>(column_side.size(), 0));
  const double m2_per_unit2 = metres_per_unit * metres_per_unit;
  table.neither_m2 = neither.value() * m2_per_unit2;
  for (const auto& [pair, sum] : sums) {
    const std::size_t row = row_side.place(pair.first), column = column_side.place(pair.second);
    table.area_m2[row][column] = sum.area.value() * m2_per_unit2;
    table.texels[row][column] = sum.texels;
  }
  return table;
}

}  // namespace strata::query
