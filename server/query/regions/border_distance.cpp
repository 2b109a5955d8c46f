#include "query/regions/border_distance.h"

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

// A texel to visit, with the nearest border that is known there.
struct Visit {
  std::uint32_t texel;
  float distance;
  glm::vec3 border;
};

class Spreading {
 public:
  Spreading(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, float limit)
      : map_(map),
        graph_(graph),
        limit_(limit * kRim),
        distances_(map.block_of_slot.size() * 64, std::numeric_limits<float>::infinity()) {}

  void start(std::uint32_t slot, const IsBorder& is_border) {
    for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t texel = slot * 64 + i;
      const auto look = [&](std::uint32_t other) {
        if (other == mesh::kNoNeighbour || !is_border(texel, other)) return;
        const glm::vec3 border = (place(texel) + place(other)) * 0.5f;
        reach(texel, border);
        reach(other, border);
      };
      look(mesh::neighbour(map_, graph_, texel, mesh::Way::right));
      look(mesh::neighbour(map_, graph_, texel, mesh::Way::upper));
      if ((graph_.has_links[slot] >> i & 1u) == 0) continue;
      for (const auto& [from, to] : graph_.links_of(texel))
        if (to < texel) look(to);
    }
  }

  // Returns false when cancelled.
  bool spread(const Progress& progress) {
    while (!next_.empty()) {
      if (progress.cancelled()) return false;
      const std::vector<Visit> round = std::exchange(next_, {});
      for (const Visit& visit : round) {
        if (visit.distance > distances_[visit.texel]) continue;  // reached again, from nearer
        mesh::for_each_neighbour(map_, graph_, visit.texel, [&](std::uint32_t beside) {
          reach(beside, visit.border);
          // Texels whose nearest border is the same may touch only at their corners.
          mesh::for_each_neighbour(map_, graph_, beside, [&](std::uint32_t other) {
            if (other != visit.texel) reach(other, visit.border);
          });
        });
      }
    }
    return true;
  }

  std::vector<float> take() && { return std::move(distances_); }

 private:
  glm::vec3 place(std::uint32_t texel) const {
    return map_.position(texel / 64, static_cast<int>(texel % 64));
  }
  void reach(std::uint32_t texel, const glm::vec3& border) {
    const float distance = glm::distance(place(texel), border);
    if (distance > limit_ || distance >= distances_[texel]) return;
    distances_[texel] = distance;
    next_.push_back({texel, distance, border});
  }

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const float limit_;
  std::vector<float> distances_;
  std::vector<Visit> next_;
};

}  // namespace

Result<std::vector<float>> border_distances(const mesh::SurfaceMap& map,
                                            const mesh::TexelGraph& graph,
                                            const IsBorder& is_border, float limit,
                                            const Progress& progress) {
  Spreading spreading(map, graph, limit);
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    if (slot % 4096 == 0 && progress.cancelled()) return cancelled_problem();
    spreading.start(slot, is_border);
  }
  if (!spreading.spread(progress)) return cancelled_problem();
  return std::move(spreading).take();
}

}  // namespace strata::query
