// The evaluation of a part of the surface: its conditions, outlines and positions, their
// combination, and its growth and smoothing.
#include <algorithm>
#include <string>
#include <vector>

#include "core/overloaded.h"
#include "core/progress.h"
#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/expression_evaluator.h"
#include "query/conditions/flood.h"
#include "query/conditions/texel_values.h"
#include "query/conditions/unrolled.h"
#include "query/regions/dilate_erode.h"
#include "room/open/open_queries.h"
#include "room/pipeline/expression_binding.h"
#include "room/pipeline/region.h"

namespace strata::room {
namespace {

// Returns the surface texels of a mask, as one word for each slot.
query::TexelSelection as_selection(const TileMasks& masks, const mesh::SurfaceMap& map) {
  query::TexelSelection selection(map.block_of_slot.size(), 0);
  for (const auto& [address, mask] : masks)
    for (std::uint32_t by = 0; by < query::kBlocksPerTile; ++by)
      for (std::uint32_t bx = 0; bx < query::kBlocksPerTile; ++bx) {
        const auto slot =
            mesh::slot_at(map, static_cast<int>(address.x * query::kBlocksPerTile + bx),
                          static_cast<int>(address.y * query::kBlocksPerTile + by));
        if (slot != mesh::kNoSlot)
          selection[slot] = query::block_bits(mask, static_cast<int>(bx), static_cast<int>(by)) &
                            map.surface_mask[slot];
      }
  return selection;
}

std::uint64_t bytes_of_mask(const mesh::SurfaceMap& map) {
  return map.block_of_slot.size() * sizeof(std::uint64_t);
}

}  // namespace

Result<query::TexelSelection> OpenRoom::QueriesPart::texels_where(
    const Expression& condition, const Selection& selection, const mesh::SurfaceMap& map,
    const std::string& field, const query::TexelSelection* inside) {
  // The evaluator rejects layers that do not exist, and names the field.
  const std::vector<std::string> named = layers_of(condition);
  std::vector<std::string> slugs;
  std::vector<query::LayerView> candidates;
  for (const auto& layer : room_.layer_list())
    if (sees(selection.seen_by, layer.visibility)) {
      if (std::ranges::find(named, layer.slug) != named.end()) slugs.push_back(layer.slug);
      candidates.push_back({layer, {}});
    }
  auto views = STRATA_TRY(room_.layer_views(slugs, selection.at));
  query::BoundExpression bound;
  if (selection.painted_for) {
    for (query::LayerView& candidate : candidates)
      for (query::LayerView& view : views)
        if (view.layer.id == candidate.layer.id) candidate = std::move(view);
    auto for_layer = STRATA_TRY(bind_for_layer(condition, candidates, room_.services_.store,
                                               selection.seen_by, *selection.painted_for, field));
    bound = std::move(for_layer.expression);
    views = std::move(for_layer.layers);
  } else {
    bound = STRATA_TRY(bind_expression(condition, views, room_.services_.store, selection.seen_by,
                                       selection.at, field, &candidates));
  }
  return query::select_where(bound, views, map, field, mesh::background_threads(),
                             {room_.geometry_->origin, room_.model().metres()}, inside);
}

Result<query::TexelSelection> OpenRoom::QueriesPart::texels_of(
    const Selection::Region& region, const Selection& selection, const mesh::SurfaceMap& map,
    const query::TexelSelection* inside) {
  check_question();
  using Texels = Result<query::TexelSelection>;
  // Texels outside `inside` can change the growth.
  const bool is_plain = region.grow == 0 && region.smooth == 0;
  auto texels = STRATA_TRY(std::visit(
      Overloaded{[&](const Selection::Around& around) -> Texels {
                   const auto start = STRATA_TRY(
                       find_place(around.at, map, *room_.surface_lookup_, region.field + ".at"));
                   const auto graph = STRATA_TRY(room_.surface_lookup_->graph(map));
                   return query::select_near(map, *graph, start.texel, start.position,
                                             static_cast<float>(around.radius));
                 },
                 [&](const Outline& outline) -> Texels {
                   const auto masks =
                       STRATA_TRY(texels_in(outline, map, *room_.surface_lookup_,
                                            room_.services_.renderer, room_.model_handle()));
                   return as_selection(masks, map);
                 },
                 [&](const Selection::Like& like) -> Texels {
                   return texels_like(like, selection.at, map, region.field);
                 },
                 [&](const Selection::Where& where) -> Texels {
                   return texels_where(where.condition, selection, map, region.field + ".where",
                                       is_plain ? inside : nullptr);
                 },
                 [&](const Selection::Unrolled& unrolled) -> Texels {
                   return texels_unrolled(unrolled, map, region.field);
                 },
                 [&](const Selection::Combined& combined) -> Texels {
                   return texels_of(combined, selection, map);
                 }},
      region.area));
  if (is_plain) return texels;
  const auto graph = STRATA_TRY(room_.surface_lookup_->graph(map));
  const QuestionMemory memory(query::bytes_to_dilate(map, *graph) + bytes_of_mask(map));
  Progress progress;  // the distances check the question
  const int threads = mesh::background_threads();
  if (region.grow != 0)
    texels = STRATA_TRY(query::grow(texels, region.grow, map, *graph, progress, threads));
  if (region.smooth != 0)
    texels = STRATA_TRY(query::smooth(texels, region.smooth, map, *graph, progress, threads));
  return texels;
}

Result<std::shared_ptr<const mesh::FittedSheet>> OpenRoom::QueriesPart::fitted_sheet(
    const mesh::FitRequest& fit, const std::optional<double>& cut, const std::string& field) {
  auto fitted = room_.surface_lookup_->sheet(fit, cut, room_.model().up);
  if (!fitted) fitted.error().field = field + "." + fitted.error().field;
  return fitted;
}

Result<query::TexelSelection> OpenRoom::QueriesPart::texels_unrolled(
    const Selection::Unrolled& unrolled, const mesh::SurfaceMap& map, const std::string& field) {
  const mesh::Geometry& geometry = *room_.geometry_;
  const auto fitted = STRATA_TRY(fitted_sheet(unrolled.fit, unrolled.cut, field + ".unrolled"));
  const auto tree = room_.surface_lookup_->tree();
  const mesh::RolloutRays rays(*tree, geometry, fitted->sheet);
  const mesh::SheetArea area(unrolled.polygons, unrolled.strokes);
  return query::select_unrolled(map, rays, geometry.origin, area, mesh::background_threads());
}

Result<query::TexelSelection> OpenRoom::QueriesPart::texels_of(const Selection::Combined& combined,
                                                               const Selection& selection,
                                                               const mesh::SurfaceMap& map) {
  const QuestionMemory memory(2 * bytes_of_mask(map));
  query::TexelSelection selected(map.block_of_slot.size(), 0);
  for (const Selection::Region& part : combined.parts) {
    const bool adds = part.combination == Combination::add;
    const auto texels = STRATA_TRY(texels_of(part, selection, map, adds ? nullptr : &selected));
    combine(selected, texels, part.combination);
  }
  return selected;
}

Result<std::optional<query::TexelSelection>> OpenRoom::QueriesPart::texels_within(
    const Selection& selection, const mesh::SurfaceMap& map) {
  if (!selection.within) return std::nullopt;
  auto texels = STRATA_TRY(texels_of(*selection.within, selection, map, nullptr));
  return texels;
}

}  // namespace strata::room
