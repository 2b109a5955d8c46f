#include "query/sampling/lightness_tiles.h"

#include <cmath>
#include <utility>

#include "query/regions/surface_values.h"
#include "query/sampling/cielab.h"

namespace strata::query {

Result<TileMap> lightness_tiles(const TexelAppearance& colors, const mesh::SurfaceMap& map,
                                ValueType type, Progress& progress) {
  const std::size_t slots = map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  for (std::uint32_t texel = 0; texel < slots * 64; ++texel) {
    if (texel % (1u << 18) == 0) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(0.9 * double(texel) / double(slots * 64), "Measuring the lightness");
    }
    const bool is_surface = (map.surface_mask[texel / 64] >> texel % 64 & 1u) != 0;
    if (!is_surface || !has_color(colors[texel])) continue;
    const double measured = double{lightness(colors[texel])};
    const auto bits =
        STRATA_TRY(encode_value(type, is_float(type) ? measured : std::round(measured)));
    values.set(texel, {bits, true});
  }
  return make_tiles(type, map, std::move(values), progress);
}

}  // namespace strata::query
