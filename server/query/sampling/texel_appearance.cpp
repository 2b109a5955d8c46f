#include "query/sampling/texel_appearance.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/parallel.h"
#include "mesh/surface/surface_normals.h"
#include "mesh/texture/texture_sampler.h"
#include "mesh/texture/vertex_color.h"

namespace strata::query {
namespace {

// Calls visit(texel) for each surface texel, on several threads. Fails when cancelled.
template <class Visit>
Result<void> for_each_texel(const std::vector<std::uint64_t>& surface_mask, Progress& progress,
                            int threads, Visit&& visit) {
  constexpr std::size_t kSlotsAtOnce = 256;
  const auto parts = static_cast<int>((surface_mask.size() + kSlotsAtOnce - 1) / kSlotsAtOnce);
  mesh::parallel_for(threads, parts, [&](int part) {
    if (progress.cancelled()) return;
    const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce,
                      last = std::min(surface_mask.size(), first + kSlotsAtOnce);
    for (std::size_t slot = first; slot < last; ++slot)
      for (std::uint64_t left = surface_mask[slot]; left != 0; left &= left - 1)
        visit(slot * 64 + static_cast<std::size_t>(std::countr_zero(left)));
  });
  if (progress.cancelled()) return cancelled_problem();
  return {};
}

std::uint32_t snorm16(float value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767)) & 0xffffu;
}

float from_snorm16(std::uint32_t bits) {
  return std::max(-1.0f, static_cast<float>(static_cast<std::int16_t>(bits & 0xffffu)) / 32767);
}

glm::vec2 folded(const glm::vec2& at) {
  return {(1 - std::abs(at.y)) * (at.x >= 0 ? 1.0f : -1.0f),
          (1 - std::abs(at.x)) * (at.y >= 0 ? 1.0f : -1.0f)};
}

}  // namespace

Result<TexelAppearance> vertex_colors_of_texels(const mesh::Geometry& geometry,
                                                const mesh::TexelOwners& owners, Progress& progress,
                                                int threads) {
  TexelAppearance colors(owners.triangle.size());
  const auto paint = [&](std::size_t texel) {
    const glm::vec3 weights = owners.weights_of(texel);
    glm::vec3 color(0);
    for (int k = 0; k < 3; ++k) {
      const auto corner = 3 * std::size_t{owners.triangle[texel]} + static_cast<std::size_t>(k);
      const std::uint32_t rgb = geometry.vertices[geometry.indices[corner]].color;
      color += weights[k] * glm::vec3(rgb & 0xffu, rgb >> 8 & 0xffu, rgb >> 16 & 0xffu);
    }
    colors[texel] = mesh::pack_color(color.x, color.y, color.z, 255);
  };
  STRATA_TRY(for_each_texel(owners.surface_mask, progress, threads, paint));
  return colors;
}

Result<void> draw_over(TexelAppearance& colors, Picture picture, float opacity,
                       const mesh::SurfaceMap& map, Progress& progress, int threads) {
  while (mesh::halve_toward(picture, map.resolution))
    if (progress.cancelled()) return cancelled_problem();
  const mesh::TextureSampler sampler(picture);
  return for_each_texel(map.surface_mask, progress, threads, [&](std::size_t texel) {
    const std::uint32_t block = map.block_of_slot[texel / 64];
    const auto side = static_cast<std::uint32_t>(map.blocks_per_side);
    const glm::uvec2 place(block % side * 8 + texel % 8, block / side * 8 + texel % 64 / 8);
    const glm::dvec2 centre = glm::dvec2(place) + 0.5;
    const glm::vec4 over = sampler.sample_with_alpha(centre / double(map.resolution),
                                                     mesh::Wrap::clamp, mesh::Wrap::clamp);
    const std::uint32_t below = colors[texel];
    const float share = opacity * over.a / 255,
                rest = (1 - share) * static_cast<float>(below >> 24) / 255, alpha = share + rest;
    if (alpha <= 0) return;
    const glm::vec3 mixed =
        (share * glm::vec3(over) +
         rest * glm::vec3(below & 0xffu, below >> 8 & 0xffu, below >> 16 & 0xffu)) /
        alpha;
    colors[texel] = mesh::pack_color(mixed.x, mixed.y, mixed.z, 255 * alpha);
  });
}

std::uint32_t packed_normal(const glm::vec3& normal) {
  const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0) || !std::isfinite(sum)) return kNoNormal;
  glm::vec2 at(normal.x / sum, normal.y / sum);
  if (normal.z < 0) at = folded(at);
  return snorm16(at.x) | snorm16(at.y) << 16;
}

glm::vec3 unpacked_normal(std::uint32_t packed) {
  glm::vec2 at(from_snorm16(packed), from_snorm16(packed >> 16));
  const float z = 1 - std::abs(at.x) - std::abs(at.y);
  if (z < 0) at = folded(at);
  return glm::normalize(glm::vec3(at, z));
}

Result<TexelAppearance> normals_of_texels(const std::shared_ptr<const mesh::Geometry>& geometry,
                                          const mesh::TexelOwners& owners, Progress& progress,
                                          int threads) {
  const mesh::SurfaceNormals normals(geometry);
  TexelAppearance packed(owners.triangle.size(), kNoNormal);
  const auto pack = [&](std::size_t texel) {
    packed[texel] = packed_normal(normals.at(owners.triangle[texel], owners.weights_of(texel)));
  };
  STRATA_TRY(for_each_texel(owners.surface_mask, progress, threads, pack));
  return packed;
}

}  // namespace strata::query
