#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "domain/people/question.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/texel_selection.h"
#include "query/conditions/texel_values.h"
#include "query/sampling/values.h"

namespace strata::query {

// One layer with the positions of its texels, now or at an earlier time.
struct SurfaceTexels {
  LayerView view;
  std::shared_ptr<const mesh::SurfaceMap> map;  // surface map with the resolution of the layer
  std::optional<TexelSelection> within;         // empty: the whole surface
  glm::dvec3 origin{0};                         // origin of model space, in world coordinates
  double metres_per_unit = 1;
};

struct TexelSample {
  glm::dvec3 position{0};  // world, model units
  double area_m2 = 0;
  std::uint32_t bits = 0;
  double value = 0;
};

// Calls visit(sample) for each valid surface texel that is selected, in ascending order of tiles.
// Stops when `visit` returns false.
template <class Visit>
void for_each_sample(const SurfaceTexels& texels, Visit&& visit) {
  const double m2_per_unit2 = texels.metres_per_unit * texels.metres_per_unit;
  const mesh::SurfaceMap& map = *texels.map;
  bool goes_on = true;
  for (const auto& [address, tile] : sorted_tiles(texels.view.snapshot.tiles)) {
    check_question();
    for_each_value(
        *tile, address, texels.view.layer.type, map, texels.within ? &*texels.within : nullptr,
        [&](std::uint32_t slot, int texel, std::uint32_t bits, double value) {
          if (!goes_on) return;
          const auto place = std::size_t{slot} * 64 + static_cast<std::size_t>(texel);
          goes_on = visit(TexelSample{texels.origin + glm::dvec3(map.position(slot, texel)),
                                      map.area[place] * m2_per_unit2, bits, value});
        });
    if (!goes_on) return;
  }
}

inline constexpr std::size_t kMaxCells = 2'000'000;

// Groups the selected valid surface texels by cells of a grid through the origin of the world. The
// cells are cubes with edges of `edge` model units. A sample has the centroid and the mean of the
// values, both weighted by area, and the sum of the areas. For keys (`classes_of` makes each value
// a class), the value is the key with the largest area, or the lowest of several such keys. Samples
// are ascending by z, y and x. Returns an `invalid` error at `cell` for more than kMaxCells cells,
// or for an edge too small for the cell indices.
Result<std::vector<TexelSample>> samples_by_cell(const SurfaceTexels& texels, double edge);

}  // namespace strata::query
