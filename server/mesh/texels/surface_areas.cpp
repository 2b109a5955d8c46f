#include <algorithm>
#include <cmath>

#include "mesh/texels/surface_bake.h"
#include "mesh/texels/texel_pieces.h"

namespace strata::mesh {

void SurfaceBake::credit_areas(int band) {
  const int y_low = first_row(band), y_high = first_row(band + 1);
  auto& leftovers = leftovers_[band];
  TexelPieces pieces;
  for (const std::uint32_t t : triangles_of_band_[band]) {
    if (triangle_area_[t] <= 0) continue;
    const auto island = islands_.of_triangle[t];
    const auto credit = [&](int x, int y, double area) {
      x = std::min(x, resolution_ - 1), y = std::min(y, resolution_ - 1);
      const auto holder = owner(x, y);
      if (holder != kNobody && islands_.of_triangle[holder] == island)
        map_.area[texel_index(x, y)] += static_cast<float>(area);
      else
        leftovers.push_back(
            {static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(resolution_) +
                 static_cast<std::uint32_t>(x),
             t, static_cast<float>(area)});
    };
    pieces.set(texels_at(t, 0), texels_at(t, 1), texels_at(t, 2));
    if (pieces.is_line()) {
      const auto texel = centroid_texel(t);
      const int y = static_cast<int>(texel / resolution_);
      if (y >= y_low && y < y_high)
        credit(static_cast<int>(texel % resolution_), y, triangle_area_[t]);
      continue;
    }
    const double area_per_texel = triangle_area_[t] / pieces.area();
    pieces.for_each(y_low, y_high,
                    [&](int x, int y, double piece) { credit(x, y, piece * area_per_texel); });
  }
}

// Returns the surface texel that receives the area of a triangle on a texel that the triangle's
// island does not own. This is the nearest texel of that island within the gutter's width. If no
// such texel exists, because a tip is too thin to cover centers, it is the nearest texel that the
// triangle covers. If the triangle covers no texel, it is the texel that contains the centroid of
// the triangle. That texel is always a surface texel.
glm::ivec2 SurfaceBake::heir_of(const Leftover& leftover) const {
  const int x = static_cast<int>(leftover.texel % resolution_),
            y = static_cast<int>(leftover.texel / resolution_);
  glm::ivec2 found;
  if (nearest_surface(x, y, islands_.of_triangle[leftover.triangle], found)) return found;
  std::int64_t least = -1;
  raster_of(leftover.triangle)
      .for_each_span(0, resolution_, 0, resolution_, [&](int row, int begin, int end) {
        const int column = std::clamp(x, begin, end - 1);
        const std::int64_t dx = column - x, dy = row - y, squared = dx * dx + dy * dy;
        if (least < 0 || squared < least) least = squared, found = {column, row};
        return true;
      });
  if (least >= 0) return found;
  const auto texel = centroid_texel(leftover.triangle);
  return {texel % resolution_, texel / resolution_};
}

void SurfaceBake::credit_leftovers() {
  for (const auto& leftovers : leftovers_)
    for (const Leftover& leftover : leftovers) {
      const glm::ivec2 heir = heir_of(leftover);
      map_.area[texel_index(heir.x, heir.y)] += leftover.area;
    }
  for (const auto overlaps : overlaps_of_band_) map_.overlap_texels += overlaps;
}

}  // namespace strata::mesh
