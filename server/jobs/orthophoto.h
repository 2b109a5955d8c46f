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

// Converts an orthophoto to a surface image: projects its colors perpendicular to its plane onto
// the surface, and stores them as an image in the atlas.

// The largest number of texels along a side: the size of surface images on the GPU.
constexpr int kMaxOrthophotoSurfaceImage = 8192;

// Returns the resolution at which a texel covers at most the area of a pixel. It is at least the
// atlas' lowest resolution and at most kMaxOrthophotoSurfaceImage.
int orthophoto_resolution(const Model& model, const query::WorldFile& world);

// Samples the orthophoto's colors at points in its plane. Thread-safe.
class OrthophotoSampler {
 public:
  // `texel_area` is the area of a texel, in the square of the plane's unit. Much smaller pixels are
  // averaged in linear light.
  OrthophotoSampler(Picture picture, const query::WorldFile& world, double texel_area);
  // Returns the interpolated color, with an alpha of 255. The lowest byte is red. Returns nothing
  // outside the image, and for points that are less than half opaque.
  std::optional<std::uint32_t> color_at(const glm::dvec2& place) const;

 private:
  query::PixelFinder finder_;
  int height_;
  render::MipmappedPicture::Level level_;  // lowest row first
  double scale_;                           // from pixels of the orthophoto to pixels of `level_`
};

// Returns the image of u32 texels with the colors of `color_at`, top row first. Surface without a
// color is transparent, but its color continues from the nearest texels. Off the surface, colors
// and cover continue from the islands. So no seams or borders are visible after filtering.
Picture orthophoto_surface_image(const TileMap& colors, const mesh::SurfaceMap& map);

}  // namespace strata::jobs
