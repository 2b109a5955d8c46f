#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/packed_position.h"
#include "mesh/surface_bake.h"

namespace strata::mesh {
namespace {

// Room for the rounding of whoever unpacks positions in float.
constexpr float kSlack = 1e-6f;

}  // namespace

// visit(slot, mask of the texels that are surface or gutter)
template <class Visit>
void SurfaceBake::for_each_slot(int band, Visit visit) {
  const std::size_t blocks = static_cast<std::size_t>(map_.blocks_per_side);
  for (std::size_t block = first_block_row(band) * blocks; block < first_block_row(band + 1) * blocks; ++block)
    if (const auto slot = map_.slot_of_block[block]; slot != kNoSlot)
      visit(slot, surface_of_block_[block] | gutter_of_block_[block]);
}

void SurfaceBake::box_slots(int band) {
  for_each_slot(band, [&](std::uint32_t slot, std::uint64_t owned) {
    Box& box = box_of_slot_[slot];
    box = {};
    const glm::vec3* positions = position_.get() + std::size_t{slot} * 64;
    for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
      const glm::vec3 position = positions[std::countr_zero(rest)];
      box.low = glm::min(box.low, position), box.high = glm::max(box.high, position);
    }
    map_.packed_box[slot] = packed_box_of(box.low, box.high);
  });
}

// A surface texel that gutter texels of other blocks borrow from is moved to the coarsest of their grids: then each block can
// hold the same position. (Powers of two: what lies on a coarse grid lies on every finer one.) In one order, on one thread.
void SurfaceBake::share_grids() {
  for (const auto& band : borrowed_)
    for (const Borrowed& borrowed : band) {
      const glm::vec3 step =
          glm::max(map_.packed_box[borrowed.gutter / 64].step, map_.packed_box[borrowed.owner / 64].step);
      glm::vec3& position = position_[borrowed.owner];
      for (int i = 0; i < 3; ++i)
        position[i] = static_cast<float>(std::nearbyint(double{position[i]} / double{step[i]}) * double{step[i]});
    }
  for (const auto& band : borrowed_)
    for (const Borrowed& borrowed : band) position_[borrowed.gutter] = position_[borrowed.owner];
}

void SurfaceBake::pack_slots(int band) {
  const float slack = kSlack * glm::length(geometry_.box_max - geometry_.box_min);
  for_each_slot(band, [&](std::uint32_t slot, std::uint64_t owned) {
    const glm::vec3* positions = position_.get() + std::size_t{slot} * 64;
    auto& packed_box = map_.packed_box[slot];
    Box& box = box_of_slot_[slot];
    // Moved positions may begin the box a little earlier; its step stays.
    for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
      const glm::vec3 position = positions[std::countr_zero(rest)];
      box.low = glm::min(box.low, position), box.high = glm::max(box.high, position);
    }
    for (int i = 0; i < 3; ++i)
      packed_box.min[i] =
          static_cast<float>(std::floor(double{box.low[i]} / double{packed_box.step[i]}) * double{packed_box.step[i]});
    auto& bounds = map_.bounds_8[slot];
    bounds.center = (box.low + box.high) * 0.5f;
    float farthest = 0;
    for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      map_.packed_position[std::size_t{slot} * 64 + i] = pack_position(positions[i], packed_box);
      const glm::vec3 d = positions[i] - bounds.center;
      farthest = std::max(farthest, glm::dot(d, d));
    }
    bounds.radius = std::sqrt(farthest) + slack;
  });
}

void SurfaceBake::bound_tiles() {
  const int blocks = map_.blocks_per_side;
  const float slack = kSlack * glm::length(geometry_.box_max - geometry_.box_min);
  const auto merge = [&](int blocks_a_group, std::vector<SurfaceMap::Bounds>& groups) {
    const int side = blocks / blocks_a_group;
    groups.assign(static_cast<std::size_t>(side) * side, {});
    for (int gy = 0; gy < side; ++gy)
      for (int gx = 0; gx < side; ++gx) {
        glm::vec3 low(INFINITY), high(-INFINITY);
        const auto for_each_part = [&](auto&& visit) {
          for (int by = gy * blocks_a_group; by < (gy + 1) * blocks_a_group; ++by)
            for (int bx = gx * blocks_a_group; bx < (gx + 1) * blocks_a_group; ++bx)
              if (const auto slot = map_.slot_of_block[static_cast<std::size_t>(by) * blocks + bx]; slot != kNoSlot)
                visit(map_.bounds_8[slot], box_of_slot_[slot]);
        };
        for_each_part([&](const SurfaceMap::Bounds&, const Box& box) {
          low = glm::min(low, box.low);
          high = glm::max(high, box.high);
        });
        if (low.x > high.x) continue;
        auto& bounds = groups[static_cast<std::size_t>(gy) * side + gx];
        bounds.center = (low + high) * 0.5f;
        float radius = 0;
        for_each_part([&](const SurfaceMap::Bounds& part, const Box&) {
          radius = std::max(radius, glm::length(part.center - bounds.center) + part.radius);
        });
        bounds.radius = std::min(radius, glm::length(high - low) * 0.5f + 4 * slack);
      }
  };
  merge(32 / kBlockSize, map_.bounds_32);
  merge(kTileSize / kBlockSize, map_.bounds_128);
}

}  // namespace strata::mesh
