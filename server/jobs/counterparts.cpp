#include "jobs/counterparts.h"

#include <utility>

#include "domain/layers/texel_lookup.h"

namespace strata::jobs {

std::optional<mesh::SearchTree::Hit> counterpart(const ComparedSide& from,
                                                 const mesh::TexelOwners& owners, std::size_t texel,
                                                 const ComparedSide& to,
                                                 const CounterpartTolerance& tolerance) {
  const std::uint32_t triangle = owners.triangle[texel];
  const glm::vec3 w = owners.weights_of(texel);
  const mesh::Geometry& geometry = *from.geometry;
  glm::vec3 position(0);
  for (int k = 0; k < 3; ++k)
    position += w[k] * geometry.vertices[geometry.indices[3 * std::size_t{triangle} + k]].position;
  const glm::dvec3 world = geometry.origin + glm::dvec3(position);
  const glm::vec3 point(world * (from.metres / to.metres) - to.geometry->origin);
  return to.tree->nearest_facing(point, static_cast<float>(tolerance.metres / to.metres),
                                 from.normals.at(triangle, w), tolerance.least_cos);
}

std::vector<std::uint64_t> Counterparts::matched() const {
  std::vector<std::uint64_t> matched(owners.block_of_slot.size(), 0);
  for (std::size_t texel = 0; texel < uv.size(); ++texel)
    if (has(texel)) matched[texel / 64] |= std::uint64_t{1} << texel % 64;
  return matched;
}

Result<Counterparts> find_counterparts(const ComparedSide& here, const ComparedSide& there,
                                       const CounterpartTolerance& tolerance, int resolution,
                                       Progress& progress, double from, double to,
                                       const std::vector<std::uint64_t>* only) {
  progress.begin_stage(from, from + 0.2 * (to - from));
  auto owners = STRATA_TRY(mesh::bake_texel_owners(*here.geometry, resolution, progress));
  Counterparts found{std::move(owners), {}};
  found.uv.assign(found.owners.triangle.size(), glm::vec2(Counterparts::kNone));
  progress.begin_stage(from + 0.2 * (to - from), to);
  const auto find = [&](std::size_t texel) {
    if (only && ((*only)[texel / 64] >> texel % 64 & 1u) == 0) return;
    if (const auto hit = counterpart(here, found.owners, texel, there, tolerance))
      found.uv[texel] = hit->uv;
  };
  STRATA_TRY(
      mesh::for_each_texel(found.owners, find, "Finding the corresponding places", progress));
  return found;
}

Result<TileMap> values_at(const Counterparts& counterparts, const Layer& layer,
                          const TileMap& tiles, Progress& progress) {
  const auto bits = [&](std::size_t texel) -> std::optional<std::uint32_t> {
    if (!counterparts.has(texel)) return std::nullopt;
    return bits_at(tiles, layer.resolution, counterparts.uv[texel]);
  };
  return mesh::paint_texels(counterparts.owners, layer.type, bits, progress);
}

}  // namespace strata::jobs
