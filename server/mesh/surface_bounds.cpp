#include <algorithm>
#include <cmath>

#include "mesh/packed_position.h"
#include "mesh/surface_bake.h"

namespace strata::mesh {
namespace {

// Room for the rounding of whoever unpacks positions in float.
constexpr float kSlack = 1e-6f;

}  // namespace

void SurfaceBake::bound_slots(int band) {
  const int blocks = map_.blocks_per_side;
  for (int block_row = first_block_row(band); block_row < first_block_row(band + 1); ++block_row)
    for (int column = 0; column < blocks; ++column) {
      const auto slot = map_.slot_of_block[static_cast<std::size_t>(block_row) * blocks + column];
      if (slot == kNoSlot) continue;
      const std::uint64_t* packed = map_.packed_position.data() + std::size_t{slot} * 64;
      Box& box = box_of_slot_[slot];
      glm::vec3 low(0), high(0);
      for (int i = 0; i < 64; ++i) {
        if (packed[i] == kNoPosition) continue;
        const glm::uvec3 q = unpack_quantised(packed[i]);
        box.low = glm::min(box.low, q), box.high = glm::max(box.high, q);
      }
      const auto unpacked = [&](glm::uvec3 q) {
        return map_.box_min +
               glm::vec3(q) / glm::vec3(kLargestPackedX, kLargestPackedY, kLargestPackedZ) * map_.box_extent;
      };
      low = unpacked(box.low), high = unpacked(box.high);
      auto& bounds = map_.bounds_8[slot];
      bounds.center = (low + high) * 0.5f;
      float farthest = 0;
      for (int i = 0; i < 64; ++i) {
        if (packed[i] == kNoPosition) continue;
        const glm::vec3 d = unpack_position(packed[i], map_.box_min, map_.box_extent) - bounds.center;
        farthest = std::max(farthest, glm::dot(d, d));
      }
      bounds.radius = std::sqrt(farthest) + kSlack * glm::length(map_.box_extent);
    }
}

void SurfaceBake::bound_tiles() {
  const int blocks = map_.blocks_per_side;
  const auto merge = [&](int blocks_a_group, std::vector<SurfaceMap::Bounds>& groups) {
    const int side = blocks / blocks_a_group;
    groups.assign(static_cast<std::size_t>(side) * side, {});
    for (int gy = 0; gy < side; ++gy)
      for (int gx = 0; gx < side; ++gx) {
        glm::vec3 low(INFINITY), high(-INFINITY);
        const auto for_each_slot = [&](auto&& visit) {
          for (int by = gy * blocks_a_group; by < (gy + 1) * blocks_a_group; ++by)
            for (int bx = gx * blocks_a_group; bx < (gx + 1) * blocks_a_group; ++bx)
              if (const auto slot = map_.slot_of_block[static_cast<std::size_t>(by) * blocks + bx]; slot != kNoSlot)
                visit(map_.bounds_8[slot], box_of_slot_[slot]);
        };
        const glm::vec3 step = map_.box_extent / glm::vec3(kLargestPackedX, kLargestPackedY, kLargestPackedZ);
        for_each_slot([&](const SurfaceMap::Bounds&, const Box& box) {
          low = glm::min(low, map_.box_min + glm::vec3(box.low) * step);
          high = glm::max(high, map_.box_min + glm::vec3(box.high) * step);
        });
        if (low.x > high.x) continue;
        auto& bounds = groups[static_cast<std::size_t>(gy) * side + gx];
        bounds.center = (low + high) * 0.5f;
        float radius = 0;
        for_each_slot([&](const SurfaceMap::Bounds& part, const Box&) {
          radius = std::max(radius, glm::length(part.center - bounds.center) + part.radius);
        });
        bounds.radius = std::min(radius, glm::length(high - low) * 0.5f + 4 * kSlack * glm::length(map_.box_extent));
      }
  };
  merge(32 / kBlockSize, map_.bounds_32);
  merge(kTileSize / kBlockSize, map_.bounds_128);
}

}  // namespace strata::mesh
