#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "media/picture.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "mesh/texels/texel_owners.h"

namespace strata::query {

// The appearance of the texels of a surface map: colors or normals, 64 per slot, in the order of
// SurfaceMap. The entries of texels that are not surface texels are undefined. All functions use
// several threads, and the result does not depend on their number. They fail when cancelled.
using TexelAppearance = std::vector<std::uint32_t>;

// Colors are sRGB, red in the low byte, alpha in the high byte.
inline bool has_color(std::uint32_t color) { return color >> 24 >= 128; }

// Returns the interpolated colors of the vertices. `owners` belong to the map and to the geometry.
Result<TexelAppearance> vertex_colors_of_texels(const mesh::Geometry& geometry,
                                                const mesh::TexelOwners& owners, Progress& progress,
                                                int threads);

// Draws an image in the atlas over the colors, with its alpha times `opacity`. An image that is
// finer than the map is averaged as light.
Result<void> draw_over(TexelAppearance& colors, Picture picture, float opacity,
                       const mesh::SurfaceMap& map, Progress& progress, int threads);

// Normals are octahedral (Meyer et al. 2010: On floating-point normal vectors), with x in the low
// and y in the high 16 bits, as snorm.
constexpr std::uint32_t kNoNormal = 0x80008000u;       // no normal is packed like this
std::uint32_t packed_normal(const glm::vec3& normal);  // kNoNormal for a vector without direction
glm::vec3 unpacked_normal(std::uint32_t packed);

// Returns the normals of SurfaceNormals. `owners` belong to the geometry.
Result<TexelAppearance> normals_of_texels(const std::shared_ptr<const mesh::Geometry>& geometry,
                                          const mesh::TexelOwners& owners, Progress& progress,
                                          int threads);

}  // namespace strata::query
