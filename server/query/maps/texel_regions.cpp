#include "query/maps/texel_regions.h"

#include <bit>

#include "domain/people/question.h"
#include "mesh/texels/slot_bits.h"

namespace strata::query {
namespace {

constexpr std::uint32_t kNoRegion = 0xffffffffu;
constexpr std::size_t kMinCorners = 4;  // corners of the smallest region
constexpr glm::ivec2 kSteps[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
// The texels to the left and to the right of the edge that continues from a corner in each
// direction. The offsets are from that corner to the lower left corners of the texels.
constexpr glm::ivec2 kLeftOf[] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
constexpr glm::ivec2 kRightOf[] = {{0, -1}, {0, 0}, {-1, 0}, {-1, -1}};

class Regions {
 public:
  Regions(const mesh::SurfaceMap& map, const std::vector<std::uint32_t>& labels)
      : map_(map),
        labels_(labels),
        region_of_(labels.size(), kNoRegion),
        walked_(map.block_of_slot.size(), 0) {}

  bool find(std::size_t corner_limit, std::vector<TexelRegion>& regions) {
    const QuestionTurn turn;
    for (std::uint32_t texel = 0; texel < labels_.size(); ++texel) {
      if (texel % kTexelsPerTile == 0) turn.check(kTexelsPerTile);
      if (labels_[texel] == 0 || region_of_[texel] != kNoRegion) continue;
      fill(texel, static_cast<std::uint32_t>(regions.size()));
      regions.push_back({labels_[texel], {}});
      if (regions.size() * kMinCorners > corner_limit) return false;
    }
    std::size_t corners = 0;
    for (std::uint32_t slot = 0; slot < walked_.size(); ++slot) {
      if (slot % 256 == 0) turn.check(kTexelsPerTile);
      for (int i = 0; i < 64; ++i) {
        const std::uint32_t region = region_of_[slot * 64 + static_cast<std::uint32_t>(i)];
        if (region == kNoRegion || (walked_[slot] >> i & 1u) != 0) continue;
        const glm::ivec2 at = place_of(slot, i);
        if (region_at(at - glm::ivec2(0, 1)) == region) continue;
        std::vector<glm::ivec2> ring = walk(at, region, corner_limit - corners);
        corners += ring.size();
        turn.check(ring.size());
        if (corners > corner_limit) return false;
        put(std::move(ring), regions[region]);
      }
    }
    return true;
  }

 private:
  glm::ivec2 place_of(std::uint32_t slot, int texel) const {
    const auto block = static_cast<int>(map_.block_of_slot[slot]);
    return {block % map_.blocks_per_side * kBlockSize + texel % kBlockSize,
            block / map_.blocks_per_side * kBlockSize + texel / kBlockSize};
  }
  // Returns kNoSlot if there is no texel.
  mesh::SlotTexel texel_at(glm::ivec2 at) const {
    if (at.x < 0 || at.y < 0) return {mesh::kNoSlot, 0};
    return {mesh::slot_at(map_, at.x / kBlockSize, at.y / kBlockSize),
            at.y % kBlockSize * kBlockSize + at.x % kBlockSize};
  }
  std::uint32_t region_at(glm::ivec2 at) const {
    const mesh::SlotTexel found = texel_at(at);
    return found.slot == mesh::kNoSlot
               ? kNoRegion
               : region_of_[std::size_t{found.slot} * 64 + static_cast<std::size_t>(found.texel)];
  }

  void fill(std::uint32_t first, std::uint32_t region) {
    std::vector<std::uint32_t> waiting{first};
    region_of_[first] = region;
    while (!waiting.empty()) {
      const std::uint32_t texel = waiting.back();
      waiting.pop_back();
      const glm::ivec2 at = place_of(texel / 64, static_cast<int>(texel % 64));
      for (const glm::ivec2 step : kSteps) {
        const mesh::SlotTexel found = texel_at(at + step);
        if (found.slot == mesh::kNoSlot) continue;
        const std::uint32_t next = found.slot * 64 + static_cast<std::uint32_t>(found.texel);
        if (labels_[next] != labels_[first] || region_of_[next] != kNoRegion) continue;
        region_of_[next] = region;
        waiting.push_back(next);
      }
    }
  }

  // Returns the ring that begins at the lower left corner of a texel, along its lower edge. The
  // region is always on the left. Stops after more than `most` corners.
  std::vector<glm::ivec2> walk(glm::ivec2 start, std::uint32_t region, std::size_t most) {
    std::vector<glm::ivec2> ring;
    glm::ivec2 at = start;
    int way = 0;
    do {
      if (way == 0) {
        const mesh::SlotTexel above = texel_at(at);
        walked_[above.slot] |= std::uint64_t{1} << above.texel;
      }
      ring.push_back(at);
      at += kSteps[way];
      if (region_at(at + kLeftOf[way]) != region)
        way = (way + 1) % 4;
      else if (region_at(at + kRightOf[way]) == region)
        way = (way + 3) % 4;
    } while ((at != start || way != 0) && ring.size() <= most);
    return ring;
  }

  static void put(std::vector<glm::ivec2> ring, TexelRegion& region) {
    std::int64_t twice = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::ivec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      twice += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
    }
    region.rings.insert(twice > 0 ? region.rings.begin() : region.rings.end(), std::move(ring));
  }

  const mesh::SurfaceMap& map_;
  const std::vector<std::uint32_t>& labels_;
  std::vector<std::uint32_t> region_of_;
  // for each slot, the bits of the texels whose lower edge is on a ring that was already found
  std::vector<std::uint64_t> walked_;
};

}  // namespace

bool find_regions(const mesh::SurfaceMap& map, const std::vector<std::uint32_t>& labels,
                  std::size_t corner_limit, std::vector<TexelRegion>& regions) {
  const QuestionMemory memory(labels.size() * sizeof(std::uint32_t));
  return Regions(map, labels).find(corner_limit, regions);
}

}  // namespace strata::query
