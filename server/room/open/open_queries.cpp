// Questions to an open model. They are answered from mirrors and maps in main memory, in parallel
// with painting.
#include <algorithm>
#include <map>
#include <set>

#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "mesh/rollout/rollout_rays.h"
#include "query/conditions/changed_texels.h"
#include "query/conditions/texel_values.h"
#include "query/sampling/nearest_points.h"
#include "query/sampling/profile.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "room/open/open_queries.h"
#include "room/pipeline/region.h"
#include "room/pipeline/tile_changes.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// Returns whether nothing is painted on the layer. If so, the answer does not need the surface.
bool is_empty(const query::LayerView& view) {
  return std::ranges::none_of(view.snapshot.tiles,
                              [](const auto& tile) { return tile.second != nullptr; });
}

query::Statistics nothing_painted(const StatisticsOptions& options) {
  query::Statistics none;
  if (options.pieces) none.pieces = 0;
  if (options.perimeter) none.perimeter_m = 0;
  return none;
}

}  // namespace

Result<TileMirror::Snapshot> OpenRoom::QueriesPart::tiles(const std::string& layer, At at) {
  room_.touch();
  auto found = STRATA_TRY(room_.state(layer));
  return room_.tiles_at(found, at);
}

Result<LayerDifference> OpenRoom::QueriesPart::difference(const std::string& layer, At one,
                                                          At other,
                                                          const std::optional<Outline>& outline) {
  room_.touch();
  const auto found = STRATA_TRY(room_.state(layer));
  const auto from = STRATA_TRY(room_.tiles_at(found, one));
  const auto to = STRATA_TRY(room_.tiles_at(found, other));
  const auto map = STRATA_TRY(room_.surface_map(found.layer.resolution));
  check_question();
  auto changes = replace_content(from.tiles, to.tiles, found.layer.type, *map);
  if (outline) {
    const auto masks = STRATA_TRY(texels_in(*outline, *map, *room_.surface_lookup_,
                                            room_.services_.renderer, room_.model_handle()));
    changes = only_within(std::move(changes), masks);
  }
  LayerDifference difference;
  double area = 0;
  for (const TileChange& change : changes) {
    check_question();
    const ChangeCount count = count_changes(change, *map);
    difference.texels += count.texels;
    area += count.area;
  }
  const double metres = room_.model().metres();
  difference.area_m2 = area * metres * metres;
  difference.share = map->area_total > 0 ? std::min(1.0, area / map->area_total) : 0;
  return difference;
}

Result<query::SurfacePoint> OpenRoom::QueriesPart::position(const glm::dvec3& world,
                                                            const std::vector<std::string>& layers,
                                                            At at) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views(layers, at));
  return query::nearest_point(*room_.surface_lookup_->tree(), room_.geometry_->origin, world,
                              views);
}

Result<std::vector<query::SurfacePoint>> OpenRoom::QueriesPart::positions(
    const std::vector<glm::dvec3>& world, const std::vector<std::string>& layers, At at) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views(layers, at));
  return query::nearest_points(*room_.surface_lookup_->tree(), room_.geometry_->origin, world,
                               views, mesh::background_threads());
}

Result<query::SurfacePoint> OpenRoom::QueriesPart::pick(const Camera& camera, double x, double y,
                                                        const std::vector<std::string>& layers,
                                                        At at) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views(layers, at));
  return query::pick(*room_.surface_lookup_->tree(), room_.geometry_->origin, camera, x, y, views);
}

// The journal reads only the tiles that differ from a state near the requested one. Even for an old
// state, there are few such tiles.
Result<OpenRoom::QueriesPart::ChangedLayer> OpenRoom::QueriesPart::changed_layer(
    const std::string& slug, const ChangedSequences& last) {
  const auto found = STRATA_TRY(room_.state(slug));
  store::Journal& journal = room_.services_.store.journal();
  const auto edit_of = [&](const std::map<LayerId, std::int64_t>& edits) {
    const auto of_layer = edits.find(found.layer.id);
    return of_layer == edits.end() ? 0 : of_layer->second;
  };
  const auto near = room_.durable_tiles(found.layer);
  auto to = STRATA_TRY(near ? journal.load_tiles_near(found.layer, edit_of(last.to), *near)
                            : journal.load_tiles(found.layer, std::optional(edit_of(last.to))));
  auto from = STRATA_TRY(journal.load_tiles_near(found.layer, edit_of(last.from), to));
  return ChangedLayer{found.layer, std::move(from), std::move(to)};
}

Result<std::vector<query::TexelSelection>> OpenRoom::QueriesPart::changed_texels(
    const Selection::Changed& states, std::span<const mesh::SurfaceMap* const> maps) {
  STRATA_TRY(room_.check_durable(states.from));
  STRATA_TRY(room_.check_durable(states.to));
  store::Journal& journal = room_.services_.store.journal();
  ChangedSequences last;
  last.from = STRATA_TRY(journal.layer_sequences(room_.model().id, states.from));
  last.to = STRATA_TRY(journal.layer_sequences(room_.model().id, states.to));
  std::vector<query::TexelSelection> changed;
  for (const mesh::SurfaceMap* map : maps) changed.emplace_back(map->block_of_slot.size(), 0);
  for (const std::string& slug : std::set(states.layers.begin(), states.layers.end())) {
    check_question();
    const auto layer = STRATA_TRY(changed_layer(slug, last));
    const QuestionMemory memory(query::bytes_apart(layer.from.tiles, layer.to.tiles));
    check_question();
    for (std::size_t i = 0; i < maps.size(); ++i)
      query::add_changed_texels(layer.layer, layer.from.tiles, layer.to.tiles, *maps[i],
                                mesh::background_threads(), changed[i]);
  }
  return changed;
}

Result<std::optional<query::TexelSelection>> OpenRoom::QueriesPart::select_texels(
    const Selection& selection, const mesh::SurfaceMap& map) {
  const mesh::SurfaceMap* const maps[] = {&map};
  auto selected = STRATA_TRY(select_texels(selection, maps));
  return std::move(selected.front());
}

Result<std::vector<std::optional<query::TexelSelection>>> OpenRoom::QueriesPart::select_texels(
    const Selection& selection, std::span<const mesh::SurfaceMap* const> maps) {
  std::vector<query::TexelSelection> changed;
  if (selection.changed) changed = STRATA_TRY(changed_texels(*selection.changed, maps));
  std::vector<std::optional<query::TexelSelection>> selected;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    auto texels =
        STRATA_TRY(select_texels(selection, *maps[i], selection.changed ? &changed[i] : nullptr));
    selected.push_back(std::move(texels));
  }
  return selected;
}

Result<std::optional<query::TexelSelection>> OpenRoom::QueriesPart::select_texels(
    const Selection& selection, const mesh::SurfaceMap& map, const query::TexelSelection* changed) {
  auto inside = texels_within(selection, map);
  if (!inside) return inside;
  if (changed && *inside)
    combine(**inside, *changed, Combination::intersect);
  else if (changed)
    *inside = *changed;
  if (!selection.where) return inside;
  auto holds = STRATA_TRY(
      texels_where(*selection.where, selection, map, "where", *inside ? &**inside : nullptr));
  return holds;
}

Result<query::Statistics> OpenRoom::QueriesPart::count(const query::LayerView& view,
                                                       const mesh::SurfaceMap& map,
                                                       const query::TexelSelection* within,
                                                       bool is_now,
                                                       const StatisticsOptions& options) {
  query::StatisticsRequest request;
  request.within = within;
  request.quantiles = options.quantiles;
  request.pieces = options.pieces;
  request.perimeter = options.perimeter;
  request.threads = mesh::background_threads();
  std::shared_ptr<const mesh::TexelGraph> graph;
  if (options.pieces || options.perimeter) {
    auto found = STRATA_TRY(room_.surface_lookup_->graph(map));
    graph = std::move(found);
    request.graph = graph.get();
  }
  const auto found = room_.state(view.layer.slug);
  if (found && is_now) request.cache = found->sums.get();
  return query::statistics(view, map, room_.geometry_->origin, room_.model().metres(), request);
}

Result<query::Statistics> OpenRoom::QueriesPart::statistics(const std::string& layer,
                                                            const Selection& selection,
                                                            StatisticsOptions options) {
  room_.touch();
  const auto views = STRATA_TRY(room_.layer_views({layer}, selection.at));
  if (is_empty(views.front()) && selection.whole()) return nothing_painted(options);
  const auto map = STRATA_TRY(room_.surface_map(views.front().layer.resolution));
  const auto selected = STRATA_TRY(select_texels(selection, *map));
  return count(views.front(), *map, selected ? &*selected : nullptr, !selection.at, options);
}

int OpenRoom::QueriesPart::resolution_read_by(const Selection& selection) const {
  int resolution = 0;
  for (const auto& slug : layers_read_by(selection))
    if (const auto found = room_.state(slug))
      resolution = std::max(resolution, found->layer.resolution);
  return resolution;
}

Result<SelectedArea> OpenRoom::QueriesPart::select(const Selection& selection,
                                                   const std::vector<std::string>& layers,
                                                   StatisticsOptions options) {
  room_.touch();
  const auto views = STRATA_TRY(room_.layer_views(layers, selection.at));
  SelectedArea area;
  area.resolution = resolution_read_by(selection);
  for (const auto& view : views) area.resolution = std::max(area.resolution, view.layer.resolution);
  std::optional<int> of_painted;
  if (options.painted) {
    of_painted = STRATA_TRY(room_.state(*options.painted)).layer.resolution;
    area.resolution = std::max(area.resolution, *of_painted);
  }
  if (area.resolution == 0) area.resolution = room_.model().default_resolution;
  struct Selected {
    std::shared_ptr<const mesh::SurfaceMap> map;
    std::optional<query::TexelSelection> texels;
    const query::TexelSelection* within() const { return texels ? &*texels : nullptr; }
  };
  std::map<int, Selected> of_resolution;  // the selection for each resolution, shared by its layers
  std::set<int> resolutions{area.resolution};
  if (of_painted) resolutions.insert(*of_painted);
  for (const auto& view : views) resolutions.insert(view.layer.resolution);
  std::vector<std::shared_ptr<const mesh::SurfaceMap>> maps;
  std::vector<const mesh::SurfaceMap*> of_maps;
  for (const int resolution : resolutions) {
    auto map = STRATA_TRY(room_.surface_map(resolution));
    of_maps.push_back(map.get());
    maps.push_back(std::move(map));
  }
  auto selected = STRATA_TRY(select_texels(selection, of_maps));
  for (std::size_t i = 0; i < maps.size(); ++i)
    of_resolution[maps[i]->resolution] = {maps[i], std::move(selected[i])};
  const Selected& finest = of_resolution.at(area.resolution);
  const double m2_per_unit2 = room_.model().metres() * room_.model().metres();
  const auto extent =
      query::measure_selection(*finest.map, finest.within(), mesh::background_threads());
  area.texels = extent.texels;
  area.area_m2 = extent.area * m2_per_unit2;
  area.share = finest.map->area_total > 0 ? std::min(1.0, extent.area / finest.map->area_total) : 0;
  area.bounds_min = glm::dvec3(extent.low) + room_.geometry_->origin;
  area.bounds_max = glm::dvec3(extent.high) + room_.geometry_->origin;
  if (const auto& grid = options.seen)
    area.seen =
        query::seen_selection(*room_.surface_lookup_->tree(), room_.geometry_->origin, grid->camera,
                              grid->columns, grid->rows, *finest.map, finest.within());
  for (const auto& view : views) {
    const Selected& here = of_resolution.at(view.layer.resolution);
    auto counted = STRATA_TRY(count(view, *here.map, here.within(), !selection.at, options));
    area.layers.emplace(view.layer.slug, std::move(counted));
  }
  if (of_painted)
    if (auto& texels = of_resolution.at(*of_painted).texels)
      area.painted = SelectedArea::Texels{*of_painted, std::move(*texels)};
  return area;
}

Result<SelectedArea::Texels> OpenRoom::QueriesPart::selected_texels(const Selection& selection) {
  room_.touch();
  int resolution = resolution_read_by(selection);
  if (resolution == 0) resolution = room_.model().default_resolution;
  const auto map = STRATA_TRY(room_.surface_map(resolution));
  auto texels = STRATA_TRY(select_texels(selection, *map));
  return SelectedArea::Texels{resolution, std::move(texels.value())};
}

Result<query::Profile> OpenRoom::QueriesPart::profile(const ProfileLine& line,
                                                      const std::vector<std::string>& layers,
                                                      At at) {
  room_.touch();
  const auto views = STRATA_TRY(room_.layer_views(layers, at));
  const auto tree = room_.surface_lookup_->tree();
  if (const auto* seen = std::get_if<SeenLine>(&line))
    return query::profile_seen(*tree, room_.geometry_->origin, seen->camera, seen->path, views);
  if (const auto* unrolled = std::get_if<UnrolledLine>(&line)) {
    const auto fitted = STRATA_TRY(fitted_sheet(unrolled->fit, unrolled->cut, "unrolled"));
    const mesh::RolloutRays rays(*tree, *room_.geometry_, fitted->sheet);
    return query::profile_unrolled(rays, room_.geometry_->origin, unrolled->path, unrolled->step,
                                   views);
  }
  const auto& steps = std::get<PlacesInSteps>(line);
  return query::profile_near(*tree, room_.geometry_->origin, steps.places, steps.step, views);
}

Result<query::CrossTable> OpenRoom::QueriesPart::cross_table(const std::string& rows,
                                                             const std::string& columns,
                                                             const Selection& selection) {
  room_.touch();
  const auto views = STRATA_TRY(room_.layer_views({rows, columns}, selection.at));
  const auto map =
      room_.surface_map(std::max(views[0].layer.resolution, views[1].layer.resolution));
  if (!map) return tl::unexpected(map.error());
  const auto selected = STRATA_TRY(select_texels(selection, **map));
  return query::cross_tabulate(views[0], views[1], **map, selected ? &*selected : nullptr,
                               room_.model().metres());
}

Result<OpenRoom::QueriesPart::LayerGraph> OpenRoom::QueriesPart::layer_graph(
    const std::string& layer, At at) {
  auto views = STRATA_TRY(room_.layer_views({layer}, at));
  auto map = STRATA_TRY(room_.surface_map(views.front().layer.resolution));
  auto graph = STRATA_TRY(room_.surface_lookup_->graph(*map));
  return LayerGraph{std::move(views.front()), std::move(map), std::move(graph)};
}

Result<query::Quantities> OpenRoom::QueriesPart::quantities(const std::string& layer, At at) {
  room_.touch();
  const auto found = STRATA_TRY(layer_graph(layer, at));
  return query::quantities(found.view, *found.map, *found.graph,
                           query::classes_of(found.view.layer), room_.model().metres());
}

Result<LayerAreas> OpenRoom::QueriesPart::layer_areas(const std::string& layer, At at) {
  room_.touch();
  auto found = STRATA_TRY(layer_graph(layer, at));
  const query::ValueClasses classes = query::classes_of(found.view.layer);
  auto quantities =
      query::quantities(found.view, *found.map, *found.graph, classes, room_.model().metres());
  if (!quantities) return tl::unexpected(quantities.error());
  auto perimeters = query::measure_perimeters(found.view, *found.map, *found.graph, nullptr,
                                              classes, mesh::background_threads());
  return LayerAreas{std::move(found.view), std::move(found.map), std::move(*quantities),
                    std::move(perimeters)};
}

Result<query::SurfaceTexels> OpenRoom::QueriesPart::surface_texels(const std::string& layer,
                                                                   const Selection& selection) {
  room_.touch();
  auto views = STRATA_TRY(room_.layer_views({layer}, selection.at));
  auto map = STRATA_TRY(room_.surface_map(views.front().layer.resolution));
  auto selected = STRATA_TRY(select_texels(selection, *map));
  return query::SurfaceTexels{std::move(views.front()), std::move(map), std::move(selected),
                              room_.geometry_->origin, room_.model().metres()};
}

Result<std::map<std::int64_t, query::KeyArea>> OpenRoom::QueriesPart::key_areas(
    const std::string& layer, At at) {
  room_.touch();
  const auto found = STRATA_TRY(room_.state(layer));
  auto tiles = STRATA_TRY(room_.tiles_at(found, at));
  const auto map = STRATA_TRY(room_.surface_map(found.layer.resolution));
  // The cache is for the current tiles.
  return query::key_areas({found.layer, std::move(tiles)}, *map, room_.geometry_->origin,
                          room_.model().metres(), at ? nullptr : found.sums.get());
}

}  // namespace strata::room
