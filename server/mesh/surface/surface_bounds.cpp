#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/texels/packed_position.h"
#include "mesh/texels/surface_bake.h"

namespace strata::mesh {
namespace {

// As a share of the model's diagonal. Allows for rounding in code that unpacks positions as floats.
constexpr float kSlack = 1e-6f;

// Texels of a block belong to different parts if they are farther apart than this number of mean
// texel widths, with no texel between them.
constexpr double kMinGap_texels = 4;

float slack_of(const Geometry& geometry) {
  return kSlack * glm::length(geometry.box_max - geometry.box_min);
}

}  // namespace

// Calls visit(slot, mask of the texels that are surface or gutter).
template <class Visit>
void SurfaceBake::for_each_slot(int band, Visit visit) {
  const std::size_t blocks = static_cast<std::size_t>(map_.blocks_per_side);
  for (std::size_t block = first_block_row(band) * blocks;
       block < first_block_row(band + 1) * blocks; ++block)
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

// Gutter texels of other blocks may use the position of a surface texel. The surface texel is then
// moved to the coarsest of their grids, so each block can store the same position. Steps are powers
// of two, so a point of a coarse grid is also a point of every finer grid. The texels are moved in
// a fixed order on one thread.
void SurfaceBake::share_grids() {
  for (const auto& band : borrowed_)
    for (const Borrowed& borrowed : band) {
      const glm::vec3 step = glm::max(map_.packed_box[borrowed.gutter / 64].step,
                                      map_.packed_box[borrowed.owner / 64].step);
      glm::vec3& position = position_[borrowed.owner];
      for (int i = 0; i < 3; ++i)
        position[i] = static_cast<float>(std::nearbyint(double{position[i]} / double{step[i]}) *
                                         double{step[i]});
    }
  for (const auto& band : borrowed_)
    for (const Borrowed& borrowed : band) position_[borrowed.gutter] = position_[borrowed.owner];
}

void SurfaceBake::pack_slots(int band) {
  const float slack = slack_of(geometry_);
  const double texel_area =
      map_.area_total / static_cast<double>(std::max<std::uint64_t>(map_.surface_texels, 1));
  const auto least_gap = static_cast<float>(kMinGap_texels * std::sqrt(texel_area));
  for_each_slot(band, [&](std::uint32_t slot, std::uint64_t owned) {
    const glm::vec3* positions = position_.get() + std::size_t{slot} * 64;
    auto& packed_box = map_.packed_box[slot];
    Box& box = box_of_slot_[slot];
    // Moved positions may shift the beginning of the box slightly. Its step does not change.
    for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
      const glm::vec3 position = positions[std::countr_zero(rest)];
      box.low = glm::min(box.low, position), box.high = glm::max(box.high, position);
    }
    for (int i = 0; i < 3; ++i)
      packed_box.min[i] = static_cast<float>(
          std::floor(double{box.low[i]} / double{packed_box.step[i]}) * double{packed_box.step[i]});
    for (std::uint64_t rest = owned; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      map_.packed_position[std::size_t{slot} * 64 + i] = pack_position(positions[i], packed_box);
    }
    map_.sums_of_slot[slot] = map_.sum_slot(slot);
    map_.bounds_of_slot[slot] = bounds_of(positions, owned, slack);
    add_parts_of_block({part_of(slot), map_.bounds_of_slot[slot]}, positions, owned, least_gap,
                       slack, parts_of_band_[band]);
  });
}

BlockTree::Part SurfaceBake::part_of(std::uint32_t slot) const {
  constexpr std::uint32_t kBlocks = kTileSize / kBlockSize;  // per side
  const std::uint32_t block = map_.block_of_slot[slot],
                      per_side = static_cast<std::uint32_t>(map_.blocks_per_side);
  const std::uint32_t x = block % per_side, y = block / per_side;
  return {slot, static_cast<std::uint16_t>(y / kBlocks * (per_side / kBlocks) + x / kBlocks),
          static_cast<std::uint8_t>(y % kBlocks * kBlocks + x % kBlocks), false};
}

void SurfaceBake::bound_tiles() {
  const std::size_t per_side = static_cast<std::size_t>(map_.resolution / kTileSize);
  const float slack = slack_of(geometry_);
  std::vector<Box> boxes(per_side * per_side);
  for (std::uint32_t slot = 0; slot < box_of_slot_.size(); ++slot) {
    Box& box = boxes[part_of(slot).tile];
    box.low = glm::min(box.low, box_of_slot_[slot].low);
    box.high = glm::max(box.high, box_of_slot_[slot].high);
  }
  for (const Box& box : boxes) {
    if (box.low.x > box.high.x)
      map_.bounds_of_tile.emplace_back();
    else
      map_.bounds_of_tile.push_back(
          {(box.low + box.high) * 0.5f, glm::length(box.high - box.low) * 0.5f + 4 * slack});
  }
}

void SurfaceBake::plant_tree(int threads) {
  std::vector<BoundedPart> parts;
  parts.reserve(map_.block_of_slot.size());
  for (auto& band : parts_of_band_) {
    parts.insert(parts.end(), band.begin(), band.end());
    band = {};
  }
  map_.tree = build_block_tree(std::move(parts), slack_of(geometry_), threads);
}

}  // namespace strata::mesh
