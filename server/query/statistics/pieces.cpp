#include "query/statistics/pieces.h"

#include <vector>

#include "domain/people/question.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_values.h"

namespace strata::query {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Sets of connected texels, as flat trees: union-find (Tarjan 1975) with path halving.
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

PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map,
                         const mesh::TexelGraph& graph, const TexelSelection* within,
                         const ValueClasses& classes) {
  const ValueType type = view.layer.type;
  const bool is_one = !classes.each && classes.limits.empty();
  const std::size_t texels = map.block_of_slot.size() * 64;
  const QuestionMemory memory(texels * sizeof(std::uint32_t) * (is_one ? 1 : 2));
  const QuestionTurn turn;
  Trees trees(texels);
  std::vector<std::uint32_t> class_of(is_one ? 0 : texels);
  for (const auto& [address, tile] : view.snapshot.tiles) {
    turn.check(kTexelsPerTile);
    for_each_value(*tile, address, type, map, within,
                   [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
                     const std::uint32_t number = slot * 64 + static_cast<std::uint32_t>(texel);
                     trees.add(number);
                     if (!is_one) class_of[number] = classes.of(bits, value);
                   });
  }
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (texel % kTexelsPerTile == 0) turn.check(kTexelsPerTile);
    if (!trees.has(texel)) continue;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (other < texel && trees.has(other) && (is_one || class_of[other] == class_of[texel]))
        trees.join(texel, other);
    });
  }
  PieceCounts counts;
  for (std::uint32_t texel = 0; texel < texels; ++texel) {
    if (!trees.has(texel) || !trees.is_root(texel)) continue;
    ++counts.all;
    ++counts.of_class[is_one ? 0 : class_of[texel]];
  }
  return counts;
}

}  // namespace strata::query
