#include "mesh/distance/surface_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string>

#include "core/progress.h"
#include "mesh/distance/block_front.h"
#include "mesh/parallel.h"
#include "mesh/texels/slot_bits.h"

namespace strata::mesh {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr const char* kMeasuring = "Measuring distances along the surface";
constexpr std::size_t kBlocksAtOnce = 32;
// The front of a round, in texels. Wider rounds have more work for threads, but compute more blocks
// again.
constexpr double kTexelsPerRound = 12;
// Limits the memory of a round (about 0.6 KiB for each block).
constexpr std::size_t kMostBlocksOfRound = 16384;

}  // namespace

// Moves the front in rounds. The blocks of a round are computed in parallel from the distances
// before the round, so the result does not depend on the threads.
class FrontRounds {
 public:
  FrontRounds(const SurfaceMap& map, const TexelGraph& graph,
              std::span<const std::uint64_t> sources, float limit)
      : map_(map), graph_(graph), limit_(limit), key_of_slot_(map.block_of_slot.size(), kInfinity) {
    const std::size_t slots = map.block_of_slot.size();
    known_.block_of_slot_.assign(slots, kNoSlot);
    known_.sources_.resize(slots);
    for (std::size_t slot = 0; slot < slots; ++slot)
      known_.sources_[slot] = sources[slot] & map.surface_mask[slot];
    for (std::uint32_t slot = 0; slot < slots; ++slot)
      if (known_.sources_[slot] != 0) start_at(slot);
    round_width_ = map.surface_texels == 0
                       ? 0
                       : static_cast<float>(kTexelsPerRound *
                                            std::sqrt(map.area_total / double(map.surface_texels)));
  }

  Result<SurfaceDistances> run(Progress& progress, int threads) {
    while (!active_.empty()) {
      progress.report(fraction(), kMeasuring);
      begin_round();
      const auto parts = static_cast<int>((round_.size() + kBlocksAtOnce - 1) / kBlocksAtOnce);
      parallel_for(threads, parts, [&](int part) {
        if (progress.cancelled()) return;
        BlockFront front(map_, graph_, known_, limit_);
        const std::size_t first = static_cast<std::size_t>(part) * kBlocksAtOnce;
        for (std::size_t i = first; i < std::min(round_.size(), first + kBlocksAtOnce); ++i)
          move(front, round_[i]);
      });
      if (progress.cancelled()) return cancelled_problem();
      for (Moved& moved : round_)
        if (moved.nearer != 0) store(moved);
    }
    progress.report(1, kMeasuring);
    return std::move(known_);
  }

 private:
  using Seam = std::vector<SeamTriangle>;
  struct Moved {
    std::uint32_t slot = 0;
    std::uint64_t nearer = 0;
    SurfaceDistances::Block block;
    std::unique_ptr<Seam> seam;  // if the slot has no block yet
  };

  double fraction() const {
    if (limit_ < kInfinity) return limit_ > 0 ? std::min(1.0f, until_ / limit_) : 1;
    return std::min(1.0, double(known_.blocks_.size()) / double(map_.block_of_slot.size()));
  }

  bool is_full(std::uint32_t slot) const {
    return known_.sources_[slot] == map_.surface_mask[slot];
  }

  // Has the block computed in the round of distance `key`.
  void activate(std::uint32_t slot, float key) {
    if (slot == kNoSlot || key >= key_of_slot_[slot] || is_full(slot)) return;
    if (key_of_slot_[slot] == kInfinity) active_.push_back(slot);
    key_of_slot_[slot] = key;
  }

  std::uint32_t slot_beside(std::uint32_t slot, int dx, int dy) const {
    const auto block = static_cast<int>(map_.block_of_slot[slot]);
    return slot_at(map_, block % map_.blocks_per_side + dx, block / map_.blocks_per_side + dy);
  }

  void start_at(std::uint32_t slot) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) activate(slot_beside(slot, dx, dy), 0);
    activate_linked(slot, known_.sources_[slot], [](std::uint32_t) { return 0.0f; });
  }

  template <class KeyOf>
  void activate_linked(std::uint32_t slot, std::uint64_t texels, KeyOf&& key_of) {
    for (std::uint64_t left = texels & graph_.has_links[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      for (const TexelGraph::Link& link : graph_.links_of(slot * 64 + i))
        if (link.second / 64 != slot) activate(link.second / 64, key_of(i));
    }
  }

  // Takes active blocks that the front reaches next. The others keep their keys.
  void begin_round() {
    const auto key = [&](std::uint32_t slot) { return key_of_slot_[slot]; };
    const float nearest = key(*std::ranges::min_element(active_, {}, key));
    if (nearest >= until_ || until_ == 0) until_ = nearest + round_width_;
    round_.clear();
    std::erase_if(active_, [&](std::uint32_t slot) {
      if (key(slot) > until_ || round_.size() == kMostBlocksOfRound) return false;
      key_of_slot_[slot] = kInfinity;
      round_.emplace_back().slot = slot;
      return true;
    });
  }

  void move(BlockFront& front, Moved& moved) const {
    const std::uint32_t block = known_.block_of_slot_[moved.slot];
    if (block != kNoSlot) {
      static const Seam kNone;
      const Seam* seam = seam_of_block_[block].get();
      moved.nearer = front.move(moved.slot, seam ? *seam : kNone, moved.block);
      return;
    }
    Seam seam = seam_triangles(map_, graph_, moved.slot);
    moved.nearer = front.move(moved.slot, seam, moved.block);
    if (!seam.empty()) moved.seam = std::make_unique<Seam>(std::move(seam));
  }

  void store(Moved& moved) {
    std::uint32_t& block = known_.block_of_slot_[moved.slot];
    if (block == kNoSlot) {
      block = static_cast<std::uint32_t>(known_.blocks_.size());
      known_.blocks_.push_back(moved.block);
      seam_of_block_.push_back(std::move(moved.seam));
    } else {
      known_.blocks_[block] = moved.block;
    }
    activate_around(moved);
  }

  void activate_around(const Moved& moved) {
    std::array<float, 9> key_of_side;
    key_of_side.fill(kInfinity);
    const auto side = [](int dx, int dy) {
      const int number = 3 * dy + dx + 4;
      return static_cast<std::size_t>(number);
    };
    for (std::uint64_t left = moved.nearer; left != 0; left &= left - 1) {
      const int texel = std::countr_zero(left), x = texel % 8, y = texel / 8;
      const float distance = moved.block.distance[texel];
      const int dx = x == 0 ? -1 : x == 7 ? 1 : 0, dy = y == 0 ? -1 : y == 7 ? 1 : 0;
      for (const auto& [at_x, at_y] : {std::pair{dx, 0}, std::pair{0, dy}, std::pair{dx, dy}}) {
        float& key = key_of_side[side(at_x, at_y)];
        key = std::min(key, distance);
      }
    }
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (dx != 0 || dy != 0)
          activate(slot_beside(moved.slot, dx, dy), key_of_side[side(dx, dy)]);
    activate_linked(moved.slot, moved.nearer,
                    [&](std::uint32_t texel) { return moved.block.distance[texel]; });
  }

  const SurfaceMap& map_;
  const TexelGraph& graph_;
  const float limit_;
  float round_width_ = 0, until_ = 0;
  SurfaceDistances known_;
  std::vector<std::unique_ptr<Seam>> seam_of_block_;
  // The least distance that a active block may continue from; infinity if it is not active.
  std::vector<float> key_of_slot_;
  std::vector<std::uint32_t> active_;
  std::vector<Moved> round_;
};

std::uint64_t SurfaceDistances::reached_in(std::uint32_t slot) const {
  if (!has_block(slot)) return sources_[slot];
  const Block& block = blocks_[block_of_slot_[slot]];
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 64; ++i) bits |= std::uint64_t{block.distance[i] < kInfinity} << i;
  return bits;
}

std::uint64_t SurfaceDistances::reached_texels() const {
  std::uint64_t count = 0;
  for (std::uint32_t slot = 0; slot < sources_.size(); ++slot)
    count += static_cast<std::uint64_t>(std::popcount(reached_in(slot)));
  return count;
}

std::size_t SurfaceDistances::bytes() const {
  return sources_.capacity() * sizeof(std::uint64_t) +
         block_of_slot_.capacity() * sizeof(std::uint32_t) + blocks_.size() * sizeof(Block);
}

Result<SurfaceDistances> distances_along_surface(const SurfaceMap& map, const TexelGraph& graph,
                                                 std::span<const std::uint64_t> sources,
                                                 double limit, Progress& progress, int threads) {
  if (!(limit >= 0))
    return fail(ErrorCode::malformed, "Invalid distance",
                "The limit of a distance must be a number that is not negative.", "limit");
  if (sources.size() != map.block_of_slot.size())
    return fail(ErrorCode::malformed, "Invalid sources",
                "The sources must have one word for each of the " +
                    std::to_string(map.block_of_slot.size()) + " slots of the surface map.");
  FrontRounds rounds(map, graph, sources, static_cast<float>(limit));
  return rounds.run(progress, threads);
}

}  // namespace strata::mesh
