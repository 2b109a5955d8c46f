#include "jobs/orthophoto.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "domain/layers/mask_texels.h"
#include "mesh/texels/surface_map.h"
#include "mesh/texture/gutter_fill.h"

namespace strata::jobs {
namespace {

double pixel_area(const query::WorldFile& world) {
  return std::abs(world.x_per_column * world.y_per_row - world.x_per_row * world.y_per_column);
}

constexpr int kGutterRing = 8;  // pixels around the islands to which colors are continued exactly

template <class Visit>
void for_each_pixel_of(TileAddress address, const TileMask& mask, int resolution, Visit&& visit) {
  const auto side = static_cast<std::size_t>(resolution);
  for_each_texel(mask, [&](int texel) {
    const auto x = std::size_t{address.x} * kTileSize + static_cast<std::size_t>(texel % kTileSize);
    const auto y = std::size_t{address.y} * kTileSize + static_cast<std::size_t>(texel / kTileSize);
    visit(4 * ((side - 1 - y) * side + x), texel);  // tiles are counted from the bottom
  });
}

Picture empty_picture(int resolution) {
  const auto side = static_cast<std::size_t>(resolution);
  return {resolution, resolution, std::vector<std::uint8_t>(4 * side * side)};
}

// Returns an image that is 255 where the surface has a color, and 0 on the rest of the surface.
// Around the islands, the image continues the values at their rims, as it does for the colors.
Picture cover_of(const TileMap& colors, const mesh::SurfaceMap& map) {
  Picture cover = empty_picture(map.resolution);
  const int tiles = map.resolution / kTileSize;
  for (int ty = 0; ty < tiles; ++ty)
    for (int tx = 0; tx < tiles; ++tx) {
      const TileAddress address{static_cast<std::uint16_t>(tx), static_cast<std::uint16_t>(ty)};
      for_each_pixel_of(address, map.owned_in_tile(address), map.resolution,
                        [&](std::size_t at, int) { cover.rgba[at + 3] = 255; });
    }
  for (const auto& [address, tile] : colors)
    for_each_pixel_of(address, tile->valid, map.resolution,
                      [&](std::size_t at, int) { cover.rgba[at] = 255; });
  mesh::fill_gutter(cover, kGutterRing);
  return cover;
}

}  // namespace

int orthophoto_resolution(const Model& model, const query::WorldFile& world) {
  int resolution = model.atlas.lowest_resolution;
  double texel_area = model.area / (std::max(model.atlas.coverage, 1e-6) *
                                    std::pow(static_cast<double>(resolution), 2));
  for (; resolution < kMaxOrthophotoSurfaceImage && texel_area > pixel_area(world); texel_area /= 4)
    resolution *= 2;
  return resolution;
}

OrthophotoSampler::OrthophotoSampler(Picture picture, const query::WorldFile& world,
                                     double texel_area)
    : finder_(picture.width, picture.height, world), height_(picture.height), scale_(1) {
  const int side = std::max(picture.width, picture.height);
  auto image = render::make_mipmaps(std::move(picture.rgba), picture.width, picture.height, side);
  std::size_t level = 0;
  for (double area = 4 * pixel_area(world); area <= texel_area && level + 1 < image.levels.size();
       area *= 4) {
    ++level;
    scale_ /= 2;
  }
  level_ = std::move(image.levels[level]);
}

std::optional<std::uint32_t> OrthophotoSampler::color_at(const glm::dvec2& place) const {
  if (!finder_.pixel_at(place)) return std::nullopt;
  glm::dvec2 pixel = finder_.place_of(place);
  pixel.y = height_ - 1 - pixel.y;
  pixel = glm::clamp((pixel + 0.5) * scale_ - 0.5, glm::dvec2(0),
                     glm::dvec2(level_.width - 1, level_.height - 1));
  const glm::dvec2 whole = glm::floor(pixel), part = pixel - whole;
  std::array<double, 4> sum{};
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const auto x =
        static_cast<std::size_t>(std::min(static_cast<int>(whole.x) + dx, level_.width - 1));
    const auto y =
        static_cast<std::size_t>(std::min(static_cast<int>(whole.y) + dy, level_.height - 1));
    const std::uint8_t* rgba = &level_.rgba[4 * (y * static_cast<std::size_t>(level_.width) + x)];
    const double weight = (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y) * rgba[3];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * rgba[c];
    sum[3] += weight;
  }
  if (sum[3] < 127.5) return std::nullopt;
  std::uint32_t bits = 0xff000000u;
  for (std::size_t c = 0; c < 3; ++c)
    bits |= static_cast<std::uint32_t>(std::lround(sum[c] / sum[3])) << (8 * c);
  return bits;
}

Picture orthophoto_surface_image(const TileMap& colors, const mesh::SurfaceMap& map) {
  Picture picture = empty_picture(map.resolution);
  for (const auto& [address, tile] : colors)
    for_each_pixel_of(address, tile->valid, map.resolution,
                      [&, &tile = *tile](std::size_t at, int texel) {
                        const std::uint32_t bits = tile.bits(texel);
                        for (int c = 0; c < 4; ++c)
                          picture.rgba[at + static_cast<std::size_t>(c)] =
                              static_cast<std::uint8_t>(bits >> (8 * c));
                      });
  mesh::fill_gutter(picture, kGutterRing);
  const Picture cover = cover_of(colors, map);
  for (std::size_t at = 0; at < picture.rgba.size(); at += 4) picture.rgba[at + 3] = cover.rgba[at];
  return picture;
}

}  // namespace strata::jobs
