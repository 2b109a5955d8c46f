#include "query/pieces.h"

#include <vector>

#include "query/texel_values.h"

namespace strata::query {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Which texels are connected, as trees that are kept flat (Tarjan 1975, with path halving).
class Trees {
 public:
  explicit Trees(std::size_t texels) : parent_(texels, kNone) {}
  void add(std::uint32_t texel) { parent_[texel] = texel; }
  bool has(std::uint32_t texel) const { return parent_[texel] != kNone; }
  bool is_root(std::uint32_t texel) const { return parent_[texel] == texel; }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::uint32_t root(std::uint32_t texel) {
    while (parent_[texel] != texel) texel = parent_[texel] = parent_[parent_[texel]];
    return texel;
  }
  std::vector<std::uint32_t> parent_;
};

}  // namespace

PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                         const TexelSelection* within) {
  const ValueType type = view.layer.type;
  const bool by_key = !is_float(type);
  const std::size_t texels = map.block_of_slot.size() * 64;
  Trees trees(texels);
  std::vector<std::uint32_t> bits_of(by_key ? texels : 0);
  for (const auto& [address, tile] : view.snapshot.tiles)
    for_each_value(*tile, address, type, map, within, [&](std::uint32_t slot, int texel, std::uint32_t bits, double) {
      const std::uint32_t number = slot * 64 + static_cast<std::uint32_t>(texel);
      trees.add(number);
      if (by_key) bits_of[number] = bits;
    });
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (!trees.has(texel)) continue;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (other < texel && trees.has(other) && (!by_key || bits_of[other] == bits_of[texel])) trees.join(texel, other);
    });
  }
  PieceCounts counts;
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (!trees.has(texel) || !trees.is_root(texel)) continue;
    ++counts.all;
    if (by_key) ++counts.of_key[bits_of[texel]];
  }
  return counts;
}

}  // namespace strata::query
