#include "room/computed_edit.h"

#include <algorithm>
#include <limits>

#include "core/history.h"
#include "mesh/parallel.h"
#include "room/expression_binding.h"

namespace strata::room {
namespace {

constexpr int kRevisionsAtOnce = 32;  // of a tile's history: undo holds no more in memory

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

// Walks back through the tile's history only until every texel has found its author.
Result<TileChange> undo_in_tile(const store::Store::WrittenTiles& written, const std::vector<std::int64_t>& sequences,
                                bool redo, const Layer& layer, const TileMap& tiles, store::Store& store) {
  auto before = tile_or_empty(tiles, written.tile, layer.type);
  TileResolver resolver(*before, written.written);
  for (std::int64_t newest = std::numeric_limits<std::int64_t>::max(); resolver.is_open();) {
    auto revisions = store.tile_history(layer, written.tile, newest, kRevisionsAtOnce);
    if (!revisions) return tl::unexpected(revisions.error());
    if (revisions->empty()) break;
    for (auto& revision : *revisions) {
      if (std::binary_search(sequences.begin(), sequences.end(), revision.sequence)) revision.in_force = redo;
      resolver.add(revision);
    }
    newest = revisions->back().sequence;
  }
  auto after = std::make_shared<const TileData>(std::move(resolver).finish());
  return TileChange{written.tile, std::move(before), std::move(after), written.written};
}

Result<ComputedEdit> compute_undo(const EditRequest& request, const Layer& layer, const TileMap& tiles,
                                  store::Store& store, bool redo) {
  auto sequences = redo ? store.redoable(layer.id, request.author.user) : store.undoable(layer.id, request.author.user);
  if (!sequences) return tl::unexpected(sequences.error());
  if (sequences->empty())
    return redo ? fail(409, "Nothing to redo", "You have no undone stroke on this layer that could come back.")
                : fail(409, "Nothing to undo", "You have no stroke in force on this layer.");
  auto written = store.written_by(layer, *sequences);
  if (!written) return tl::unexpected(written.error());

  ComputedEdit computed;
  for (const auto& tile : *written) {
    auto change = undo_in_tile(tile, *sequences, redo, layer, tiles, store);
    if (!change) return tl::unexpected(change.error());
    computed.changes.push_back(std::move(*change));
  }
  (redo ? computed.enable : computed.disable) = std::move(*sequences);
  return computed;
}

Result<ComputedEdit> only_changes(Result<std::vector<TileChange>> changes) {
  if (!changes) return tl::unexpected(changes.error());
  return ComputedEdit{std::move(*changes), {}, {}};
}

Result<TileMap> computed_content(const ComputeEdit& compute, const Layer& layer, const RegionContext& context) {
  std::vector<query::LayerView> layers = context.layers;
  layers.insert(layers.end(), compute.shapes.begin(), compute.shapes.end());
  const auto bound =
      bind_for_layer(compute.expression, layers, context.store, context.author, layer.visibility, "expression");
  if (!bound) return tl::unexpected(bound.error());
  return query::compute_tiles(bound->expression, bound->layers, context.map,
                              {context.surface.geometry().origin, context.metres}, layer.type, "expression",
                              mesh::background_threads());
}

}  // namespace

Result<ComputedEdit> compute_edit(const EditRequest& request, const Layer& layer, const RegionContext& context) {
  store::Store& store = context.store;
  const TileMap& tiles = context.tiles;
  return std::visit(
      Overloaded{
          [&](const FillEdit& fill) { return only_changes(fill_changes(fill, layer.type, context)); },
          [&](const PolygonEdit& polygon) { return only_changes(polygon_changes(polygon, layer.type, context)); },
          [&](const ImportEdit& import) {
            return only_changes(import.over ? paint_over(tiles, import.tiles, layer.type, context.map)
                                            : replace_content(tiles, import.tiles, layer.type, context.map));
          },
          [&](const ComputeEdit& compute) -> Result<ComputedEdit> {
            auto content = computed_content(compute, layer, context);
            if (!content) return tl::unexpected(content.error());
            return only_changes(replace_content(tiles, *content, layer.type, context.map));
          },
          [&](const RestoreEdit& restore) -> Result<ComputedEdit> {
            auto past = store.load_tiles(layer, restore.sequence);
            if (!past) return tl::unexpected(past.error());
            return only_changes(replace_content(tiles, past->tiles, layer.type, context.map));
          },
          [&](const UndoEdit&) { return compute_undo(request, layer, tiles, store, false); },
          [&](const RedoEdit&) { return compute_undo(request, layer, tiles, store, true); },
          [&](const StrokeEdit&) -> Result<ComputedEdit> {
            return fail(500, "Internal error", "A stroke is painted, not computed.");
          },
      },
      request.edit);
}

}  // namespace strata::room
