#include "room/pipeline/computed_edit.h"

#include "core/overloaded.h"

#include <algorithm>
#include <set>

#include "mesh/parallel.h"
#include "room/pipeline/expression_binding.h"
#include "room/pipeline/tile_past.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// The new state of some edits. nullopt: this part of the state stays unchanged.
struct Turn {
  std::vector<std::int64_t> edits;  // ascending sequences
  std::optional<bool> in_force, provisional;
};

Result<TileChange> turn_in_tile(const store::WrittenTiles& written, const Turn& turn,
                                const Layer& layer, const TileMap& tiles, store::Store& store) {
  auto before = tile_or_empty(tiles, written.tile, layer.type);
  auto resolver = STRATA_TRY(resolve_tile(
      *before, written.written, layer, written.tile, store, [&](PastRevision& revision) {
        if (!std::binary_search(turn.edits.begin(), turn.edits.end(), revision.sequence)) return;
        revision.in_force = turn.in_force.value_or(revision.in_force);
        revision.provisional = turn.provisional.value_or(revision.provisional);
      }));
  const TileMask provisional = resolver.provisional();
  TileData resolved = std::move(resolver).finish();
  auto after = resolved == *before ? before : std::make_shared<const TileData>(std::move(resolved));
  return TileChange{written.tile, std::move(before), std::move(after), written.written,
                    provisional};
}

Result<ComputedEdit> compute_turn(const Turn& turn, const Layer& layer, const TileMap& tiles,
                                  store::Store& store) {
  auto written = STRATA_TRY(store.journal().written_by(layer, turn.edits));
  ComputedEdit computed;
  for (const auto& tile : written) {
    auto change = STRATA_TRY(turn_in_tile(tile, turn, layer, tiles, store));
    computed.changes.push_back(std::move(change));
  }
  if (turn.in_force) (*turn.in_force ? computed.enable : computed.disable) = turn.edits;
  return computed;
}

Result<ComputedEdit> compute_undo(const EditRequest& request, const Layer& layer,
                                  const TileMap& tiles, store::Store& store, bool redo) {
  // Only a curator can change an accepted edit.
  const bool pending_only = layer.review && request.author.role < Role::curator;
  auto sequences =
      STRATA_TRY(redo ? store.journal().redoable(layer.id, request.author.user, pending_only)
                      : store.journal().undoable(layer.id, request.author.user, pending_only));
  if (sequences.empty() && pending_only)
    return fail(ErrorCode::conflict, redo ? "Nothing to redo" : "Nothing to undo",
                redo ? "You have no stroke on this layer that you can redo."
                     : "You have no stroke on this layer that waits for review. Only a curator can "
                       "undo accepted strokes.");
  if (sequences.empty())
    return redo ? fail(ErrorCode::conflict, "Nothing to redo",
                       "You have no stroke on this layer that you can redo.")
                : fail(ErrorCode::conflict, "Nothing to undo",
                       "You have no stroke on this layer that you can undo.");
  return compute_turn({std::move(sequences), redo, std::nullopt}, layer, tiles, store);
}

Result<ComputedEdit> compute_review(const ReviewEdit& review, const Layer& layer,
                                    const TileMap& tiles, store::Store& store) {
  const auto found =
      STRATA_TRY(store.journal().under_review(layer.id, review.decision, review.which));
  const bool reopens = review.decision == Decision::reopen;
  Turn turn;
  std::set<std::string> authors;
  for (const auto& edit : found.edits) {
    turn.edits.push_back(edit.sequence);
    authors.insert(edit.user);
  }
  for (std::size_t i = 0; i < found.named.size(); ++i)
    if (!std::binary_search(turn.edits.begin(), turn.edits.end(), found.named[i]))
      return fail(
          ErrorCode::conflict, reopens ? "Not reviewed" : "Not waiting for review",
          "Edit " + std::to_string(review.which.edits[i]) +
              (reopens
                   ? " has not been accepted or rejected, or it was undone in the meantime."
                   : " of this layer does not wait for review. Its author undid it, or somebody has "
                     "reviewed it."),
          "edits");
  if (turn.edits.empty())
    return fail(ErrorCode::conflict, "Nothing to review",
                "None of these edits of this layer waits for review.");
  if (review.decision != Decision::accept) turn.in_force = reopens;
  turn.provisional = reopens;
  auto computed = STRATA_TRY(compute_turn(turn, layer, tiles, store));
  computed.reviewed = {std::move(turn.edits), outcome(review.decision)};
  computed.authors.assign(authors.begin(), authors.end());
  return computed;
}

Result<ComputedEdit> only_changes(Result<std::vector<TileChange>> changes) {
  if (!changes) return tl::unexpected(changes.error());
  return ComputedEdit{std::move(*changes), {}, {}, {}, {}};
}

Result<TileMap> computed_content(const ComputeEdit& compute, const Layer& layer,
                                 const RegionContext& context) {
  std::vector<query::LayerView> layers = context.layers;
  layers.insert(layers.end(), compute.shapes.begin(), compute.shapes.end());
  const auto bound = STRATA_TRY(bind_for_layer(compute.expression, layers, context.store,
                                               context.author, layer.visibility, "expression"));
  return query::compute_tiles(bound.expression, bound.layers, context.map,
                              {context.surface.geometry().origin, context.metres}, layer.type,
                              "expression", mesh::background_threads());
}

}  // namespace

Result<ComputedEdit> compute_edit(const EditRequest& request, const Layer& layer,
                                  const RegionContext& context) {
  store::Store& store = context.store;
  const TileMap& tiles = context.tiles;
  return std::visit(
      Overloaded{
          [&](const FillEdit& fill) {
            return only_changes(fill_changes(fill, layer.type, context));
          },
          [&](const PolygonEdit& polygon) {
            return only_changes(polygon_changes(polygon, layer.type, context));
          },
          [&](const ImportEdit& import) {
            return only_changes(
                import.over ? paint_over(tiles, import.tiles, layer.type, context.map)
                            : replace_content(tiles, import.tiles, layer.type, context.map));
          },
          [&](const ComputeEdit& compute) -> Result<ComputedEdit> {
            auto content = STRATA_TRY(computed_content(compute, layer, context));
            return only_changes(replace_content(tiles, content, layer.type, context.map));
          },
          [&](const PatchEdit& patch) -> Result<ComputedEdit> {
            if (patch.type != layer.type || patch.resolution != layer.resolution)
              return fail(ErrorCode::conflict, "Layer was changed",
                          "The type of the layer was changed while the result was computed. Start "
                          "the operation again.",
                          "layer");
            return only_changes(patch_unchanged(tiles, patch.patch, layer.type));
          },
          [&](const RestoreEdit& restore) -> Result<ComputedEdit> {
            auto past = STRATA_TRY(store.journal().load_tiles(layer, restore.sequence));
            auto changes = replace_content(tiles, past.tiles, layer.type, context.map);
            if (restore.outline) {
              const auto masks = STRATA_TRY(texels_in(
                  *restore.outline, context.map, context.surface, context.renderer, context.model));
              changes = only_within(std::move(changes), masks);
            }
            return only_changes(std::move(changes));
          },
          [&](const UndoEdit&) { return compute_undo(request, layer, tiles, store, false); },
          [&](const RedoEdit&) { return compute_undo(request, layer, tiles, store, true); },
          [&](const ReviewEdit& review) { return compute_review(review, layer, tiles, store); },
          [&](const StrokeEdit&) -> Result<ComputedEdit> {
            return fail(ErrorCode::internal, "Internal error",
                        "The server cannot compute a stroke. This is an internal error.");
          },
      },
      request.edit);
}

}  // namespace strata::room
