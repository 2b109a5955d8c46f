#include "room/open/open_room.h"
#include "domain/scene/model_measures.h"

#include <algorithm>
#include <boost/asio/post.hpp>

#include "core/log.h"
#include "core/text/slug.h"
#include "room/open/following.h"
#include "room/open/open_edits.h"
#include "room/open/open_layers.h"
#include "room/open/open_participants.h"
#include "room/open/open_pictures.h"
#include "room/open/open_queries.h"
#include "room/open/open_surface.h"
#include "room/open/open_surface_images.h"
#include "room/pipeline/gpu_problem.h"
#include "room/pipeline/strand.h"
#include "store/content/models.h"
#include "store/content/surface_images.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"
#include "store/store.h"

namespace strata::room {
namespace {

// The epochs of claims are higher, so the journal refuses every entry with this one.
constexpr std::int64_t kNoClaim = 0;

}  // namespace

OpenRoom::OpenRoom(const RoomServices& services, Model model, std::int64_t epoch,
                   render::ModelGeometry geometry)
    : services_(services),
      model_id_(model.id),
      epoch_(epoch),
      geometry_(std::move(geometry.full)),
      coarser_(std::move(geometry.coarser)),
      strand_(services.strands.get_executor()),
      maps_(std::make_shared<SurfaceMaps>(geometry_, services.renderer, services.memory,
                                          services.workers)),
      surface_lookup_(std::make_shared<SurfaceLookup>(geometry_, services.memory)),
      appearance_(std::make_shared<AppearanceCache>(geometry_, services.memory)),
      model_(std::move(model)),
      last_used_(std::chrono::steady_clock::now()),
      recovery_(strand_),
      layers_part_(std::make_unique<LayersPart>(*this)),
      edits_part_(std::make_unique<EditsPart>(*this)),
      queries_part_(std::make_unique<QueriesPart>(*this)),
      surface_part_(std::make_unique<SurfacePart>(*this)),
      pictures_part_(std::make_unique<PicturesPart>(*this)),
      surface_images_part_(std::make_unique<SurfaceImagesPart>(*this)),
      participants_part_(std::make_unique<ParticipantsPart>(*this)) {
  parts_ = {layers_part_.get(),      edits_part_.get(),    queries_part_.get(),
            surface_part_.get(),     pictures_part_.get(), surface_images_part_.get(),
            participants_part_.get()};
}

OpenRoom::~OpenRoom() = default;

Result<std::shared_ptr<OpenRoom>> OpenRoom::open(const RoomServices& services,
                                                 const std::string& model_ref) {
  auto model = STRATA_TRY(services.store.models().find(model_ref));
  const ModelId id = model.id;
  // Claims the model before reading its journal, so that no other server can add edits afterwards.
  const auto epoch = STRATA_TRY(services.store.nodes().claim(id, services.options.node));
  auto room = load(services, std::move(model), epoch);
  if (!room && services.options.node) (void)services.store.nodes().release(id, epoch);
  return room;
}

Result<std::shared_ptr<OpenRoom>> OpenRoom::follow(const RoomServices& services,
                                                   const std::string& model_ref) {
  auto model = STRATA_TRY(services.store.models().find(model_ref));
  // Read before the content, so the first comparison finds all later changes.
  auto state = STRATA_TRY(services.store.journal().model_state(model.id));
  state.version = model.version;
  auto room = STRATA_TRY(load(services, std::move(model), std::nullopt));
  room->following_part_ = std::make_unique<FollowingPart>(*room, state);
  return room;
}

Result<std::shared_ptr<OpenRoom>> OpenRoom::load(const RoomServices& services, Model model,
                                                 std::optional<std::int64_t> claimed) {
  const std::int64_t epoch = claimed.value_or(kNoClaim);
  auto geometry = STRATA_TRY(read_geometry(services.store, model.id));
  std::uint64_t bytes = geometry.full->bytes();
  for (const auto& level : geometry.coarser) bytes += level->bytes();
  auto share = STRATA_TRY(services.memory.reserve(bytes, "the model's triangles"));
  auto room = std::make_shared<OpenRoom>(services, std::move(model), epoch, std::move(geometry));
  room->geometry_share_ = std::move(share);
  auto journal = read_journal(services.store, room->model_id_, {});
  if (!journal) return tl::unexpected(journal.error());
  if (claimed && journal->epoch != epoch) return tl::unexpected(moved_to({}));
  auto images = STRATA_TRY(services.store.surface_images().of_model(room->model_id_));
  room->contact_shadow_ = room->make_contact_shadow(room->model_.up);
  for (LayerState& state : journal->layers) {
    const LayerId id = state.layer.id;
    room->layers_.emplace(id, std::move(state));
  }
  auto mirrors = services.memory.reserve(room->mirror_bytes(), "the content of the model's layers");
  if (!mirrors) return tl::unexpected(mirrors.error());
  room->mirrors_share_ = std::move(*mirrors);
  auto gpu = fill_gpu(services.renderer, {room->geometry_, room->coarser_}, room->layer_states());
  if (!gpu) return tl::unexpected(gpu.error());
  for (auto& [id, state] : room->layers_) state.handles = gpu->layers.at(id);
  room->model_handle_ = gpu->model;
  room->maps_->set_model(gpu->model);
  const auto restyle = [weak = std::weak_ptr<OpenRoom>(room)] {
    auto open = weak.lock();
    if (!open) return;
    // This code runs on the GPU thread, but styles_changed must run on the strand.
    const Strand strand = open->strand_;
    boost::asio::post(strand,
                      [open = std::move(open)] { open->participants_part_->styles_changed(); });
  };
  room->surface_image_cache_ = std::make_shared<SurfaceImageCache>(
      services.store, services.renderer, services.workers, services.memory, restyle);
  room->record_colors_ = std::make_shared<RecordColors>(services.store, services.workers, restyle);
  room->record_features_ = std::make_shared<RecordFeatures>(
      services.store, services.workers, room->id(), room->surface_lookup_, restyle);
  room->past_layers_ = std::make_shared<PastLayers>(
      services.store, services.renderer, services.workers, services.memory, room->record_features_,
      room->id(),
      [weak = std::weak_ptr<OpenRoom>(room)](const Layer& layer) {
        const auto open = weak.lock();
        return open ? open->durable_tiles(layer) : std::nullopt;
      },
      restyle);
  room->surface_image_cache_->set_model(gpu->model);
  room->past_layers_->set_model(gpu->model);
  for (const SurfaceImage& image : images) room->surface_image_cache_->put(image);
  room->sequence_ = room->durable_ = journal->last_sequence;
  room->pipeline_ = std::make_shared<EditPipeline>(
      EditPipeline::Parts{services.store, services.writer, services.renderer, services.workers,
                          services.readers, room->strand_, room->maps_, room->surface_lookup_,
                          services.memory, epoch, room->model_id_, services.timings,
                          services.options.slow_after},
      *room, journal->last_sequence);
  // Painting needs the maps of the existing layers, so they are baked in the background.
  for (const auto& state : room->layer_states())
    if (claimed)
      room->maps_->request(state.layer.resolution, [](auto) {});
    else
      room->maps_->make_bounds(state.layer.resolution);
  return room;
}

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

std::vector<Layer> OpenRoom::layer_list() const {
  std::vector<Layer> layers;
  for (auto& state : layer_states()) layers.push_back(std::move(state.layer));
  return layers;
}

Result<LayerState> OpenRoom::state(const std::string& ref) const {
  std::lock_guard lock(mutex_);
  for (const auto& [id, state] : layers_)
    if (is_all_digits(ref) ? to_string(id) == ref : state.layer.slug == ref) return state;
  return no_such_layer(ref);
}

std::optional<LayerState> OpenRoom::layer_state(LayerId id) const {
  std::lock_guard lock(mutex_);
  auto found = layers_.find(id);
  return found == layers_.end() ? std::nullopt : std::optional(found->second);
}

Result<void> OpenRoom::check_durable(At at) const {
  if (!at || *at <= durable_) return {};
  return fail(ErrorCode::invalid, "Sequence out of range",
              "The newest durable edit of this model is " + std::to_string(durable_) + ".", "at");
}

std::optional<TileMirror::Snapshot> OpenRoom::durable_tiles(const Layer& layer) const {
  const auto state = layer_state(layer.id);
  if (!state || state->mirror->type() != layer.type) return std::nullopt;
  auto newest = state->mirror->snapshot();
  // The journal may still reject the last edits of this state.
  if (newest.sequence > durable_) return std::nullopt;
  return newest;
}

Result<TileMirror::Snapshot> OpenRoom::tiles_at(const LayerState& state, At at) const {
  if (!at) return state.mirror->snapshot();
  STRATA_TRY(check_durable(at));
  return services_.store.journal().load_tiles(state.layer, at);
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

render::ModelHandle OpenRoom::model_handle() const {
  std::lock_guard lock(mutex_);
  return model_handle_;
}

// A coarse copy of the model is enough for a soft shadow.
std::shared_ptr<const mesh::ContactShadow> OpenRoom::make_contact_shadow(
    const std::string& up) const {
  return mesh::contact_shadow(coarser_.empty() ? *geometry_ : *coarser_.back(), up);
}

std::shared_ptr<const mesh::ContactShadow> OpenRoom::contact_shadow(const Light& light) const {
  if (light.mode != LightMode::museum) return nullptr;
  std::lock_guard lock(mutex_);
  return contact_shadow_;
}

Result<Model> OpenRoom::update_model(Model model, const store::IdempotentResponse<Model>& answer) {
  STRATA_TRY(check_claimed());
  auto updated = STRATA_TRY(services_.store.models().update(std::move(model), answer));
  show_model(updated);
  return updated;
}

void OpenRoom::show_model(const Model& updated) {
  const bool is_turned = updated.up != this->model().up;
  auto shadow = is_turned ? make_contact_shadow(updated.up) : nullptr;
  run_on(strand_, [&] { replace_model(updated, std::move(shadow)); });
}

void OpenRoom::replace_model(const Model& stored,
                             std::shared_ptr<const mesh::ContactShadow> shadow) {
  bool outdates_layers = false;
  {
    std::lock_guard lock(mutex_);
    outdates_layers = !same_measures(stored, model_);
    if (stored.up != model_.up) contact_shadow_ = std::move(shadow);
    model_ = stored;
    // As in Models::update.
    for (auto& [id, state] : layers_)
      if (outdates_layers && state.layer.formula) state.layer.formula->computed_sequence = 0;
  }
  participants_part_->tell([&](Listener& l) { l.model_changed(stored); });
  if (outdates_layers) layers_part_->outdate([](const LayerFormula&) { return true; });
  participants_part_->styles_changed();  // the spacing of patterns is in millimeters
}

Result<void> OpenRoom::settle() {
  return exclusively<void>([]() -> Result<void> { return {}; });
}

LayerState* OpenRoom::find_layer(LayerId id) {
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
  // First, because a new view reports this sequence with its first frame, which shows the change.
  sequence_ = sequence;
  participants_part_->content_changed(layer.layer, box, sequence);
}

void OpenRoom::styles_changed() { participants_part_->styles_changed(); }

void OpenRoom::edit_applied(const Listener::Edit& edit) {
  sequence_ = edit.sequence;
  if (const auto state = layer_state(edit.layer_id))
    participants_part_->tell_seen(state->layer, [&](Listener& l) { l.edit_applied(edit); });
}

void OpenRoom::edit_saved(const Listener::Edit& edit) {
  durable_ = edit.sequence;
  outdate_readers(edit.layer_id, edit.sequence);
}

void OpenRoom::outdate_readers(LayerId layer_id, std::int64_t sequence) {
  layers_part_->outdate([&](const LayerFormula& formula) {
    return formula.computed_sequence < sequence &&
           std::ranges::any_of(formula.inputs,
                               [&](const auto& input) { return input.layer == layer_id; });
  });
}

void OpenRoom::edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) {
  sequence_ = pipeline_->sequence();
  participants_part_->tell_unsaved(edits, why);
}

void OpenRoom::tell_moved(const Error& why) {
  if (moved_) return;
  moved_ = why;
  {
    std::lock_guard lock(mutex_);
    closed_ = why;
  }
  if (following_part_) following_part_->stop();
  recovery_.closed = true;
  recovery_.timer.cancel();
  pipeline_->close(why);
  participants_part_->tell_moved(why.location);
}

void OpenRoom::move_away(const Error& why) {
  run_on(strand_, [&] { tell_moved(why); });
}

void OpenRoom::stop_saving(const Error& why) {
  run_on(strand_, [&] {
    if (moved_) return;
    ++recovery_.metadata_changes;
    recovery_.metadata_outdated = recovery_.compared = false;
    // Notifies listeners first, so clients keep refused edits until the database answers.
    if (is_current_.exchange(false))
      participants_part_->tell([](Listener& l) { l.database_reachable(false); });
    if (following_part_)
      following_part_->suspend();
    else
      pipeline_->stop_saving(why);
  });
}

void OpenRoom::continue_saving() {
  if (following_part_) return following_part_->resume();
  run_on(strand_, [&] {
    if (moved_) return;
    recovery_.metadata_outdated = !is_current_;
    pipeline_->continue_saving();
  });
}

void OpenRoom::saving_continued() {
  recovery_.compared = true;
  if (recovery_.metadata_outdated)
    pipeline_->pause();  // then `recover` reads the metadata
  else
    report_current();
}

void OpenRoom::report_current() {
  if (is_current_ || !recovery_.compared || recovery_.metadata_outdated) return;
  is_current_ = true;
  // What could not be read in the meantime is read now, also what nobody has changed.
  record_colors_->make_again();
  record_features_->read_again();
  past_layers_->allow_retries();
  participants_part_->styles_changed();
  participants_part_->tell([](Listener& l) { l.database_reachable(true); });
}

void OpenRoom::deposed(const Error& reason) {
  if (moved_) return;
  const bool is_gone = reason.code == ErrorCode::not_found;
  log::warning(
      (is_gone ? "another server has deleted model " : "another server has claimed model ") +
      to_string(model_id_) + ", so this server closes it");
  // Clients of a deleted model connect again, and then learn that it is gone.
  const Error why = is_gone ? moved_to({}) : reason;
  tell_moved(why);
  boost::asio::post(services_.workers, [self = shared_from_this(), why] {
    if (self->services_.on_deposed) self->services_.on_deposed(self, why);
  });
}

Result<void> OpenRoom::check_claimed() const {
  if (following_part_) return tl::unexpected(moved_to({}));
  return {};
}

Result<void> OpenRoom::check_not_deposed() {
  if (!services_.options.node) return {};
  // Ignores errors of this query. If the work also needs the database, the work reports them.
  const auto state = services_.store.journal().state(model_id_, {});
  if (!state || state->epoch == epoch_) return {};
  const Error why = moved_to({});
  boost::asio::post(strand_, [self = shared_from_this(), why] { self->deposed(why); });
  return tl::unexpected(why);
}

void OpenRoom::release() {
  if (!services_.options.node || following_part_) return;
  if (auto released = services_.store.nodes().release(model_id_, epoch_); !released)
    log::warning("model " + to_string(model_id_) +
                 " could not be released: " + released.error().detail);
}

std::size_t OpenRoom::participant_count() const { return participants_part_->count(); }

std::size_t OpenRoom::take_leave_count() { return participants_part_->take_leave_count(); }

void OpenRoom::touch() {
  std::lock_guard lock(mutex_);
  last_used_ = std::chrono::steady_clock::now();
}

bool OpenRoom::drop_map() {
  return past_layers_->drop_unused() || appearance_->drop() || surface_lookup_->drop_graphs() ||
         run_on(strand_, [&] { return pipeline_->is_still() && maps_->drop_oldest(); });
}

bool OpenRoom::drop_large_unused_maps(std::chrono::steady_clock::time_point now) {
  constexpr std::uint64_t kLarge = 512u << 20;  // smaller maps are baked again within a second
  constexpr std::chrono::minutes kKept{2};
  const auto since = now - kKept;
  const auto oldest = maps_->oldest_use();
  if (!oldest || *oldest >= since) return false;
  const bool dropped =
      run_on(strand_, [&] { return pipeline_->is_still() && maps_->drop_unused(since, kLarge); });
  if (dropped) {
    surface_lookup_->drop_graphs();
    appearance_->drop();
  }
  return dropped;
}

bool OpenRoom::is_idle(std::chrono::steady_clock::time_point now) const {
  if (participants_part_->count() > 0) return false;
  std::lock_guard lock(mutex_);
  return now - last_used_ > services_.options.close_after;
}

void OpenRoom::close(const Error& why) {
  {
    std::lock_guard lock(mutex_);
    closed_ = why;
  }
  if (following_part_) following_part_->stop();
  maps_->stop();
  surface_image_cache_->stop();
  record_colors_->stop();
  record_features_->stop();
  past_layers_->stop();
  surface_lookup_->stop();
  appearance_->stop();
  run_on(strand_, [&] {
    recovery_.closed = true;
    recovery_.timer.cancel();
    pipeline_->close(why);
  });
  services_.renderer.remove_model(model_handle());
}

Error OpenRoom::gpu_problem(const Error& why) const {
  std::lock_guard lock(mutex_);
  return why.code == ErrorCode::not_found && closed_ ? *closed_ : room::gpu_problem(why);
}

void OpenRoom::close_deleted() {
  run_on(strand_, [&] { participants_part_->tell([](Listener& l) { l.model_deleted(); }); });
  close({ErrorCode::gone,
         "Model deleted",
         "The model was deleted, so you can no longer paint on it.",
         {}});
}

Result<std::shared_ptr<const mesh::SurfaceMap>> OpenRoom::surface_map(int resolution) {
  touch();
  auto map = maps_->wait(resolution);
  if (!map) return tl::unexpected(gpu_problem(map.error()));
  return map;
}

}  // namespace strata::room
