#include "query/regions/thinning.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/touching_texels.h"

namespace strata::query {
namespace {

// A set of the texels of a map.
class TexelBits {
 public:
  explicit TexelBits(std::size_t texels) : words_((texels + 63) / 64) {}
  bool has(std::uint32_t texel) const { return (words_[texel / 64] >> texel % 64 & 1u) != 0; }
  void add(std::uint32_t texel) { words_[texel / 64] |= std::uint64_t{1} << texel % 64; }
  void remove(std::uint32_t texel) { words_[texel / 64] &= ~(std::uint64_t{1} << texel % 64); }

 private:
  std::vector<std::uint64_t> words_;
};

class Thinning {
 public:
  Thinning(const Pieces& pieces, const mesh::SurfaceDistances& depths, const mesh::SurfaceMap& map,
           const mesh::TexelGraph& graph)
      : pieces_(pieces),
        depths_(depths),
        map_(map),
        graph_(graph),
        left_(pieces.of_texel.size()),
        queued_(pieces.of_texel.size()) {}

  Result<std::vector<std::uint32_t>> run(Progress& progress) {
    for_each_texel([&](std::uint32_t texel) { left_.add(texel); });
    for (const Keep keep : {Keep::centers, Keep::ends})
      if (!take_away(keep, progress)) return cancelled_problem();
    std::vector<std::uint32_t> lines;
    for_each_texel([&](std::uint32_t texel) {
      if (left_.has(texel)) lines.push_back(texel);
    });
    return lines;
  }

 private:
  using Queued = std::pair<float, std::uint32_t>;
  // The first pass keeps the centers of discs that fill the piece. They are a texel or two wide.
  // The second pass makes them a texel wide. It keeps ends, which in the first pass would also be
  // found at the steps of a border.
  enum class Keep { centers, ends };

  // Takes away texels from the border inwards. Returns false when cancelled.
  bool take_away(Keep keep, Progress& progress) {
    std::size_t looked_at = 0;
    for_each_texel([&](std::uint32_t texel) {
      if (left_.has(texel) && is_at_border(texel)) queue(texel);
    });
    while (!open_.empty()) {
      if (looked_at++ % 4096 == 0) {
        if (progress.cancelled()) return false;
        progress.report(keep == Keep::centers ? 0.5 : 0.9, "Finding center lines");
      }
      const std::uint32_t texel = open_.top().second;
      open_.pop();
      queued_.remove(texel);
      if (!can_go(texel, keep)) continue;
      left_.remove(texel);
      for (const std::uint32_t other : around_) queue(other);
    }
    return true;
  }

  template <class Visit>
  void for_each_texel(Visit&& visit) const {
    for (std::uint32_t texel = 0; texel < pieces_.of_texel.size(); ++texel)
      if (pieces_.of_texel[texel] != kNoRegion) visit(texel);
  }
  void queue(std::uint32_t texel) {
    if (queued_.has(texel)) return;
    queued_.add(texel);
    open_.emplace(depths_.at(texel), texel);
  }
  bool is_left(std::uint32_t texel, std::uint32_t piece) const {
    return pieces_.of_texel[texel] == piece && left_.has(texel);
  }

  bool is_at_border(std::uint32_t texel) const {
    if ((graph_.at_open_edge[texel / 64] >> texel % 64 & 1u) != 0) return true;
    bool found = false;
    mesh::for_each_neighbour(map_, graph_, texel, [&](std::uint32_t other) {
      found = found || !is_left(other, pieces_.of_texel[texel]);
    });
    return found;
  }
  bool share_side(std::uint32_t a, std::uint32_t b) const {
    bool found = false;
    mesh::for_each_neighbour(map_, graph_, a,
                             [&](std::uint32_t other) { found = found || other == b; });
    return found;
  }

  // Returns whether no disc around a texel next to this one contains the disc around this one.
  bool is_center(std::uint32_t texel) const {
    // The depth grows by 1 from straight borders, and by 0.7 from a right angle.
    constexpr float kGrowth = 0.6f;
    const glm::vec3 at = place(texel);
    const float depth = depths_.at(texel);
    bool found = false;
    for_each_touching(map_, graph_, texel, [&](std::uint32_t other) {
      found = found || (pieces_.of_texel[other] == pieces_.of_texel[texel] &&
                        depths_.at(other) > depth + kGrowth * glm::distance(at, place(other)));
    });
    return !found;
  }
  glm::vec3 place(std::uint32_t texel) const {
    return map_.position(texel / 64, static_cast<int>(texel % 64));
  }

  // Returns whether the piece stays connected, and what is kept stays, without the texel. Sets
  // `around_` to the texels that are left around it.
  bool can_go(std::uint32_t texel, Keep keep) {
    const std::uint32_t piece = pieces_.of_texel[texel];
    around_.clear();
    for_each_touching(map_, graph_, texel, [&](std::uint32_t other) {
      if (is_left(other, piece) && std::ranges::find(around_, other) == around_.end())
        around_.push_back(other);
    });
    if (around_.empty() || !is_at_border(texel) || !are_connected()) return false;
    if (keep == Keep::centers) return !is_center(texel);
    // The end of a line of one or two texels.
    return around_.size() > 2 || (around_.size() == 2 && !share_side(around_[0], around_[1]));
  }

  // Returns whether the texels of `around_` are connected to each other.
  bool are_connected() {
    unseen_ = around_;
    seen_.assign(1, unseen_.back());
    unseen_.pop_back();
    for (std::size_t next = 0; next < seen_.size() && !unseen_.empty(); ++next)
      for_each_touching(map_, graph_, seen_[next], [&](std::uint32_t other) {
        const auto found = std::ranges::find(unseen_, other);
        if (found == unseen_.end()) return;
        unseen_.erase(found);
        seen_.push_back(other);
      });
    return unseen_.empty();
  }

  const Pieces& pieces_;
  const mesh::SurfaceDistances& depths_;
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  TexelBits left_, queued_;
  std::priority_queue<Queued, std::vector<Queued>, std::greater<>> open_;
  std::vector<std::uint32_t> around_, seen_, unseen_;
};

}  // namespace

Result<std::vector<std::uint32_t>> thin_pieces(const Pieces& pieces,
                                               const mesh::SurfaceDistances& depths,
                                               const mesh::SurfaceMap& map,
                                               const mesh::TexelGraph& graph, Progress& progress) {
  return Thinning(pieces, depths, map, graph).run(progress);
}

}  // namespace strata::query
