#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "media/picture.h"
#include "mesh/texels/surface_map.h"
#include "query/rasters/placed_picture.h"
#include "render/memory/mipmapped_picture.h"

namespace strata::jobs {

// An orthophoto that becomes a look: its colours, carried along its plane onto the surface, as a
// picture on the atlas.

constexpr int kMaxOrthophotoSurfaceImage = 8192;  // texels a side: what looks have on the GPU

// Texels a side at which a texel holds no more surface than a pixel, from the atlas' lowest
// resolution to the largest.
int orthophoto_resolution(const Model& model, const query::WorldFile& world);

// The orthophoto's colours by places in its plane. Thread-safe.
class OrthophotoSampler {
 public:
  // `texel_area` in the square of the plane's unit: pixels much smaller than it are averaged, as
  // light.
  OrthophotoSampler(Picture picture, const query::WorldFile& world, double texel_area);
  // Between the pixels: RGB with an alpha of 255, the first byte red. Nothing outside of the
  // picture, or where less than half is opaque.
  std::optional<std::uint32_t> color_at(const glm::dvec2& place) const;

 private:
  query::PixelFinder finder_;
  int height_;
  render::MipmappedPicture::Level level_;  // lowest row first
  double scale_;                           // its pixels to those of the picture
};

// The picture of u32 texels as `color_at` gives them, top row first. Surface that is not set is
// clear, in colours that go on from what is; off the surface colours and cover go on from the
// islands: so neither seams nor borders show where it is filtered.
Picture orthophoto_surface_image(const TileMap& colors, const mesh::SurfaceMap& map);

}  // namespace strata::jobs
