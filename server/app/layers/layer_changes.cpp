#include "app/layers/layer_changes.h"

#include <cmath>
#include <unordered_set>
#include <utility>

#include "app/layers/cleanup.h"
#include "core/compensated_sum.h"
#include "jobs/counterparts.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "query/regions/lone_pieces.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "store/content/models.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::app {
namespace {

// for the values, the counterparts, the surface map and the graph of one side
constexpr std::uint64_t kComparedBytesPerTexel = 52;
// for the search tree and the normals of the other model
constexpr std::uint64_t kComparedBytesPerTriangle = 24;
constexpr const char* kUse = "the comparison of two surveys";

// A layer on the surface of one of the two models.
struct Side {
  const jobs::ComparedSide& surface;
  const Layer& layer;
  const TileMap& tiles;
  const mesh::SurfaceMap& map;
  const mesh::TexelGraph& graph;
  const query::SurfaceValues& values;  // of the layer

  double m2_per_unit2() const { return surface.metres * surface.metres; }
  query::LayerView view() const {
    query::LayerView view;
    view.layer = layer;
    view.snapshot.tiles = tiles;
    return view;
  }
};

// The texels of one side, and the values of the other layer at them.
struct Matched {
  query::TexelSelection known;
  TileMap values;
};

Result<Matched> match(const Side& side, const Side& other,
                      const jobs::CounterpartTolerance& tolerance, Progress& progress, double from,
                      double to, const query::TexelSelection* only) {
  const auto found = STRATA_TRY(jobs::find_counterparts(
      side.surface, other.surface, tolerance, side.map.resolution, progress, from, to, only));
  progress.begin_stage(to, to);
  auto values = STRATA_TRY(jobs::values_at(found, other.layer, other.tiles, progress));
  return Matched{found.matched(), std::move(values)};
}

double area_of(const query::TexelSelection& selection, const mesh::SurfaceMap& map) {
  return query::measure_selection(map, &selection).area;
}

// Reads the values of a layer. Fails if there are too many different ones for a table.
Result<query::SurfaceValues> read_values(const Layer& layer, const TileMap& tiles,
                                         const mesh::SurfaceMap& map) {
  auto values = query::read_surface_values(tiles, layer.type, map);
  std::unordered_set<std::uint32_t> different;
  for (std::uint32_t texel = 0; texel < values.bits.size(); ++texel) {
    const query::TexelValue value = values.of(texel);
    // neighbors mostly have the same value
    if (!value.valid || (texel > 0 && values.same(texel, texel - 1))) continue;
    if (different.insert(value.bits).second && different.size() > query::kMaxCrossTableSide)
      return fail(ErrorCode::invalid, "Too many values",
                  "'" + layer.name + "' has more than " +
                      std::to_string(query::kMaxCrossTableSide) +
                      " different values. Compare layers of classes, or of fewer records.",
                  "layer");
  }
  return values;
}

// Returns the painted area of each value outside `known`.
std::map<double, double> unknown_areas(const Side& side, const query::TexelSelection& known) {
  const query::SurfaceValues& values = side.values;
  std::map<double, CompensatedSum> sums;
  for (std::size_t texel = 0; texel < values.bits.size(); ++texel)
    if (((values.valid[texel / 64] & ~known[texel / 64]) >> texel % 64 & 1u) != 0)
      sums[decode_value(side.layer.type, values.bits[texel])] += side.map.area[texel];
  std::map<double, double> areas;
  for (const auto& [value, sum] : sums) areas[value] = sum.value() * side.m2_per_unit2();
  return areas;
}

// `metres_per_unit` is the length of one unit of the open model.
Result<ChangedPieces> changed_pieces(const Side& side, const Matched& matched, ValueType other_type,
                                     double min_area_m2, double metres_per_unit,
                                     const Progress& progress) {
  const auto painted = query::read_surface_values(matched.values, other_type, side.map).valid;
  const auto found = STRATA_TRY(query::find_lone_pieces(
      side.values, matched.known, painted, {min_area_m2 / side.m2_per_unit2(), kMaxChangedPieces},
      side.map, side.graph, progress));
  ChangedPieces pieces;
  for (const query::LonePiece& piece : found.list)
    pieces.list.push_back({decode_value(side.layer.type, piece.value.bits),
                           piece.area * side.m2_per_unit2(),
                           (side.surface.geometry->origin + glm::dvec3(piece.at)) *
                               (side.surface.metres / metres_per_unit)});
  pieces.total = found.count;
  pieces.area_m2 = found.area * side.m2_per_unit2();
  return pieces;
}

// The parts of the result on the open model: everything but what was lost.
Result<void> compare_forward(const Side& now, const Side& then,
                             const jobs::CounterpartTolerance& tolerance, double min_area_m2,
                             LayerChanges& changes, Progress& progress) {
  const auto matched = STRATA_TRY(match(now, then, tolerance, progress, 0.1, 0.45, nullptr));
  changes.matched_m2 = area_of(matched.known, now.map) * now.m2_per_unit2();
  query::LayerView before = then.view();
  before.layer.resolution = now.map.resolution;
  before.snapshot.tiles = matched.values;
  auto table = STRATA_TRY(
      query::cross_tabulate(before, now.view(), now.map, &matched.known, now.surface.metres));
  changes.table = std::move(table);
  changes.unmatched_now_m2 = unknown_areas(now, matched.known);
  changes.appeared = STRATA_TRY(
      changed_pieces(now, matched, then.layer.type, min_area_m2, now.surface.metres, progress));
  return {};
}

// The parts of the result on the other model.
Result<void> compare_backward(const Side& now, const Side& then,
                              const jobs::CounterpartTolerance& tolerance, double min_area_m2,
                              LayerChanges& changes, Progress& progress) {
  const auto matched =
      STRATA_TRY(match(then, now, tolerance, progress, 0.6, 0.95, &then.values.valid));
  changes.unmatched_then_m2 = unknown_areas(then, matched.known);
  changes.vanished = STRATA_TRY(
      changed_pieces(then, matched, now.layer.type, min_area_m2, now.surface.metres, progress));
  return {};
}

}  // namespace

Result<void> check_comparable(const Layer& now, const Layer& then) {
  for (const Layer* layer : {&now, &then})
    if (is_float(layer->type))
      return fail(
          ErrorCode::invalid, "Layer contains fractions",
          "'" + layer->name + "' contains fractions. A comparison requires whole numbers or keys.",
          "layer");
  if (now.kind != then.kind || now.table != then.table)
    return fail(ErrorCode::invalid, "Layers of different kinds",
                "The values of '" + now.name + "' and '" + then.name +
                    "' have different meanings. Compare two layers of classes, or two layers of "
                    "the same table.",
                "layer");
  return {};
}

Result<LayerChanges> compare_layers(const Services& services, room::Room& room, LayerId layer,
                                    const ChangesSince& since, Progress& progress) {
  progress.report(0, "Reading the other model");
  const RegionSource here = STRATA_TRY(region_source(services, room, layer));
  MemoryLedger& ledger = services.rooms.memory();
  // The number of texels of the other model is only known after its map is baked.
  const std::uint64_t own_texels = here.map->block_of_slot.size() * 64;
  const auto side = static_cast<std::uint64_t>(since.layer.resolution);
  auto memory =
      STRATA_TRY(ledger.reserve((own_texels + side * side) * kComparedBytesPerTexel, kUse));
  auto bytes = STRATA_TRY(services.store.models().geometry(since.model.id));
  auto decoded = STRATA_TRY(mesh::decode_geometry(bytes));
  bytes = {};
  const auto geometry = std::make_shared<const mesh::Geometry>(std::move(decoded));
  const auto geometry_memory = STRATA_TRY(ledger.reserve(
      geometry->bytes() + geometry->triangle_count() * kComparedBytesPerTriangle, kUse));
  const auto contents = STRATA_TRY(services.store.journal().load_tiles(since.layer));
  const jobs::ComparedSide surface(room.surface().geometry(), room.surface().search_tree(),
                                   room.model().metres());
  const jobs::ComparedSide other(geometry, std::make_shared<const mesh::SearchTree>(geometry),
                                 since.model.metres());

  progress.begin_stage(0.02, 0.1);
  const auto map = STRATA_TRY(mesh::bake_surface_map(*geometry, since.layer.resolution, progress));
  memory.recount((own_texels + map.block_of_slot.size() * 64) * kComparedBytesPerTexel);
  const auto graph = STRATA_TRY(mesh::build_texel_graph(*geometry, map, progress));

  const auto now_values = STRATA_TRY(read_values(here.layer, here.tiles, *here.map));
  const auto then_values = STRATA_TRY(read_values(since.layer, contents.tiles, map));
  const Side now{surface, here.layer, here.tiles, *here.map, *here.graph, now_values};
  const Side then{other, since.layer, contents.tiles, map, graph, then_values};
  const jobs::CounterpartTolerance tolerance{
      since.tolerance_mm / 1000,
      static_cast<float>(std::cos(glm::radians(since.max_angle_degrees)))};
  LayerChanges changes;
  changes.area_m2 = room.model().area_m2();
  STRATA_TRY(compare_forward(now, then, tolerance, since.min_area_m2, changes, progress));
  STRATA_TRY(compare_backward(now, then, tolerance, since.min_area_m2, changes, progress));
  return changes;
}

}  // namespace strata::app
