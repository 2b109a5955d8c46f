#include "app/demo/story_brush.h"

#include <algorithm>
#include <cmath>

#include "domain/layers/revision.h"
#include "mesh/demo/demo_pot_noise.h"

namespace strata::app {
namespace {

double distance_to_path(const std::vector<glm::dvec3>& path, const glm::dvec3& p) {
  if (path.size() == 1) return glm::distance(path.front(), p);
  double nearest = INFINITY;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const glm::dvec3 along = path[i + 1] - path[i];
    const double length2 = glm::dot(along, along);
    const double t =
        length2 > 0 ? std::clamp(glm::dot(p - path[i], along) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, glm::distance(p, path[i] + t * along));
  }
  return nearest;
}

}  // namespace

store::JournalEntry StoryBrush::paint(const Layer& layer, Content& content, const Stroke& stroke,
                                      std::optional<std::uint32_t> value,
                                      double metres_per_unit) const {
  std::vector<glm::dvec3> path;
  for (const auto& at : stroke.path) path.push_back(places_.place(at) - places_.origin());
  if (path.size() > 1) {
    // Between two points, the path follows the surface instead of a straight line.
    path.clear();
    for (const glm::dvec3& point : places_.line(stroke.path))
      path.push_back(point - places_.origin());
  }
  glm::dvec3 low = path.front(), high = low;
  for (const glm::dvec3& point : path) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  const double reach = 1.5 * stroke.radius_mm;

  store::JournalEntry entry;
  const int tiles = map_.resolution / kTileSize, blocks = kTileSize / kBlockSize;
  std::uint64_t texels = 0;
  double area = 0;
  for (int ty = 0; ty < tiles; ++ty)
    for (int tx = 0; tx < tiles; ++tx) {
      const TileAddress address{static_cast<std::uint16_t>(tx), static_cast<std::uint16_t>(ty)};
      const auto known = content.find(address);
      const TileData before = known == content.end() ? TileData(layer.type) : known->second;
      TileData after = before;
      TileMask written;
      for (int block = 0; block < blocks * blocks; ++block) {
        const int bx = block % blocks, by = block / blocks;
        const auto slot = map_.slot_of_block[std::size_t(ty * blocks + by) * map_.blocks_per_side +
                                             tx * blocks + bx];
        if (slot == mesh::kNoSlot) continue;
        const auto& bounds = map_.bounds_of_slot[slot];
        const glm::dvec3 center(bounds.center);
        if (glm::any(glm::lessThan(center + double(bounds.radius) + reach, low)) ||
            glm::any(glm::greaterThan(center - double(bounds.radius) - reach, high)))
          continue;
        for (int i = 0; i < kBlockSize * kBlockSize; ++i) {
          const std::size_t at = std::size_t(slot) * 64 + i;
          if (map_.packed_position[at] == mesh::kNoPosition) continue;
          const glm::dvec3 p(map_.position(slot, i));
          const double ragged = 1 + 0.35 * mesh::fractal_noise(p * 0.22, 3);
          if (distance_to_path(path, p) > stroke.radius_mm * ragged) continue;
          if (!places_.is_outside(p)) continue;
          const int texel =
              (by * kBlockSize + i / kBlockSize) * kTileSize + bx * kBlockSize + i % kBlockSize;
          if (value)
            after.write(texel, *value);
          else
            after.clear(texel);
          written.set(texel);
          texels += map_.surface_mask[slot] >> i & 1u;
          area += map_.area[at];
        }
      }
      if (!written.any()) continue;
      entry.revisions.push_back(
          {address, encode_revision(make_revision(address, before, after, written)), {}});
      content[address] = std::move(after);
    }
  entry.answer = {{"texels_changed", texels},
                  {"area_m2", area * metres_per_unit * metres_per_unit}};
  return entry;
}

}  // namespace strata::app
