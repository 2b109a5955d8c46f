#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "media/picture.h"
#include "query/rasters/placed_picture.h"
#include "render/memory/mipmapped_picture.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::jobs {

// Converts an orthophoto to a surface image: projects its colors along its plane onto the surface,
// as a picture on the atlas.

constexpr int kMaxOrthophotoSurfaceImage = 8192;  // texels a side: the size of surface images on
                                                  // the GPU

// Returns the texels a side at which a texel covers no more surface than a pixel, from the atlas'
// lowest resolution to the largest.
int orthophoto_resolution(const Model& model, const query::WorldFile& world);

// The orthophoto's colors by places in its plane. Thread-safe.
class OrthophotoSampler {
 public:
  // `texel_area` in the square of the plane's unit: pixels much smaller than it are averaged in
  // linear light.
  OrthophotoSampler(Picture picture, const query::WorldFile& world, double texel_area);
  // Interpolates between the pixels: RGB with an alpha of 255, the first byte red. Nothing outside
  // of the picture, or where less than half is opaque.
  std::optional<std::uint32_t> color_at(const glm::dvec2& place) const;

 private:
  query::PixelFinder finder_;
  int height_;
  render::MipmappedPicture::Level level_;  // lowest row first
  double scale_;                           // from pixels of the picture to those of `level_`
};

// Returns the picture of u32 texels from `color_at`, top row first. Surface without a color is
// transparent, in colors that continue from the nearest ones; off the surface, colors and cover
// continue from the islands. So neither seams nor borders are visible after filtering.
Picture orthophoto_surface_image(const TileMap& colors, const mesh::SurfaceMap& map);

}  // namespace strata::jobs
