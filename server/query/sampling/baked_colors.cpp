#include "query/sampling/baked_colors.h"

#include <algorithm>
#include <cmath>

#include "mesh/texels/texel_owners.h"
#include "mesh/texture/gutter_fill.h"

namespace strata::query {
namespace {

// Pixels around a chart with the color of the nearest pixel of the chart.
constexpr int kRing = 4;
constexpr double kLocated = 0.3;  // of the whole task, for the progress

std::uint8_t rounded(double channel) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0, 255.0)));
}

// Paints the pixels of the surface, and leaves the others transparent.
Result<void> paint_surface(const mesh::Geometry& geometry, const SurfaceColors& colors,
                           Picture& picture, Progress& progress) {
  const int size = picture.width;
  progress.begin_stage(0, kLocated);
  const auto owners = STRATA_TRY(mesh::bake_texel_owners(geometry, size, progress));
  progress.begin_stage(kLocated, kBaked);
  const auto paint = [&](std::size_t texel) {
    const auto block = static_cast<int>(owners.block_of_slot[texel / 64]),
               in_block = static_cast<int>(texel % 64);
    const int x = block % owners.blocks_per_side * kBlockSize + in_block % kBlockSize,
              y = block / owners.blocks_per_side * kBlockSize + in_block / kBlockSize;
    mesh::SearchTree::Hit point{};
    point.triangle = owners.triangle[texel];
    point.barycentric = owners.weights_of(texel);
    point.uv = glm::vec2((glm::dvec2(x, y) + 0.5) / static_cast<double>(size));
    const glm::dvec3 color = colors.at(point);
    std::uint8_t* rgba =
        &picture.rgba[(static_cast<std::size_t>(size - 1 - y) * static_cast<std::size_t>(size) +
                       static_cast<std::size_t>(x)) *
                      4];
    for (int channel = 0; channel < 3; ++channel) rgba[channel] = rounded(color[channel]);
    rgba[3] = 255;
  };
  return mesh::for_each_texel(owners, paint, "Painting the texture", progress);
}

}  // namespace

std::uint64_t bytes_to_bake(const mesh::Geometry& geometry, int size) {
  // The pixels with the coarser images of fill_gutter, the owners of all texels, and the lists of
  // triangles that bake_texel_owners needs.
  constexpr std::uint64_t kPixel = 6, kOwner = 12, kTriangle = 40;
  return (kPixel + kOwner) * static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size) +
         kTriangle * geometry.triangle_count();
}

Result<Picture> bake_colors(const mesh::Geometry& geometry, const SurfaceColors& colors, int size,
                            Progress& progress) {
  Picture picture{size, size, {}};
  picture.rgba.resize(std::size_t{4} * static_cast<std::size_t>(size) *
                      static_cast<std::size_t>(size));
  STRATA_TRY(paint_surface(geometry, colors, picture, progress));
  mesh::fill_gutter(picture, kRing);
  return picture;
}

}  // namespace strata::query
