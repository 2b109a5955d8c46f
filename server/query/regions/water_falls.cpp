#include "query/regions/water_falls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/analysis/ray_scene.h"
#include "query/regions/texel_discs.h"

namespace strata::query {

using mesh::kNoNeighbour;

WaterFalls::WaterFalls(std::shared_ptr<const mesh::Geometry> geometry,
                       std::unique_ptr<mesh::RayScene> scene, const mesh::SurfaceMap& map,
                       const mesh::TexelGraph& graph, glm::dvec3 up)
    : geometry_(std::move(geometry)),
      scene_(std::move(scene)),
      map_(&map),
      graph_(&graph),
      down_(-up),
      texel_size_(static_cast<float>(mean_texel_size(map))) {}
WaterFalls::WaterFalls(WaterFalls&&) noexcept = default;
WaterFalls::~WaterFalls() = default;

Result<WaterFalls> WaterFalls::make(std::shared_ptr<const mesh::Geometry> geometry,
                                    const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                    glm::dvec3 up, Progress& progress) {
  auto scene = STRATA_TRY(mesh::RayScene::make(geometry, progress));
  return WaterFalls(std::move(geometry), std::move(scene), map, graph, up);
}

glm::vec3 WaterFalls::place(std::uint32_t texel) const {
  return map_->position(texel / 64, static_cast<int>(texel % 64));
}

std::uint32_t WaterFalls::below(std::uint32_t texel) const {
  // The ray must not hit the face from which the water falls.
  constexpr float kLeast = 0.1f;  // of the size of a texel
  return landing(place(texel), kLeast * texel_size_);
}

std::uint32_t WaterFalls::below_edge(std::uint32_t texel) const {
  // The edge is half a texel away, on the side without neighbors.
  glm::vec3 away(0);
  float size = 0;
  mesh::for_each_neighbour(*map_, *graph_, texel, [&](std::uint32_t other) {
    const glm::vec3 from_other = place(texel) - place(other);
    away += from_other;
    size = std::max(size, glm::length(from_other));
  });
  const float length = glm::length(away);
  if (!(length > 0.1f * size)) return kNoNeighbour;  // no side without neighbors
  return landing(place(texel) + size / length * away, 0);
}

std::uint32_t WaterFalls::landing(const glm::vec3& from, float least) const {
  auto hit = scene_->first_hit(from, down_, least);
  // A face at a rim can lean out a little, so that the ray passes through the rim.
  constexpr float kRim = 3, kNext = 0.1f;  // in texels
  if (hit && hit->from_behind && hit->distance < kRim * texel_size_)
    hit = scene_->first_hit(from, down_, hit->distance + kNext * texel_size_);
  if (!hit || hit->from_behind) return kNoNeighbour;
  glm::vec2 uv(0);
  glm::vec3 place(0);
  for (int k = 0; k < 3; ++k) {
    const mesh::Vertex& corner =
        geometry_->vertices[geometry_->indices[3 * std::size_t{hit->triangle} +
                                               static_cast<std::size_t>(k)]];
    uv += hit->weights[k] * corner.uv;
    place += hit->weights[k] * corner.position;
  }
  return texel_near(uv, place);
}

std::uint32_t WaterFalls::texel_near(glm::vec2 uv, const glm::vec3& at) const {
  if (const auto own = mesh::surface_texel_at(*map_, uv)) return *own;
  const glm::ivec2 middle(glm::floor(uv * static_cast<float>(map_->resolution)));
  // A narrow face can have no texel. Texels of other charts can be near in the atlas.
  constexpr int kReach = 2;
  constexpr float kFar = 3;  // in texels
  std::uint32_t nearest = kNoNeighbour;
  float least = kFar * texel_size_;
  for (int y = middle.y - kReach; y <= middle.y + kReach; ++y)
    for (int x = middle.x - kReach; x <= middle.x + kReach; ++x) {
      if (x < 0 || y < 0 || x >= map_->resolution || y >= map_->resolution) continue;
      const std::uint32_t texel = texel_in_atlas(*map_, x, y);
      if (texel == kNoNeighbour) continue;
      if (const float distance = glm::distance(place(texel), at); distance < least) {
        least = distance;
        nearest = texel;
      }
    }
  return nearest;
}

}  // namespace strata::query
