// The layers of an open room. A change takes effect only after the database has stored it. A change
// to the content of layers runs in the order of edits.
#include "room/open/open_layers.h"

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "expression/surface_functions.h"
#include "room/open/open_participants.h"
#include "room/pipeline/edit_pipeline.h"
#include "room/pipeline/expression_binding.h"
#include "room/pipeline/strand.h"
#include "store/content/layers.h"
#include "store/content/trash.h"
#include "store/store.h"

namespace strata::room {
namespace {

Result<void> check_layer(const Layer& layer, const Model& model) {
  const int lowest = model.atlas.lowest_resolution;
  if (layer.resolution < lowest || layer.resolution > 16384 ||
      (layer.resolution & (layer.resolution - 1)) != 0)
    return fail(ErrorCode::invalid, "Resolution out of range",
                "The resolution of a layer of this model must be a power of two from " +
                    std::to_string(lowest) + " to 16384 texels on each side.",
                "resolution");
  if (layer.name.empty() || layer.name.size() > 200)
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a layer must be 1 to 200 bytes long.", "name");
  if (!(layer.opacity >= 0 && layer.opacity <= 1))
    return fail(ErrorCode::invalid, "Opacity out of range",
                "Opacity must be from 0 (transparent) to 1 (opaque).", "opacity");
  return {};
}

}  // namespace

bool is_newer(const Layer& layer, const Layer& held) {
  const auto state = [](const Layer& each) {
    return std::pair(each.version, each.formula ? each.formula->computed_sequence : 0);
  };
  return state(layer) > state(held);
}

std::vector<Layer> OpenRoom::LayersPart::all() const { return room_.layer_list(); }

Result<Layer> OpenRoom::LayersPart::find(const std::string& ref) const {
  return room_.state(ref).map([](const LayerState& s) { return s.layer; });
}

Result<Layer> OpenRoom::LayersPart::create(Layer layer,
                                           const store::IdempotentResponse<Layer>& answer,
                                           std::vector<Column> columns) {
  layer.model_id = room_.model_id_;
  STRATA_TRY(check_layer(layer, room_.model()));
  auto created = room_.exclusively<Layer>([this, layer, answer, columns]() -> Result<Layer> {
    // Adds the layer on the GPU first. If that fails, the database stays unchanged.
    LayerState state = new_state(layer);
    auto handles = add_layer(room_.services_.renderer, room_.model_handle(), state);
    if (!handles) return tl::unexpected(room_.gpu_problem(handles.error()));
    auto made = room_.services_.store.layers().create(layer, answer, columns);
    if (!made) {
      remove_layer(room_.services_.renderer, *handles);
      return made;
    }
    state.handles = *handles;
    state.layer = *made;
    state.palette = std::make_shared<const Palette>(made->palette);
    run_on(room_.strand_, [&] {
      {
        std::lock_guard lock(room_.mutex_);
        room_.layers_.emplace(made->id, std::move(state));
      }
      room_.participants_part_->tell_layer(std::nullopt, *made);
      room_.participants_part_->styles_changed();
    });
    return made;
  });
  if (created) room_.maps_->request(created->resolution, [](auto) {});
  return created;
}

Result<Layer> OpenRoom::LayersPart::update(Layer layer,
                                           const store::IdempotentResponse<Layer>& answer) {
  STRATA_TRY(room_.check_claimed());
  STRATA_TRY(check_layer(layer, room_.model()));
  auto updated = STRATA_TRY(room_.services_.store.layers().update(std::move(layer), answer));
  bool lock_falls = false;
  const Layer now = run_on(room_.strand_, [&] {
    const LayerState* before = room_.find_layer(updated.id);
    lock_falls = updated.locked && before && !before->layer.locked;
    return replace(updated);
  });
  // The lock is confirmed when the edits in progress are durable, so no edit follows the
  // confirmation. If the database is unreachable, these edits cannot be saved, but the lock stays.
  if (lock_falls)
    if (const auto still = room_.settle(); !still)
      log::warning("a layer was locked while its edits could not be saved: " +
                   still.error().detail);
  return now;
}

Layer OpenRoom::LayersPart::replace(const Layer& stored) {
  Layer now = stored;
  Visibility before = now.visibility;
  {
    std::lock_guard lock(room_.mutex_);
    auto found = room_.layers_.find(now.id);
    if (found == room_.layers_.end()) return now;
    if (found->second.layer.version > now.version) return now;  // a later change arrived first
    before = found->second.layer.visibility;
    now.sequence = found->second.layer.sequence;
    now.type = found->second.layer.type;  // of the content
    found->second.layer = now;
    found->second.palette = std::make_shared<const Palette>(now.palette);
  }
  room_.participants_part_->tell_layer(before, now);
  room_.participants_part_->styles_changed();
  return now;
}

Result<Layer> OpenRoom::LayersPart::mark_computed(LayerId id, const std::string& expression,
                                                  std::int64_t sequence,
                                                  const std::map<TableId, std::int64_t>& tables) {
  STRATA_TRY(room_.check_claimed());
  auto stored =
      STRATA_TRY(room_.services_.store.layers().set_computed(id, expression, sequence, tables));
  return run_on(room_.strand_, [&] { return replace(stored); });
}

void OpenRoom::LayersPart::outdate(const std::function<bool(const LayerFormula&)>& reads) {
  std::vector<Layer> stale;
  {
    std::lock_guard lock(room_.mutex_);
    for (auto& [id, state] : room_.layers_) {
      if (!state.layer.formula || state.layer.formula->stale || !reads(*state.layer.formula))
        continue;
      state.layer.formula->stale = true;
      stale.push_back(state.layer);
    }
  }
  for (const Layer& layer : stale) room_.participants_part_->tell_layer(layer.visibility, layer);
}

void OpenRoom::LayersPart::records_changed(TableId table_id) {
  room_.record_colors_->records_changed(table_id);
  room_.record_features_->records_changed(table_id);
  // Updates the layers that take their colors from the terms of the table.
  for (const Layer& layer : room_.layer_list()) {
    if (!layer.palette_of_terms || layer.table != table_id) continue;
    // A layer that was deleted, or that cannot be read at present, keeps its colors.
    if (auto stored =
            room_.services_.store.layers().find(room_.model_id_, to_string(layer.id), Role::owner))
      run_on(room_.strand_, [&] { return replace(*stored); });
  }
  run_on(room_.strand_, [&] {
    outdate([&](const LayerFormula& formula) {
      return std::ranges::any_of(formula.inputs,
                                 [&](const auto& input) { return input.table == table_id; });
    });
  });
}

Result<void> OpenRoom::LayersPart::check_expression(const Expression& expression,
                                                    const std::string& field, Visibility layer,
                                                    const std::vector<Layer>& planned) const {
  std::vector<query::LayerView> views;
  for (const Layer& each : room_.layer_list()) views.push_back({each, {}});
  for (const Layer& each : planned) views.push_back({each, {}});
  for (const std::string& shape : shapes_read(expression, views)) {
    views.emplace_back();
    views.back().layer.slug = std::string(kShapePrefix) + shape;
  }
  const auto check = [&](const Expression& e) -> Result<void> {
    STRATA_TRY(bind_for_layer(e, views, room_.services_.store, Role::owner, layer, field));
    return {};
  };
  const auto formula = STRATA_TRY(query::separate_surface_functions(expression, field));
  for (const auto& [slug, function] : formula.functions) {
    STRATA_TRY(check(function.parts.front()));
    views.emplace_back();
    views.back().layer.slug = slug;
  }
  return check(formula.expression);
}

Result<Layer> OpenRoom::LayersPart::widen(const Layer& layer, ValueType type,
                                          const store::IdempotentResponse<Layer>& answer) {
  if (layer.formula || !widens_to(layer.type, type))
    return fail(ErrorCode::invalid, "Invalid type of layer",
                "You can change only unsigned types, and only to a wider type (u8 to u16 or u32, "
                "u16 to u32). The type of a computed layer cannot change.",
                "type");
  return room_.exclusively<Layer>([this, layer, type, answer]() -> Result<Layer> {
    const auto held = STRATA_TRY(room_.state(to_string(layer.id)));
    // Changes the GPU first, as for a new layer. No edit is pending, so the mirror equals the
    // journal.
    TileMirror::Snapshot content = held.mirror->snapshot();
    for (auto& [address, tile] : content.tiles)
      tile = std::make_shared<const TileData>(widened(*tile, type));
    auto mirror = std::make_shared<TileMirror>(type, layer.resolution);
    mirror->assign(std::move(content.tiles), content.sequence);
    auto handle = add_layer(room_.services_.renderer, room_.model_handle(), mirror);
    if (!handle) return tl::unexpected(room_.gpu_problem(handle.error()));
    auto stored = room_.services_.store.layers().widen(layer, type, answer);
    if (!stored) {
      room_.services_.renderer.remove_layer(*handle);
      return stored;
    }
    run_on(room_.strand_, [&] {
      render::LayerHandle old = 0;
      {
        std::lock_guard lock(room_.mutex_);
        const auto found = room_.layers_.find(layer.id);
        if (found == room_.layers_.end()) return;
        old = std::exchange(found->second.handles.content, *handle);
        found->second.mirror = mirror;
        found->second.sums = std::make_shared<query::TileSumsCache>();
        found->second.layer.type = type;
        room_.mirrors_share_.recount(room_.mirror_bytes());
      }
      *stored = replace(*stored);
      room_.services_.renderer.remove_layer(old);
    });
    return stored;
  });
}

Result<void> OpenRoom::LayersPart::erase(LayerId id, const store::IdempotentResponse<>& answer) {
  return unload(id,
                [this, id, answer] { return room_.services_.store.layers().remove(id, answer); });
}

Result<void> OpenRoom::LayersPart::put_in_trash(LayerId id,
                                                const store::IdempotentResponse<>& answer) {
  return unload(id,
                [this, id, answer] { return room_.services_.store.trash().put_layer(id, answer); });
}

Result<void> OpenRoom::LayersPart::unload(LayerId id,
                                          const std::function<Result<void>()>& in_store) {
  // Runs in the order of edits, because no edit of the layer may be written to the journal after
  // the layer was deleted.
  return room_.exclusively<void>([this, id, in_store]() -> Result<void> {
    STRATA_TRY(in_store());
    run_on(room_.strand_, [&] { drop(id); });
    return {};
  });
}

void OpenRoom::LayersPart::drop(LayerId id) {
  LayerState gone;
  {
    std::lock_guard lock(room_.mutex_);
    auto found = room_.layers_.find(id);
    if (found == room_.layers_.end()) return;
    gone = std::move(found->second);
    room_.layers_.erase(found);
    room_.mirrors_share_.recount(room_.mirror_bytes());
  }
  remove_layer(room_.services_.renderer, gone.handles);
  room_.participants_part_->tell_seen(gone.layer, [&](Listener& l) {
    l.layer_changed(Listener::LayerChange::deleted, gone.layer);
  });
  outdate([&](const LayerFormula& formula) {
    return std::ranges::any_of(formula.inputs,
                               [&](const auto& input) { return input.layer == id; });
  });
  room_.participants_part_->styles_changed();
}

Result<store::TrashRestored> OpenRoom::LayersPart::restore(
    const store::TrashEntry& entry, const store::IdempotentResponse<store::TrashRestored>& answer) {
  // Runs in the order of edits, because the sequences of the journal must not change.
  auto restored = room_.exclusively<store::TrashRestored>(
      [this, entry, answer]() -> Result<store::TrashRestored> {
        auto back = STRATA_TRY(room_.services_.store.trash().restore(entry, answer));
        if (auto known = load(LayerId(entry.id)); !known) {
          // The layer exists in the database, so the room reads everything again until it has the
          // layer.
          log::warning("layer " + std::to_string(entry.id) +
                       " was restored and could not be loaded: " + known.error().detail);
          run_on(room_.strand_, [&] { room_.journal_differs(); });
        }
        return back;
      });
  return restored;
}

std::vector<LayerId> OpenRoom::LayersPart::take(const std::vector<Layer>& stored) {
  return run_on(room_.strand_, [&] {
    std::vector<LayerId> lacks;
    for (const Layer& layer : stored) {
      const LayerState* held = room_.find_layer(layer.id);
      if (held && is_newer(layer, held->layer)) replace(layer);
      if (!held || held->layer.type != layer.type) lacks.push_back(layer.id);
    }
    for (const Layer& held : room_.layer_list())
      if (std::ranges::find(stored, held.id, &Layer::id) == stored.end()) drop(held.id);
    return lacks;
  });
}

Result<void> OpenRoom::LayersPart::load(LayerId id) {
  auto layer =
      STRATA_TRY(room_.services_.store.layers().find(room_.model_id_, to_string(id), Role::owner));
  auto state = STRATA_TRY(read_layer_state(room_.services_.store, std::move(layer)));
  if (room_.following_part_) room_.maps_->make_bounds(state.layer.resolution);
  const render::ModelHandle model = room_.model_handle();
  auto handles = add_layer(room_.services_.renderer, model, state);
  if (!handles) return tl::unexpected(room_.gpu_problem(handles.error()));
  state.handles = *handles;
  state.layer.sequence = state.mirror->sequence();
  if (!run_on(room_.strand_, [&] { return put(state, model); })) {
    remove_layer(room_.services_.renderer, *handles);
    return tl::unexpected(room_.gpu_problem({ErrorCode::not_found, {}, {}}));
  }
  if (!room_.following_part_) room_.maps_->request(state.layer.resolution, [](auto) {});
  // Layers that are computed from the loaded layer may be up to date again.
  for (const Layer& other : room_.layer_list()) {
    if (!other.formula || std::ranges::none_of(other.formula->inputs, [&](const auto& input) {
          return input.layer == id;
        }))
      continue;
    if (auto stored =
            room_.services_.store.layers().find(room_.model_id_, to_string(other.id), Role::owner))
      run_on(room_.strand_, [&] { replace(*stored); });
  }
  return {};
}

bool OpenRoom::LayersPart::put(const LayerState& state, render::ModelHandle model) {
  if (room_.recovery_.working || room_.model_handle_ != model) return false;
  std::optional<Visibility> before;
  LayerHandles old;
  {
    std::lock_guard lock(room_.mutex_);
    const auto [found, is_new] = room_.layers_.try_emplace(state.layer.id);
    if (!is_new) {
      before = found->second.layer.visibility;
      old = found->second.handles;
    }
    found->second = state;
    room_.mirrors_share_.recount(room_.mirror_bytes());
  }
  room_.participants_part_->tell_layer(before, state.layer);
  room_.participants_part_->styles_changed();
  if (before) remove_layer(room_.services_.renderer, old);
  return true;
}

}  // namespace strata::room
