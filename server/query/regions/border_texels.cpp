#include "query/regions/border_texels.h"

#include <bit>
#include <glm/glm.hpp>
#include <limits>
#include <utility>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {
namespace {

// Texels whose distance equals the limit are within it, in spite of rounding errors.
constexpr float kRim = 1 + 1e-4f;

class Spreading {
 public:
  Spreading(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, float limit)
      : map_(map),
        graph_(graph),
        limit_(limit * kRim),
        distance_(map.block_of_slot.size() * 64, std::numeric_limits<float>::infinity()),
        nearest_(distance_.size(), mesh::kNoNeighbour),
        is_next_(map.block_of_slot.size(), 0) {}

  void start(std::uint32_t texel) { reach(texel, texel); }

  // Returns false when cancelled.
  bool spread(const Progress& progress) {
    while (!next_.empty()) {
      const std::vector<std::uint32_t> round = std::exchange(next_, {});
      for (const std::uint32_t texel : round) is_next_[texel / 64] &= ~bit_of(texel);
      for (std::size_t i = 0; i < round.size(); ++i) {
        if (i % 65536 == 0 && progress.cancelled()) return false;
        spread_from(round[i]);
      }
    }
    return true;
  }

  std::uint64_t reached_in(std::uint32_t slot) const {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 64; ++i)
      bits |= std::uint64_t{nearest_[slot * 64 + i] != mesh::kNoNeighbour} << i;
    return bits;
  }

 private:
  static std::uint64_t bit_of(std::uint32_t texel) { return std::uint64_t{1} << texel % 64; }
  glm::vec3 place(std::uint32_t texel) const {
    return map_.position(texel / 64, static_cast<int>(texel % 64));
  }
  void spread_from(std::uint32_t texel) {
    const std::uint32_t nearest = nearest_[texel];
    mesh::for_each_neighbour(map_, graph_, texel, [&](std::uint32_t beside) {
      reach(beside, nearest);
      // Texels with the same nearest texel may touch only at their corners.
      mesh::for_each_neighbour(map_, graph_, beside, [&](std::uint32_t other) {
        if (other != texel) reach(other, nearest);
      });
    });
  }
  void reach(std::uint32_t texel, std::uint32_t nearest) {
    if (nearest_[texel] == nearest) return;
    const float distance = glm::distance(place(texel), place(nearest));
    if (distance > limit_ || distance >= distance_[texel]) return;
    distance_[texel] = distance;
    nearest_[texel] = nearest;
    if ((is_next_[texel / 64] & bit_of(texel)) != 0) return;
    is_next_[texel / 64] |= bit_of(texel);
    next_.push_back(texel);
  }

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const float limit_;
  std::vector<float> distance_;
  std::vector<std::uint32_t> nearest_;  // by texel: the texel at a border
  std::vector<std::uint64_t> is_next_;
  std::vector<std::uint32_t> next_;
};

}  // namespace

Result<std::vector<std::uint64_t>> texels_at_borders(const mesh::SurfaceMap& map,
                                                     const mesh::TexelGraph& graph,
                                                     const IsBorder& is_border,
                                                     const Progress& progress) {
  std::vector<std::uint64_t> at_border(map.block_of_slot.size(), 0);
  const auto add = [&](std::uint32_t texel) {
    at_border[texel / 64] |= std::uint64_t{1} << texel % 64;
  };
  for (std::uint32_t slot = 0; slot < at_border.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t texel = slot * 64 + i;
      const auto look = [&](std::uint32_t other) {
        if (other == mesh::kNoNeighbour || !is_border(texel, other)) return;
        add(texel);
        add(other);
      };
      look(mesh::neighbour(map, graph, texel, mesh::Way::right));
      look(mesh::neighbour(map, graph, texel, mesh::Way::upper));
      if ((graph.has_links[slot] >> i & 1u) == 0) continue;
      for (const auto& [from, to] : graph.links_of(texel))
        if (to < texel) look(to);
    }
  }
  return at_border;
}

Result<std::vector<std::uint64_t>> texels_near_borders(const mesh::SurfaceMap& map,
                                                       const mesh::TexelGraph& graph,
                                                       const std::vector<std::uint64_t>& at_border,
                                                       float limit, const Progress& progress) {
  Spreading spreading(map, graph, limit);
  for (std::uint32_t slot = 0; slot < at_border.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    for (std::uint64_t left = at_border[slot]; left != 0; left &= left - 1)
      spreading.start(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
  }
  if (!spreading.spread(progress)) return cancelled_problem();
  std::vector<std::uint64_t> near(at_border.size());
  for (std::uint32_t slot = 0; slot < near.size(); ++slot) near[slot] = spreading.reached_in(slot);
  return near;
}

}  // namespace strata::query
