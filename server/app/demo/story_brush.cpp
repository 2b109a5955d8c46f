#include "app/demo/story_brush.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/layers/revision.h"
#include "mesh/demo/demo_pot_noise.h"

namespace strata::app {
namespace {

constexpr int kDegrees = 360;
constexpr double kWall_mm = 2.2;  // less than the thickness of the pot's wall

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

int degree_of(double angle) {
  const int degree = static_cast<int>(std::floor(angle)) % kDegrees;
  return degree < 0 ? degree + kDegrees : degree;
}

}  // namespace

StoryBrush::StoryBrush(const mesh::Geometry& geometry, const mesh::SurfaceMap& map)
    : map_(map), origin_(geometry.origin) {
  axis_ = glm::dvec2(geometry.box_min + geometry.box_max) / 2.0;
  bottom_ = geometry.box_min.z;
  height_ = std::max(1e-3, double(geometry.box_max.z) - bottom_);
  const int rows = static_cast<int>(std::ceil(height_)) + 1;
  outer_.assign(std::size_t(rows) * kDegrees, 0.f);
  for (const mesh::Vertex& vertex : geometry.vertices) {
    const glm::dvec2 from_axis = glm::dvec2(vertex.position) - axis_;
    const int degree = degree_of(std::atan2(from_axis.y, from_axis.x) * 180 / std::numbers::pi);
    const int row = static_cast<int>(vertex.position.z - bottom_);
    float& outer = outer_[std::size_t(std::clamp(row, 0, rows - 1)) * kDegrees + degree];
    outer = std::max(outer, static_cast<float>(glm::length(from_axis)));
  }
}

double StoryBrush::outer_radius(double angle, double z) const {
  const int rows = static_cast<int>(outer_.size() / kDegrees);
  const int row = std::clamp(static_cast<int>(z - bottom_), 0, rows - 1);
  // Coarse meshes have cells without vertices.
  for (int reach = 1; reach < 12; ++reach) {
    float outer = 0;
    for (int dz = -reach; dz <= reach; ++dz)
      for (int da = -reach; da <= reach; ++da)
        outer = std::max(outer, outer_[std::size_t(std::clamp(row + dz, 0, rows - 1)) * kDegrees +
                                       degree_of(angle + da)]);
    if (outer > 0) return outer;
  }
  return 0;
}

glm::dvec3 StoryBrush::outward(const Place& at) const {
  const double angle = at.angle * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle), 0};
}

glm::dvec3 StoryBrush::place(const Place& at) const {
  const double z = bottom_ + at.height * height_;
  const glm::dvec3 from_axis = outward(at) * outer_radius(at.angle, z);
  return glm::dvec3(axis_, z) + from_axis + origin_;
}

std::vector<glm::dvec3> StoryBrush::line(const std::vector<Place>& path) const {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil(glm::distance(place(path[i]), place(path[i + 1])))));
    for (int step = i == 0 ? 0 : 1; step <= steps; ++step) {
      const double t = double(step) / steps;
      points.push_back(place({std::lerp(path[i].angle, path[i + 1].angle, t),
                              std::lerp(path[i].height, path[i + 1].height, t)}));
    }
  }
  return points;
}

store::JournalEntry StoryBrush::paint(const Layer& layer, Content& content, const Stroke& stroke,
                                      std::optional<std::uint32_t> value,
                                      double metres_per_unit) const {
  std::vector<glm::dvec3> path;
  for (const Place& at : stroke.path) path.push_back(place(at) - origin_);
  if (path.size() > 1) {
    // Between two places the line follows the surface, not the chord.
    path.clear();
    for (const glm::dvec3& point : line(stroke.path)) path.push_back(point - origin_);
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
          const glm::dvec2 from_axis = glm::dvec2(p) - axis_;
          const double angle = std::atan2(from_axis.y, from_axis.x) * 180 / std::numbers::pi;
          if (glm::length(from_axis) < outer_radius(angle, p.z) - kWall_mm) continue;
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
