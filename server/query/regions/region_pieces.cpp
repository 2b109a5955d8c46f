#include "query/regions/region_pieces.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "core/progress.h"
#include "domain/layers/mask_texels.h"
#include "mesh/texels/slot_bits.h"
#include "mesh/texels/texel_graph.h"
#include "query/statistics/perimeter.h"

namespace strata::query {
namespace {

// Numbers the requested regions, the largest first.
std::vector<std::uint32_t> pieces_in_order(const Regions& regions, const PieceRequest& request) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < regions.list.size(); ++i) {
    const Region& region = regions.list[i];
    if (region.value.valid && (!request.of || region.value.bits == *request.of) &&
        region.area >= request.min_area)
      order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::uint32_t i) { return regions.list[i].area; });
  return order;
}

// Returns the numbers of the pieces as a layer, starting at 1.
LayerView layer_of_numbers(const std::vector<std::uint32_t>& piece_of_texel,
                           const mesh::SurfaceMap& map) {
  LayerView view;
  view.layer.type = ValueType::u32;
  view.layer.resolution = map.resolution;
  const int tiles_per_side = map.resolution / kTileSize;
  for (int y = 0; y < tiles_per_side; ++y)
    for (int x = 0; x < tiles_per_side; ++x) {
      const TileAddress address{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
      auto tile = std::make_shared<TileData>(ValueType::u32);
      for_each_texel(map.surface_in_tile(address), [&](int texel) {
        const mesh::SlotTexel at = mesh::slot_texel(map, address, texel);
        const std::uint32_t piece =
            piece_of_texel[at.slot * 64 + static_cast<std::uint32_t>(at.texel)];
        if (piece != kNoRegion) tile->write(texel, piece + 1);
      });
      if (tile->valid.any()) view.snapshot.tiles[address] = std::move(tile);
    }
  return view;
}

}  // namespace

Result<Pieces> find_pieces(const SurfaceValues& values, const PieceRequest& request,
                           const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                           Progress& progress, int threads) {
  progress.report(0, "Finding pieces");
  Regions regions =
      STRATA_TRY(find_regions(values, map, graph, progress, kMaxRegions, request.connection));
  const auto order = pieces_in_order(regions, request);
  if (order.size() > request.max_pieces)
    return fail(ErrorCode::invalid, "Too many pieces",
                "The painted area has " + std::to_string(order.size()) + " pieces, and at most " +
                    std::to_string(request.max_pieces) +
                    " are allowed. Choose a larger smallest area, or clean up small regions first.",
                "min_area_cm2");
  std::vector<std::uint32_t> piece_of(regions.list.size(), kNoRegion);
  Pieces pieces;
  for (const std::uint32_t region : order) {
    piece_of[region] = static_cast<std::uint32_t>(pieces.list.size());
    const Region& from = regions.list[region];
    pieces.list.push_back({from.value, from.texels, from.area, 0, glm::dvec3(0)});
  }
  pieces.of_texel = std::move(regions.of_texel);
  for (std::uint32_t texel = 0; texel < pieces.of_texel.size(); ++texel) {
    if (texel % (1 << 18) == 0 && progress.cancelled()) return cancelled_problem();
    std::uint32_t& of = pieces.of_texel[texel];
    if (of != kNoRegion) of = piece_of[of];
    if (of != kNoRegion)
      pieces.list[of].center += double(map.area[texel]) *
                                glm::dvec3(map.position(texel / 64, static_cast<int>(texel % 64)));
  }
  progress.report(0.5, "Measuring perimeters");
  const auto perimeters = measure_perimeters(layer_of_numbers(pieces.of_texel, map), map, graph,
                                             nullptr, {.each = true}, threads, &progress);
  if (progress.cancelled()) return cancelled_problem();
  for (std::uint32_t i = 0; i < pieces.list.size(); ++i) {
    Piece& piece = pieces.list[i];
    if (piece.area > 0) piece.center /= piece.area;
    if (const auto found = perimeters.of_class.find(i + 1); found != perimeters.of_class.end())
      piece.perimeter = found->second;
  }
  return pieces;
}

Result<void> reorder(Pieces& pieces, const std::vector<std::uint32_t>& order,
                     const Progress& progress) {
  std::vector<std::uint32_t> place(order.size());
  std::vector<Piece> list;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    list.push_back(pieces.list[order[i]]);
  }
  pieces.list = std::move(list);
  for (std::size_t texel = 0; texel < pieces.of_texel.size(); ++texel) {
    if (texel % (1 << 18) == 0 && progress.cancelled()) return cancelled_problem();
    if (std::uint32_t& of = pieces.of_texel[texel]; of != kNoRegion) of = place[of];
  }
  return {};
}

}  // namespace strata::query
