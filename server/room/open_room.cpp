#include "room/open_room.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <charconv>
#include <future>

#include "core/log.h"
#include "core/no_such.h"
#include "core/text/slug.h"
#include "room/expression_binding.h"
#include "room/gpu_problem.h"
#include "room/seen_room.h"
#include "room/tile_changes.h"
#include "store/content/layers.h"
#include "store/content/looks.h"
#include "store/content/models.h"

namespace strata::room {
namespace {

Result<void> check_layer(const Layer& layer, const Model& model) {
  const int lowest = model.atlas.lowest_resolution;
  if (layer.resolution < lowest || layer.resolution > 16384 ||
      (layer.resolution & (layer.resolution - 1)) != 0)
    return fail(ErrorCode::invalid, "Resolution out of range",
                "A layer of this model has a power of two from " + std::to_string(lowest) +
                    " to 16384 texels a side.",
                "resolution");
  if (layer.name.empty() || layer.name.size() > 200)
    return fail(ErrorCode::invalid, "Name missing", "A layer has a name of 1 to 200 bytes.",
                "name");
  if (!(layer.opacity >= 0 && layer.opacity <= 1))
    return fail(ErrorCode::invalid, "Opacity out of range",
                "Opacity goes from 0 (clear) to 1 (opaque).", "opacity");
  return {};
}

}  // namespace

template <class Work>
auto OpenRoom::on_strand(Work work) const {
  using Value = std::invoke_result_t<Work>;
  std::promise<Value> promise;
  auto future = promise.get_future();
  boost::asio::dispatch(strand_, [&] {
    if constexpr (std::is_void_v<Value>) {
      work();
      promise.set_value();
    } else {
      promise.set_value(work());
    }
  });
  return future.get();
}

OpenRoom::OpenRoom(const RoomParts& parts, Model model, render::ModelGeometry geometry)
    : parts_(parts),
      model_id_(model.id),
      geometry_(std::move(geometry.full)),
      coarser_(std::move(geometry.coarser)),
      strand_(parts.strands.get_executor()),
      maps_(std::make_shared<SurfaceMaps>(geometry_, parts.renderer, parts.memory, parts.workers)),
      surface_(std::make_shared<SurfaceLookup>(geometry_, parts.memory)),
      model_(std::move(model)),
      last_used_(std::chrono::steady_clock::now()),
      recovery_(strand_) {}

OpenRoom::~OpenRoom() = default;

Result<std::shared_ptr<OpenRoom>> OpenRoom::open(const RoomParts& parts,
                                                 const std::string& model_ref) {
  auto model = STRATA_TRY(parts.store.models().find(model_ref));
  auto geometry = STRATA_TRY(read_geometry(parts.store, model.id));
  std::uint64_t bytes = geometry.full->bytes();
  for (const auto& level : geometry.coarser) bytes += level->bytes();
  auto share = STRATA_TRY(parts.memory.reserve(bytes, "the model's triangles"));
  auto room = std::make_shared<OpenRoom>(parts, std::move(model), std::move(geometry));
  room->geometry_share_ = std::move(share);
  auto journal = read_journal(parts.store, room->model_id_, {});
  if (!journal) return tl::unexpected(journal.error());
  auto looks = STRATA_TRY(parts.store.looks().of_model(room->model_id_));
  for (LayerState& state : journal->layers) {
    const std::int64_t id = state.layer.id;
    room->layers_.emplace(id, std::move(state));
  }
  auto mirrors = parts.memory.reserve(room->mirror_bytes(), "what its layers hold");
  if (!mirrors) return tl::unexpected(mirrors.error());
  room->mirrors_share_ = std::move(*mirrors);
  auto gpu = fill_gpu(parts.renderer, {room->geometry_, room->coarser_}, room->layer_states());
  if (!gpu) return tl::unexpected(gpu.error());
  for (auto& [id, state] : room->layers_) state.handles = gpu->layers.at(id);
  room->model_handle_ = gpu->model;
  room->maps_->set_model(gpu->model);
  const auto restyle = [weak = std::weak_ptr<OpenRoom>(room)] {
    auto open = weak.lock();
    if (!open) return;
    const Strand strand = open->strand_;  // not on the GPU thread
    boost::asio::post(strand, [open = std::move(open)] { open->sort_layers_changed(); });
  };
  room->look_shelf_ = std::make_shared<LookShelf>(parts.store, parts.renderer, parts.workers,
                                                  parts.memory, restyle);
  room->record_colors_ = std::make_shared<RecordColors>(parts.store, parts.workers, restyle);
  room->record_marks_ =
      std::make_shared<RecordMarks>(parts.store, parts.workers, room->id(), restyle);
  room->look_shelf_->set_model(gpu->model);
  for (const Look& look : looks) room->look_shelf_->put(look);
  room->sequence_ = room->durable_ = journal->last_sequence;
  room->pipeline_ = std::make_shared<EditPipeline>(
      EditPipeline::Parts{parts.store, parts.writer, parts.renderer, parts.workers, parts.readers,
                          room->strand_, room->maps_, room->surface_, parts.memory},
      *room, journal->last_sequence);
  // Painting needs the maps of the layers there are; bake them while people look around.
  for (const auto& state : room->layer_states())
    room->maps_->request(state.layer.resolution, [](auto) {});
  return room;
}

// ----------------------------------------------------------------------------------------------------
// metadata

Model OpenRoom::model() const {
  std::lock_guard lock(mutex_);
  Model copy = model_;
  copy.sequence = durable_;
  return copy;
}

std::vector<LayerState> OpenRoom::layer_states() const {
  std::vector<LayerState> states;
  {
    std::lock_guard lock(mutex_);
    for (const auto& [id, state] : layers_) states.push_back(state);
  }
  std::stable_sort(states.begin(), states.end(), [](const LayerState& a, const LayerState& b) {
    return a.layer.order < b.layer.order;
  });
  return states;
}

std::vector<Layer> OpenRoom::layers() const {
  std::vector<Layer> layers;
  for (auto& state : layer_states()) layers.push_back(std::move(state.layer));
  return layers;
}

Result<LayerState> OpenRoom::state(const std::string& ref) const {
  std::lock_guard lock(mutex_);
  for (const auto& [id, state] : layers_)
    if (is_all_digits(ref) ? std::to_string(id) == ref : state.layer.slug == ref) return state;
  return no_such_layer(ref);
}

std::optional<LayerState> OpenRoom::layer_state(std::int64_t id) const {
  std::lock_guard lock(mutex_);
  auto found = layers_.find(id);
  return found == layers_.end() ? std::nullopt : std::optional(found->second);
}

Result<Layer> OpenRoom::layer(const std::string& ref) const {
  return state(ref).map([](const LayerState& s) { return s.layer; });
}

render::ModelHandle OpenRoom::model_handle() const {
  std::lock_guard lock(mutex_);
  return model_handle_;
}

std::int64_t OpenRoom::sequence() const { return sequence_; }
std::int64_t OpenRoom::durable_sequence() const { return durable_; }
Room::DurableState OpenRoom::durable_state() const {
  return on_strand([&] {
    DurableState state{durable_, {}};
    for (const auto& [id, layer] : layers_)
      if (TileMap waiting = pipeline_->durable_provisional(layer); !waiting.empty())
        state.provisional.emplace(id, std::move(waiting));
    return state;
  });
}

template <class T>
Result<T> OpenRoom::exclusively(std::function<Result<T>()> work) {
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  ++unanswered_;
  boost::asio::post(strand_, [self = shared_from_this(), promise, work = std::move(work)] {
    self->pipeline_->when_idle([promise, work](const Result<void>& may) {
      if (may)
        promise->set_value(work());
      else
        promise->set_value(tl::unexpected(may.error()));
    });
  });
  auto result = future.get();
  --unanswered_;
  return result;
}

Result<Layer> OpenRoom::create_layer(Layer layer, const store::FirstAnswer<Layer>& answer,
                                     std::vector<Column> columns) {
  layer.model_id = model_id_;
  STRATA_TRY(check_layer(layer, model()));
  auto created = exclusively<Layer>([this, layer, answer, columns]() -> Result<Layer> {
    // The GPU first: of what it refuses nothing is in the database.
    LayerState state = new_state(layer);
    auto handles = add_layer(parts_.renderer, model_handle(), state);
    if (!handles) return tl::unexpected(gpu_problem(handles.error()));
    auto made = parts_.store.layers().create(layer, answer, columns);
    if (!made) {
      remove_layer(parts_.renderer, *handles);
      return made;
    }
    state.handles = *handles;
    state.layer = *made;
    state.palette = std::make_shared<const Palette>(made->palette);
    on_strand([&] {
      {
        std::lock_guard lock(mutex_);
        layers_.emplace(made->id, std::move(state));
      }
      tell_layer(std::nullopt, *made);
      sort_layers_changed();
    });
    return made;
  });
  if (created) maps_->request(created->resolution, [](auto) {});
  return created;
}

Result<Layer> OpenRoom::update_layer(Layer layer, const store::FirstAnswer<Layer>& answer) {
  STRATA_TRY(check_layer(layer, model()));
  auto updated = STRATA_TRY(parts_.store.layers().update(std::move(layer), answer));
  bool lock_falls = false;
  const Layer now = on_strand([&] {
    const LayerState* before = find_layer(updated.id);
    lock_falls = updated.locked && before && !before->layer.locked;
    return replace_layer(updated);
  });
  // Who locks a layer hears so when what was being painted on it is there: from then on nothing
  // comes. A database that is away keeps the edits under way from being saved, which does not take
  // the lock back.
  if (lock_falls)
    if (const auto still = settle(); !still)
      log::warning("a layer was locked while its edits could not be saved: " +
                   still.error().detail);
  return now;
}

Layer OpenRoom::replace_layer(const Layer& stored) {
  Layer now = stored;
  Visibility before = now.visibility;
  {
    std::lock_guard lock(mutex_);
    auto found = layers_.find(now.id);
    if (found == layers_.end()) return now;
    if (found->second.layer.version > now.version) return now;  // a later change came by first
    before = found->second.layer.visibility;
    now.sequence = found->second.layer.sequence;
    found->second.layer = now;
    found->second.palette = std::make_shared<const Palette>(now.palette);
  }
  tell_layer(before, now);
  sort_layers_changed();
  return now;
}

Result<Layer> OpenRoom::layer_computed(std::int64_t id, const std::string& expression,
                                       std::int64_t sequence,
                                       const std::map<std::int64_t, std::int64_t>& tables) {
  auto stored = STRATA_TRY(parts_.store.layers().set_computed(id, expression, sequence, tables));
  return on_strand([&] { return replace_layer(stored); });
}

void OpenRoom::outdate(const std::function<bool(const LayerFormula&)>& reads) {
  std::vector<Layer> stale;
  {
    std::lock_guard lock(mutex_);
    for (auto& [id, state] : layers_) {
      if (!state.layer.formula || state.layer.formula->stale || !reads(*state.layer.formula))
        continue;
      state.layer.formula->stale = true;
      stale.push_back(state.layer);
    }
  }
  for (const Layer& layer : stale) tell_layer(layer.visibility, layer);
}

void OpenRoom::records_changed(std::int64_t table_id) {
  record_colors_->records_changed(table_id);
  record_marks_->records_changed(table_id);
  // Layers that take their colours from the terms of the table.
  for (const Layer& layer : layers()) {
    if (!layer.palette_of_terms || layer.table != table_id) continue;
    // One that is gone meanwhile, or cannot be read now, keeps the colours that it has.
    if (auto stored = parts_.store.layers().find(model_id_, std::to_string(layer.id), Role::owner))
      on_strand([&] { return replace_layer(*stored); });
  }
  on_strand([&] {
    outdate([&](const LayerFormula& formula) {
      return std::ranges::any_of(formula.inputs,
                                 [&](const auto& input) { return input.table == table_id; });
    });
  });
}

Result<void> OpenRoom::check_expression(const Expression& expression, const std::string& field,
                                        Visibility layer) const {
  std::vector<query::LayerView> views;
  for (const Layer& each : layers()) views.push_back({each, {}});
  for (const std::string& shape : shapes_read(expression, views)) {
    views.emplace_back();
    views.back().layer.slug = std::string(kShapePrefix) + shape;
  }
  const auto bound = bind_for_layer(expression, views, parts_.store, Role::owner, layer, field);
  return bound ? Result<void>{} : tl::unexpected(bound.error());
}

Result<Layer> OpenRoom::widen_layer(const Layer& layer, ValueType type,
                                    const store::FirstAnswer<Layer>& answer) {
  if (layer.formula || !widens_to(layer.type, type))
    return fail(
        ErrorCode::invalid, "Type not usable",
        "A layer of whole numbers without a sign becomes a wider one of them (u8 to u16 or u32, u16 to u32); "
        "computed layers have the type that they were made with.",
        "type");
  return exclusively<Layer>([this, layer, type, answer]() -> Result<Layer> {
    const auto held = STRATA_TRY(state(std::to_string(layer.id)));
    // The GPU first, as for a new layer. Nothing is on its way to the journal: the mirror is what
    // it holds.
    TileMirror::Snapshot content = held.mirror->snapshot();
    for (auto& [address, tile] : content.tiles)
      tile = std::make_shared<const TileData>(widened(*tile, type));
    auto mirror = std::make_shared<TileMirror>(type, layer.resolution);
    mirror->assign(std::move(content.tiles), content.sequence);
    auto handle = add_layer(parts_.renderer, model_handle(), mirror);
    if (!handle) return tl::unexpected(gpu_problem(handle.error()));
    auto stored = parts_.store.layers().widen(layer, type, answer);
    if (!stored) {
      parts_.renderer.remove_layer(*handle);
      return stored;
    }
    on_strand([&] {
      render::LayerHandle old = 0;
      {
        std::lock_guard lock(mutex_);
        const auto found = layers_.find(layer.id);
        if (found == layers_.end()) return;
        old = std::exchange(found->second.handles.content, *handle);
        found->second.mirror = mirror;
        found->second.sums = std::make_shared<query::TileSumsCache>();
        found->second.layer.type = type;
        mirrors_share_.recount(mirror_bytes());
      }
      *stored = replace_layer(*stored);
      parts_.renderer.remove_layer(old);
    });
    return stored;
  });
}

Result<void> OpenRoom::delete_layer(std::int64_t id, const store::FirstAnswer<>& answer) {
  return let_go_of_layer(id,
                         [this, id, answer] { return parts_.store.layers().remove(id, answer); });
}
Result<void> OpenRoom::bin_layer(std::int64_t id, const store::FirstAnswer<>& answer) {
  return let_go_of_layer(id,
                         [this, id, answer] { return parts_.store.bin().put_layer(id, answer); });
}

Result<void> OpenRoom::let_go_of_layer(std::int64_t id,
                                       const std::function<Result<void>()>& in_store) {
  // In the order of edits: none of the layer's may be on its way to a journal that no longer knows
  // it.
  return exclusively<void>([this, id, in_store]() -> Result<void> {
    STRATA_TRY(in_store());
    on_strand([&] {
      LayerState gone;
      {
        std::lock_guard lock(mutex_);
        auto found = layers_.find(id);
        if (found == layers_.end()) return;
        gone = std::move(found->second);
        layers_.erase(found);
        mirrors_share_.recount(mirror_bytes());
      }
      remove_layer(parts_.renderer, gone.handles);
      tell_seen(gone.layer,
                [&](Listener& l) { l.layer_changed(Listener::LayerChange::deleted, gone.layer); });
      outdate([&](const LayerFormula& formula) {
        return std::ranges::any_of(formula.inputs,
                                   [&](const auto& input) { return input.layer == id; });
      });
      sort_layers_changed();
    });
    return {};
  });
}

Result<store::BinRestored> OpenRoom::restore_layer(
    const store::BinEntry& entry, const store::FirstAnswer<store::BinRestored>& answer) {
  // In the order of edits: the journal's numbers stay as they are.
  auto restored =
      exclusively<store::BinRestored>([this, entry, answer]() -> Result<store::BinRestored> {
        auto back = STRATA_TRY(parts_.store.bin().restore(entry, answer));
        if (auto known = take_up_layer(entry.id); !known) {
          // It is there, as the database says: the room reads everything again until it has it.
          log::warning("layer " + std::to_string(entry.id) +
                       " was restored and could not be loaded: " + known.error().detail);
          on_strand([&] { journal_differs(); });
        }
        return back;
      });
  return restored;
}

Result<void> OpenRoom::take_up_layer(std::int64_t id) {
  auto layer = STRATA_TRY(parts_.store.layers().find(model_id_, std::to_string(id), Role::owner));
  auto state = STRATA_TRY(read_layer_state(parts_.store, std::move(layer)));
  auto handles = add_layer(parts_.renderer, model_handle(), state);
  if (!handles) return tl::unexpected(gpu_problem(handles.error()));
  state.handles = *handles;
  maps_->request(state.layer.resolution, [](auto) {});
  on_strand([&] {
    {
      std::lock_guard lock(mutex_);
      layers_.emplace(id, state);
      mirrors_share_.recount(mirror_bytes());
    }
    tell_layer(std::nullopt, state.layer);
    sort_layers_changed();
  });
  // Layers that are computed from it may be up to date again.
  for (const Layer& other : layers()) {
    if (!other.formula || std::ranges::none_of(other.formula->inputs, [&](const auto& input) {
          return input.layer == id;
        }))
      continue;
    if (auto stored = parts_.store.layers().find(model_id_, std::to_string(other.id), Role::owner))
      on_strand([&] { replace_layer(*stored); });
  }
  return {};
}

Result<Model> OpenRoom::update_model(Model model, const store::FirstAnswer<Model>& answer) {
  auto updated = STRATA_TRY(parts_.store.models().update(std::move(model), answer));
  on_strand([&] {
    {
      std::lock_guard lock(mutex_);
      model_ = updated;
    }
    tell([&](Listener& l) { l.model_changed(updated); });
    sort_layers_changed();  // patterns are spaced in millimetres
  });
  return updated;
}

Result<Look> OpenRoom::look(const std::string& ref) const {
  if (auto look = look_shelf_->find(ref)) return *look;
  return no_such("look", ref, "look");
}

Result<Look> OpenRoom::create_look(Look look, std::span<const std::uint8_t> picture,
                                   const store::FirstAnswer<Look>& answer) {
  look.model_id = model_id_;
  auto created = STRATA_TRY(parts_.store.looks().create(look, picture, answer));
  look_shelf_->put(created);
  tell_look(Listener::LayerChange::created, created);
  return created;
}

Result<Look> OpenRoom::update_look(const Look& look, const store::FirstAnswer<Look>& answer) {
  auto updated = STRATA_TRY(parts_.store.looks().update(look, answer));
  look_shelf_->put(updated);
  tell_look(Listener::LayerChange::changed, updated);
  return updated;
}

Result<void> OpenRoom::delete_look(std::int64_t id, const store::FirstAnswer<>& answer) {
  const auto known = look_shelf_->find(std::to_string(id));
  STRATA_TRY(parts_.store.looks().remove(id, answer));
  look_shelf_->drop(id);
  if (known) tell_look(Listener::LayerChange::deleted, *known);
  return {};
}

void OpenRoom::tell_look(Listener::LayerChange change, const Look& look) {
  on_strand([&] { tell([&](Listener& l) { l.look_changed(change, look); }); });
  sort_layers_changed();
}

void OpenRoom::sort_layers_changed() {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_) member->styles_changed();
}

// -------------------------------------------------------------------------------------------------------
// edits

void OpenRoom::edit(EditRequest request, Applied applied, Saved saved) {
  touch();
  if (!takes_edits_)
    return saved(
        fail(ErrorCode::unavailable, "Server is stopping",
             "The server saves what is under way and stops; send the edit again when it is back."));
  // Counted before it is posted: the strand's own queue has no bound.
  if (++unanswered_ > parts_.options.max_waiting_edits) {
    --unanswered_;
    return saved(fail(ErrorCode::too_many_requests, "Too many edits",
                      "This model has as many waiting edits as it may; send more slowly."));
  }
  boost::asio::post(strand_, [self = shared_from_this(), request = std::move(request),
                              applied = std::move(applied), saved = std::move(saved)]() mutable {
    if (auto free = self->check_not_retired(request); !free) {
      --self->unanswered_;
      return saved(tl::unexpected(free.error()));
    }
    // The answer keeps the room alive until it is given.
    self->pipeline_->edit(std::move(request), std::move(applied),
                          [self, saved = std::move(saved)](Result<EditAnswer> answer) {
                            --self->unanswered_;
                            saved(std::move(answer));
                          });
  });
}

Result<void> OpenRoom::settle() {
  return exclusively<void>([]() -> Result<void> { return {}; });
}

// Here, in the order of edits: what a deletion does to the texels comes after every edit that was
// let in.
Result<void> OpenRoom::check_not_retired(const EditRequest& request) {
  const LayerState* state = find_layer(request.layer_id);
  if (!state || !state->layer.table || !parts_.retired_keys.has_any_of(*state->layer.table))
    return {};
  for (const auto key : painted_by(state->layer, request))
    if (parts_.retired_keys.holds(*state->layer.table, key))
      return fail(ErrorCode::conflict, "Record was deleted",
                  "Record " + std::to_string(key) + " was deleted meanwhile.", "value");
  return {};
}

LayerState* OpenRoom::find_layer(std::int64_t id) {
  auto found = layers_.find(id);
  return found == layers_.end() ? nullptr : &found->second;
}

std::vector<query::LayerView> OpenRoom::layer_snapshots() {
  std::vector<query::LayerView> views;
  for (const auto& [id, state] : layers_) views.push_back({state.layer, state.mirror->snapshot()});
  return views;
}

void OpenRoom::set_sequence(LayerState& layer, std::int64_t sequence) {
  std::lock_guard lock(mutex_);
  layer.layer.sequence = sequence;
  mirrors_share_.recount(mirror_bytes());
}

std::uint64_t OpenRoom::mirror_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [id, state] : layers_)
    bytes += state.mirror->bytes() + state.provisional->bytes();
  return bytes;
}

void OpenRoom::content_changed(const LayerState& layer,
                               const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_) member->content_changed(layer.layer.id, box, sequence);
}

void OpenRoom::edit_applied(const Listener::Edit& edit) {
  sequence_ = edit.sequence;
  if (const auto state = layer_state(edit.layer_id))
    tell_seen(state->layer, [&](Listener& l) { l.edit_applied(edit); });
}

void OpenRoom::edit_saved(const Listener::Edit& edit) {
  durable_ = edit.sequence;
  outdate([&](const LayerFormula& formula) {
    return formula.computed_sequence < edit.sequence &&
           std::ranges::any_of(formula.inputs,
                               [&](const auto& input) { return input.layer == edit.layer_id; });
  });
}

void OpenRoom::edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) {
  sequence_ = pipeline_->sequence();
  std::lock_guard lock(members_mutex_);
  for (const RoomMember* member : members_) {
    if (!member->listener()) continue;
    std::vector<Listener::Edit> seen;
    for (const Listener::Edit& edit : edits)
      if (const auto state = layer_state(edit.layer_id);
          state && sees(member->role(), state->layer.visibility))
        seen.push_back(edit);
    if (!seen.empty()) member->listener()->edits_unsaved(seen, why);
  }
}

// ------------------------------------------------------------------------------------------------------
// people

std::unique_ptr<Member> OpenRoom::join(Author who, Portrait portrait, Listener* listener,
                                       stream::Viewer::Send send) {
  std::unique_ptr<RoomMember> member;
  {
    std::lock_guard lock(members_mutex_);
    member = std::make_unique<RoomMember>(shared_from_this(), std::move(who), std::move(portrait),
                                          listener, std::move(send));
    members_.push_back(member.get());
  }
  touch();
  announce_presence();
  return member;
}

void OpenRoom::tell(const std::function<void(Listener&)>& tell) {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_)
    if (member->listener()) tell(*member->listener());
}

void OpenRoom::tell_seen(const Layer& layer, const std::function<void(Listener&)>& tell) {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_)
    if (member->listener() && sees(member->role(), layer.visibility)) tell(*member->listener());
}

void OpenRoom::tell_layer(std::optional<Visibility> before, const Layer& layer) {
  using Change = Listener::LayerChange;
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_) {
    const bool saw = before && sees(member->role(), *before),
               sees_now = sees(member->role(), layer.visibility);
    if (!member->listener() || (!saw && !sees_now)) continue;
    member->listener()->layer_changed(!sees_now ? Change::deleted
                                      : saw     ? Change::changed
                                                : Change::created,
                                      layer);
  }
}

void OpenRoom::leave(RoomMember* member) {
  {
    std::lock_guard lock(members_mutex_);
    departed_ += std::erase(members_, member);
    followers_.leave(member->session());
  }
  touch();
  announce_presence();
}

void OpenRoom::announce_presence() {
  boost::asio::post(strand_, [self = shared_from_this()] {
    self->tell([](Listener& l) { l.presence_changed(); });
  });
}

Result<void> OpenRoom::follow(const Uuid& follower, const std::optional<Uuid>& leader) {
  bool other = false;
  {
    std::lock_guard lock(members_mutex_);
    if (!leader) {
      other = followers_.stop(follower);
    } else {
      const bool here = std::any_of(members_.begin(), members_.end(), [&](const auto* member) {
        return member->session() == *leader;
      });
      if (!here)
        return fail(
            ErrorCode::not_found, "Not here",
            "Who is to be followed has left, or was never at this model. `presence` lists who is here.",
            "follow");
      auto followed = STRATA_TRY(followers_.follow(follower, *leader));
      other = followed;
    }
  }
  if (other) announce_presence();
  return {};
}

void OpenRoom::camera_moved(const Uuid& session) {
  {
    std::lock_guard lock(members_mutex_);
    if (!followers_.has_followers(session)) return;
  }
  boost::asio::post(strand_, [self = shared_from_this(), session] {
    std::lock_guard lock(self->members_mutex_);
    for (RoomMember* member : self->members_)
      if (member->listener() && self->followers_.leader_of(member->session()) == session)
        member->listener()->presence_changed();
  });
}

std::vector<Presence> OpenRoom::presence(const Uuid& receiver) const {
  std::lock_guard lock(members_mutex_);
  const auto leader = followers_.leader_of(receiver);
  std::vector<Presence> people;
  for (const RoomMember* member : members_) {
    people.push_back(member->presence());
    people.back().following = followers_.leader_of(member->session());
    if (leader != member->session()) people.back().camera.reset();
  }
  return people;
}

void OpenRoom::touch() {
  std::lock_guard lock(mutex_);
  last_used_ = std::chrono::steady_clock::now();
}

std::size_t OpenRoom::people() const {
  std::lock_guard lock(members_mutex_);
  return members_.size();
}

std::size_t OpenRoom::take_departed() {
  std::lock_guard lock(members_mutex_);
  return std::exchange(departed_, 0);
}

bool OpenRoom::drop_map() {
  return surface_->drop_graphs() ||
         on_strand([&] { return pipeline_->is_still() && maps_->drop_oldest(); });
}

bool OpenRoom::drop_large_unused_maps(std::chrono::steady_clock::time_point now) {
  constexpr std::uint64_t kLarge = 512u << 20;  // others are back within a second
  constexpr std::chrono::minutes kKept{2};
  const auto since = now - kKept;
  const auto oldest = maps_->oldest_use();
  if (!oldest || *oldest >= since) return false;
  const bool dropped =
      on_strand([&] { return pipeline_->is_still() && maps_->drop_unused(since, kLarge); });
  if (dropped) surface_->drop_graphs();
  return dropped;
}

bool OpenRoom::deserted(std::chrono::steady_clock::time_point now) const {
  if (people() > 0) return false;
  std::lock_guard lock(mutex_);
  return now - last_used_ > parts_.options.close_after;
}

void OpenRoom::shut(const Error& why) {
  {
    std::lock_guard lock(mutex_);
    shut_ = why;
  }
  maps_->stop();
  look_shelf_->stop();
  record_colors_->stop();
  record_marks_->stop();
  surface_->stop();
  on_strand([&] {
    recovery_.shut = true;
    recovery_.timer.cancel();
    pipeline_->close(why);
  });
  parts_.renderer.remove_model(model_handle());
}

Error OpenRoom::gpu_problem(const Error& why) const {
  std::lock_guard lock(mutex_);
  return why.code == ErrorCode::not_found && shut_ ? *shut_ : room::gpu_problem(why);
}

void OpenRoom::shut_deleted() {
  on_strand([&] { tell([](Listener& l) { l.model_deleted(); }); });
  shut({ErrorCode::gone,
        "Model deleted",
        "The model was deleted; nothing can be painted on it any more.",
        {}});
}

// -----------------------------------------------------------------------------------------------------
// queries

Result<std::shared_ptr<const mesh::SurfaceMap>> OpenRoom::surface_map(int resolution) {
  touch();
  auto map = maps_->wait(resolution);
  if (!map) return tl::unexpected(gpu_problem(map.error()));
  return map;
}

Result<std::map<std::int64_t, query::KeyArea>> OpenRoom::key_areas(const std::string& layer) {
  touch();
  const auto found = STRATA_TRY(state(layer));
  const auto map = STRATA_TRY(surface_map(found.layer.resolution));
  return query::key_areas({found.layer, found.mirror->snapshot()}, *map, geometry_->origin,
                          model().metres(), found.sums.get());
}

Result<void> OpenRoom::sum_layer(std::int64_t layer_id) {
  touch();
  const auto found = STRATA_TRY(state(std::to_string(layer_id)));
  const auto map = surface_map(found.layer.resolution);
  if (!map) return tl::unexpected(map.error());
  return exclusively<void>(
      [this, layer = found.layer, mirror = found.mirror, map = *map]() -> Result<void> {
        const auto snapshot = mirror->snapshot();
        return parts_.store.layers().keep_sums(
            layer.id, sum_tiles(layer, *map, {snapshot.tiles.begin(), snapshot.tiles.end()}));
      });
}

}  // namespace strata::room
