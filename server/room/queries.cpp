// Questions to an open model: they are answered from mirrors and maps in main memory, beside those
// who paint.
#include <algorithm>
#include <map>
#include <set>

#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/expression_evaluator.h"
#include "query/conditions/flood.h"
#include "query/conditions/texel_values.h"
#include "query/sampling/nearest_points.h"
#include "room/expression_binding.h"
#include "room/open_room.h"
#include "room/region.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// A mask's surface texels, a word a slot.
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

// Whether nothing is painted on it: then nothing need be known of the surface to say so.
bool is_empty(const query::LayerView& view) {
  return std::ranges::none_of(view.snapshot.tiles,
                              [](const auto& tile) { return tile.second != nullptr; });
}

query::Statistics nothing_painted(StatisticsWanted wanted) {
  query::Statistics none;
  if (wanted.pieces) none.pieces = 0;
  if (wanted.perimeter) none.perimeter_m = 0;
  return none;
}

}  // namespace

Result<TileMirror::Snapshot> OpenRoom::tiles_at(const LayerState& state, At at) const {
  if (!at) return state.mirror->snapshot();
  if (*at > durable_)
    return fail(ErrorCode::invalid, "Sequence not reached",
                "The newest durable edit of this model is " + std::to_string(durable_) + ".", "at");
  return parts_.store.journal().load_tiles(state.layer, at);
}

Result<TileMirror::Snapshot> OpenRoom::tiles(const std::string& layer, At at) {
  touch();
  auto found = STRATA_TRY(state(layer));
  return tiles_at(found, at);
}

Result<std::vector<query::LayerView>> OpenRoom::layer_views(const std::vector<std::string>& refs,
                                                            At at) const {
  std::vector<query::LayerView> views;
  for (const auto& ref : refs) {
    auto found = STRATA_TRY(state(ref));
    auto tiles = STRATA_TRY(tiles_at(found, at));
    views.push_back({found.layer, std::move(tiles)});
  }
  return views;
}

Result<query::SurfacePoint> OpenRoom::position(const glm::dvec3& world,
                                               const std::vector<std::string>& layers, At at) {
  touch();
  auto views = STRATA_TRY(layer_views(layers, at));
  return query::nearest_point(*surface_->tree(), geometry_->origin, world, views);
}

Result<std::vector<query::SurfacePoint>> OpenRoom::positions(const std::vector<glm::dvec3>& world,
                                                             const std::vector<std::string>& layers,
                                                             At at) {
  touch();
  auto views = STRATA_TRY(layer_views(layers, at));
  return query::nearest_points(*surface_->tree(), geometry_->origin, world, views,
                               mesh::background_threads());
}

Result<query::SurfacePoint> OpenRoom::pick(const Camera& camera, double x, double y,
                                           const std::vector<std::string>& layers, At at) {
  touch();
  auto views = STRATA_TRY(layer_views(layers, at));
  return query::pick(*surface_->tree(), geometry_->origin, camera, x, y, views);
}

Result<std::vector<std::optional<std::uint32_t>>> OpenRoom::seen_keys(const std::string& layer,
                                                                      const Camera& camera,
                                                                      int columns, int rows,
                                                                      At at) {
  touch();
  auto views = STRATA_TRY(layer_views({layer}, at));
  return query::seen_keys(*surface_->tree(), geometry_->origin, camera, columns, rows,
                          views.front());
}

Result<std::vector<query::SeenLayer>> OpenRoom::seen_layers(
    const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
    const Camera& camera, int columns, int rows, At at) {
  touch();
  auto views = STRATA_TRY(layer_views(layers, at));
  return query::seen_layers(*surface_->tree(), geometry_->origin, camera, columns, rows, views,
                            covers);
}

Result<std::optional<query::TexelSelection>> OpenRoom::texels_within(const Selection& selection,
                                                                     const mesh::SurfaceMap& map) {
  if (!selection.within) return std::nullopt;
  if (const auto* outline = std::get_if<Outline>(&*selection.within)) {
    const auto masks =
        STRATA_TRY(texels_in(*outline, map, *surface_, parts_.renderer, model_handle()));
    return as_selection(masks, map);
  }
  const auto& around = std::get<Selection::Around>(*selection.within);
  const auto start = STRATA_TRY(find_place(around.at, map, *surface_, "within.at"));
  const auto graph = STRATA_TRY(surface_->graph(map));
  return query::select_near(map, *graph, start.texel, start.position,
                            static_cast<float>(around.radius));
}

// Nothing where the whole surface is meant. A condition is looked at within the place alone, so
// that a small one is quickly answered.
Result<std::optional<query::TexelSelection>> OpenRoom::select_texels(const Selection& selection,
                                                                     const mesh::SurfaceMap& map) {
  auto inside = texels_within(selection, map);
  if (!inside || !selection.where) return inside;
  std::vector<std::string> slugs;
  for (const auto& layer : layers())
    if (sees(selection.seen_by, layer.visibility)) slugs.push_back(layer.slug);
  const std::vector<std::string> named = layers_of(*selection.where);
  // Those that are not there are refused by the evaluator, with the field.
  std::erase_if(slugs,
                [&](const auto& slug) { return std::ranges::find(named, slug) == named.end(); });
  const auto views = STRATA_TRY(layer_views(slugs, selection.at));
  const auto bound = STRATA_TRY(bind_expression(*selection.where, views, parts_.store,
                                                selection.seen_by, selection.at, "where"));
  auto holds =
      query::select_where(bound, views, map, "where", mesh::background_threads(),
                          {geometry_->origin, model().metres()}, *inside ? &**inside : nullptr);
  if (!holds) return tl::unexpected(holds.error());
  return std::move(*holds);
}

Result<query::Statistics> OpenRoom::count(const query::LayerView& view, const mesh::SurfaceMap& map,
                                          const query::TexelSelection* within, bool is_now,
                                          StatisticsWanted wanted) {
  query::StatisticsRequest request;
  request.within = within;
  request.quantiles = wanted.quantiles;
  request.pieces = wanted.pieces;
  request.perimeter = wanted.perimeter;
  request.threads = mesh::background_threads();
  std::shared_ptr<const mesh::TexelGraph> graph;
  if (wanted.pieces || wanted.perimeter) {
    auto found = STRATA_TRY(surface_->graph(map));
    graph = std::move(found);
    request.graph = graph.get();
  }
  const auto found = state(view.layer.slug);
  if (found && is_now) request.cache = found->sums.get();
  return query::statistics(view, map, geometry_->origin, model().metres(), request);
}

Result<query::Statistics> OpenRoom::statistics(const std::string& layer, const Selection& selection,
                                               StatisticsWanted wanted) {
  touch();
  const auto views = STRATA_TRY(layer_views({layer}, selection.at));
  if (is_empty(views.front()) && selection.whole()) return nothing_painted(wanted);
  const auto map = STRATA_TRY(surface_map(views.front().layer.resolution));
  const auto selected = STRATA_TRY(select_texels(selection, *map));
  return count(views.front(), *map, selected ? &*selected : nullptr, !selection.at, wanted);
}

Result<SelectedArea> OpenRoom::select(const Selection& selection,
                                      const std::vector<std::string>& layers,
                                      StatisticsWanted wanted) {
  touch();
  const auto views = STRATA_TRY(layer_views(layers, selection.at));
  SelectedArea area;
  for (const auto& view : views) area.resolution = std::max(area.resolution, view.layer.resolution);
  if (selection.where)
    for (const auto& slug : layers_of(*selection.where))
      if (const auto found = state(slug))
        area.resolution = std::max(area.resolution, found->layer.resolution);
  if (area.resolution == 0) area.resolution = model().default_resolution;
  struct Selected {
    std::shared_ptr<const mesh::SurfaceMap> map;
    std::optional<query::TexelSelection> texels;
    const query::TexelSelection* within() const { return texels ? &*texels : nullptr; }
  };
  std::map<int, Selected> of_resolution;  // layers of one resolution share it
  std::set<int> resolutions{area.resolution};
  for (const auto& view : views) resolutions.insert(view.layer.resolution);
  for (const int resolution : resolutions) {
    auto map = STRATA_TRY(surface_map(resolution));
    auto selected = STRATA_TRY(select_texels(selection, *map));
    of_resolution[resolution] = {std::move(map), std::move(selected)};
  }
  const Selected& finest = of_resolution.at(area.resolution);
  const double m2_per_unit2 = model().metres() * model().metres();
  const auto extent =
      query::measure_selection(*finest.map, finest.within(), mesh::background_threads());
  area.texels = extent.texels;
  area.area_m2 = extent.area * m2_per_unit2;
  area.share = finest.map->area_total > 0 ? std::min(1.0, extent.area / finest.map->area_total) : 0;
  area.bounds_min = glm::dvec3(extent.low) + geometry_->origin;
  area.bounds_max = glm::dvec3(extent.high) + geometry_->origin;
  for (const auto& view : views) {
    const Selected& here = of_resolution.at(view.layer.resolution);
    auto counted = STRATA_TRY(count(view, *here.map, here.within(), !selection.at, wanted));
    area.layers.emplace(view.layer.slug, std::move(counted));
  }
  return area;
}

Result<query::Profile> OpenRoom::profile(const ProfileLine& line,
                                         const std::vector<std::string>& layers, At at) {
  touch();
  const auto views = STRATA_TRY(layer_views(layers, at));
  const auto tree = surface_->tree();
  if (const auto* seen = std::get_if<SeenLine>(&line))
    return query::profile_seen(*tree, geometry_->origin, seen->camera, seen->path, views);
  const auto& steps = std::get<PlacesInSteps>(line);
  return query::profile_near(*tree, geometry_->origin, steps.places, steps.step, views);
}

Result<query::CrossTable> OpenRoom::cross_table(const std::string& rows, const std::string& columns,
                                                const Selection& selection) {
  touch();
  const auto views = STRATA_TRY(layer_views({rows, columns}, selection.at));
  const auto map = surface_map(std::max(views[0].layer.resolution, views[1].layer.resolution));
  if (!map) return tl::unexpected(map.error());
  const auto selected = STRATA_TRY(select_texels(selection, **map));
  return query::cross_tabulate(views[0], views[1], **map, selected ? &*selected : nullptr,
                               model().metres());
}

Result<OpenRoom::LayerGraph> OpenRoom::layer_graph(const std::string& layer, At at) {
  auto views = STRATA_TRY(layer_views({layer}, at));
  auto map = STRATA_TRY(surface_map(views.front().layer.resolution));
  auto graph = STRATA_TRY(surface_->graph(*map));
  return LayerGraph{std::move(views.front()), std::move(map), std::move(graph)};
}

Result<query::Quantities> OpenRoom::quantities(const std::string& layer, At at) {
  touch();
  const auto found = STRATA_TRY(layer_graph(layer, at));
  return query::quantities(found.view, *found.map, *found.graph,
                           query::classes_of(found.view.layer), model().metres());
}

Result<LayerAreas> OpenRoom::layer_areas(const std::string& layer, At at) {
  touch();
  auto found = STRATA_TRY(layer_graph(layer, at));
  const query::ValueClasses classes = query::classes_of(found.view.layer);
  auto quantities =
      query::quantities(found.view, *found.map, *found.graph, classes, model().metres());
  if (!quantities) return tl::unexpected(quantities.error());
  auto perimeters = query::measure_perimeters(found.view, *found.map, *found.graph, nullptr,
                                              classes, mesh::background_threads());
  return LayerAreas{std::move(found.view), std::move(found.map), std::move(*quantities),
                    std::move(perimeters)};
}

Result<query::SurfaceTexels> OpenRoom::surface_texels(const std::string& layer,
                                                      const Selection& selection) {
  touch();
  auto views = STRATA_TRY(layer_views({layer}, selection.at));
  auto map = STRATA_TRY(surface_map(views.front().layer.resolution));
  auto selected = STRATA_TRY(select_texels(selection, *map));
  return query::SurfaceTexels{std::move(views.front()), std::move(map), std::move(selected),
                              geometry_->origin, model().metres()};
}

}  // namespace strata::room
