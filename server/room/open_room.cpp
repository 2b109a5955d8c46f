#include "room/open_room.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <charconv>
#include <future>

#include "core/log.h"
#include "core/slug.h"
#include "room/await.h"

namespace strata::room {
namespace {

constexpr std::array<const char*, 8> kColors{"#d55e00", "#0072b2", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#7b5ea7", "#5c7a29"};

Result<void> check_layer(const Layer& layer, const Model& model) {
  const int lowest = model.atlas.lowest_resolution;
  if (layer.resolution < lowest || layer.resolution > 16384 || (layer.resolution & (layer.resolution - 1)) != 0)
    return fail(422, "Resolution out of range",
                "A layer of this model has a power of two from " + std::to_string(lowest) + " to 16384 texels a side.",
                "resolution");
  if (layer.name.empty() || layer.name.size() > 200)
    return fail(422, "Name missing", "A layer has a name of 1 to 200 bytes.", "name");
  if (!(layer.opacity >= 0 && layer.opacity <= 1))
    return fail(422, "Opacity out of range", "Opacity goes from 0 (clear) to 1 (opaque).", "opacity");
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

template <class Tell>
void OpenRoom::tell(Tell tell) {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_)
    if (member->listener()) tell(*member->listener());
}

OpenRoom::OpenRoom(const RoomParts& parts, Model model, std::shared_ptr<const mesh::Geometry> geometry)
    : parts_(parts),
      model_id_(model.id),
      geometry_(std::move(geometry)),
      strand_(parts.strands.get_executor()),
      maps_(std::make_shared<SurfaceMaps>(geometry_, parts.renderer, parts.workers)),
      model_(std::move(model)),
      last_used_(std::chrono::steady_clock::now()) {}

OpenRoom::~OpenRoom() = default;

Result<std::shared_ptr<OpenRoom>> OpenRoom::open(const RoomParts& parts, const std::string& model_ref) {
  auto model = parts.store.model(model_ref);
  if (!model) return tl::unexpected(model.error());
  auto bytes = parts.store.geometry(model->id);
  if (!bytes) return tl::unexpected(bytes.error());
  auto geometry = mesh::decode_geometry(*bytes);
  if (!geometry) return tl::unexpected(geometry.error());
  auto last = parts.store.last_sequence(model->id);
  if (!last) return tl::unexpected(last.error());

  auto room = std::make_shared<OpenRoom>(parts, std::move(*model),
                                         std::make_shared<const mesh::Geometry>(std::move(*geometry)));
  room->sequence_ = room->durable_ = *last;
  room->pipeline_ = std::make_shared<EditPipeline>(
      EditPipeline::Parts{parts.store, parts.writer, parts.renderer, parts.workers, room->strand_, room->maps_,
                          parts.options.max_waiting_edits},
      *room, *last);
  if (auto done = room->add_to_gpu(true); !done) return tl::unexpected(done.error());
  // Painting needs the maps of the layers there are; bake them while people look around.
  for (const auto& state : room->layer_states()) room->maps_->request(state.layer.resolution, [](auto) {});
  return room;
}

// ------------------------------------------------------------------------------------------------- GPU contents

Result<std::shared_ptr<TileMirror>> OpenRoom::load_mirror(const Layer& layer) const {
  auto tiles = parts_.store.load_tiles(layer);
  if (!tiles) return tl::unexpected(tiles.error());
  auto mirror = std::make_shared<TileMirror>(layer.type, layer.resolution);
  mirror->put(tiles->tiles, tiles->sequence);
  return mirror;
}

Result<LayerState> OpenRoom::put_on_gpu(const Layer& layer, std::shared_ptr<TileMirror> mirror,
                                        render::ModelHandle model) const {
  auto handle = await<render::LayerHandle>(
      [&](auto done) { parts_.renderer.add_layer(model, layer.type, layer.resolution, std::move(done)); });
  if (!handle) return tl::unexpected(handle.error());
  std::vector<render::TileUpload> uploads;
  for (const auto& [address, data] : mirror->snapshot().tiles) uploads.push_back({address, data});
  if (!uploads.empty()) {
    auto written = await<void>(
        [&](auto done) { parts_.renderer.load_tiles(*handle, std::move(uploads), std::move(done)); });
    if (!written) return tl::unexpected(written.error());
  }
  return LayerState{layer, *handle, std::move(mirror), std::make_shared<const Palette>(layer.palette)};
}

Result<void> OpenRoom::add_to_gpu(bool from_store) {
  auto handle = await<render::ModelHandle>([&](auto done) { parts_.renderer.add_model(geometry_, std::move(done)); });
  if (!handle) return tl::unexpected(handle.error());
  std::map<std::int64_t, LayerState> states;
  auto undo = [&](const Problem& problem) {
    parts_.renderer.remove_model(*handle);
    return tl::unexpected(problem);
  };
  if (from_store) {
    auto layers = parts_.store.layers(model_id_);
    if (!layers) return undo(layers.error());
    for (const Layer& layer : *layers) {
      auto mirror = load_mirror(layer);
      if (!mirror) return undo(mirror.error());
      auto state = put_on_gpu(layer, std::move(*mirror), *handle);
      if (!state) return undo(state.error());
      states.emplace(layer.id, std::move(*state));
    }
  } else {
    for (const LayerState& old : layer_states()) {
      auto state = put_on_gpu(old.layer, old.mirror, *handle);
      if (!state) return undo(state.error());
      states.emplace(old.layer.id, std::move(*state));
    }
  }
  render::ModelHandle previous = 0;
  {
    std::lock_guard lock(mutex_);
    previous = std::exchange(model_handle_, *handle);
    layers_ = std::move(states);
  }
  if (previous) parts_.renderer.remove_model(previous);
  maps_->set_model(*handle);
  return {};
}

void OpenRoom::gpu_lost() {
  boost::asio::post(strand_, [self = shared_from_this()] {
    self->pipeline_->pause();
    // The mirrors hold what PostgreSQL has and what is on its way there: the GPU is rebuilt from them.
    boost::asio::post(self->parts_.workers, [self] { self->rebuild(false); });
  });
}

void OpenRoom::reload_from_store() {
  pipeline_->pause();
  boost::asio::post(parts_.workers, [self = shared_from_this()] { self->rebuild(true); });
}

void OpenRoom::rebuild(bool from_store) {
  auto last = from_store ? parts_.store.last_sequence(model_id_) : Result<std::int64_t>(sequence_.load());
  Result<void> done = last ? add_to_gpu(from_store) : tl::unexpected(last.error());
  if (!done) {
    log::error("model " + std::to_string(model_id_) + " could not be put on the GPU again: " + done.error().title + ": " +
               done.error().detail);
    // A lost context calls again; a database that is away is asked again.
    if (from_store) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      boost::asio::post(parts_.workers, [self = shared_from_this()] { self->rebuild(true); });
    }
    return;
  }
  boost::asio::post(strand_, [self = shared_from_this(), last = *last] {
    self->sequence_ = last;
    self->pipeline_->resume(last);
    self->durable_ = self->pipeline_->durable_sequence();
    const auto handle = self->model_handle();
    std::lock_guard lock(self->members_mutex_);
    for (RoomMember* member : self->members_) member->model_changed(handle);
  });
}

// ---------------------------------------------------------------------------------------------------- metadata

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
  std::stable_sort(states.begin(), states.end(),
                   [](const LayerState& a, const LayerState& b) { return a.layer.order < b.layer.order; });
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
  return fail(404, "No such layer", "This model has no layer \"" + ref + "\".", "layer");
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

Result<Layer> OpenRoom::create_layer(Layer layer) {
  layer.model_id = model_id_;
  if (auto ok = check_layer(layer, model()); !ok) return tl::unexpected(ok.error());
  auto created = parts_.store.create_layer(std::move(layer));
  if (!created) return created;
  auto state = put_on_gpu(*created, std::make_shared<TileMirror>(created->type, created->resolution), model_handle());
  if (!state) {
    if (auto removed = parts_.store.delete_layer(created->id); !removed)
      log::error("layer " + created->slug + " was not put on the GPU and stays in the database: " + removed.error().detail);
    return tl::unexpected(state.error());
  }
  on_strand([&] {
    {
      std::lock_guard lock(mutex_);
      layers_.emplace(created->id, std::move(*state));
    }
    tell([&](Listener& l) { l.layer_changed(Listener::LayerChange::created, *created); });
    sort_layers_changed();
  });
  maps_->request(created->resolution, [](auto) {});
  return created;
}

Result<Layer> OpenRoom::update_layer(Layer layer) {
  if (auto ok = check_layer(layer, model()); !ok) return tl::unexpected(ok.error());
  auto updated = parts_.store.update_layer(std::move(layer));
  if (!updated) return updated;
  on_strand([&] {
    {
      std::lock_guard lock(mutex_);
      auto found = layers_.find(updated->id);
      if (found == layers_.end()) return;
      updated->sequence = found->second.layer.sequence;
      found->second.layer = *updated;
      found->second.palette = std::make_shared<const Palette>(updated->palette);
    }
    tell([&](Listener& l) { l.layer_changed(Listener::LayerChange::changed, *updated); });
    sort_layers_changed();
  });
  return updated;
}

Result<void> OpenRoom::delete_layer(std::int64_t id) {
  auto promise = std::make_shared<std::promise<Result<void>>>();
  auto future = promise->get_future();
  boost::asio::post(strand_, [self = shared_from_this(), id, promise] {
    // In the order of edits: none of the layer's may be on its way to a journal that no longer knows it.
    self->pipeline_->when_idle([self, id, promise] {
      auto deleted = self->parts_.store.delete_layer(id);
      if (deleted)
        self->on_strand([&] {
          LayerState gone;
          {
            std::lock_guard lock(self->mutex_);
            auto found = self->layers_.find(id);
            if (found == self->layers_.end()) return;
            gone = std::move(found->second);
            self->layers_.erase(found);
          }
          self->parts_.renderer.remove_layer(gone.handle);
          self->tell([&](Listener& l) { l.layer_changed(Listener::LayerChange::deleted, gone.layer); });
          self->sort_layers_changed();
        });
      promise->set_value(std::move(deleted));
    });
  });
  return future.get();
}

Result<Model> OpenRoom::update_model(Model model) {
  auto updated = parts_.store.update_model(std::move(model));
  if (!updated) return updated;
  on_strand([&] {
    {
      std::lock_guard lock(mutex_);
      model_ = *updated;
    }
    tell([&](Listener& l) { l.model_changed(*updated); });
  });
  return updated;
}

void OpenRoom::sort_layers_changed() {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_) member->styles_changed();
}

// ------------------------------------------------------------------------------------------------------- edits

void OpenRoom::edit(EditRequest request, Applied applied, Saved saved) {
  touch();
  boost::asio::post(strand_, [self = shared_from_this(), request = std::move(request), applied = std::move(applied),
                              saved = std::move(saved)]() mutable {
    // The answer keeps the room alive until it is given.
    self->pipeline_->edit(std::move(request), std::move(applied),
                          [self, saved = std::move(saved)](Result<EditAnswer> answer) { saved(std::move(answer)); });
  });
}

LayerState* OpenRoom::find_layer(std::int64_t id) {
  auto found = layers_.find(id);
  return found == layers_.end() ? nullptr : &found->second;
}

void OpenRoom::set_sequence(LayerState& layer, std::int64_t sequence) {
  std::lock_guard lock(mutex_);
  layer.layer.sequence = sequence;
}

void OpenRoom::content_changed(const LayerState& layer, const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) {
  std::lock_guard lock(members_mutex_);
  for (RoomMember* member : members_) member->content_changed(layer.layer.id, box, sequence);
}

void OpenRoom::edit_applied(const Listener::Edit& edit) {
  sequence_ = edit.sequence;
  tell([&](Listener& l) { l.edit_applied(edit); });
}

void OpenRoom::edit_saved(const Listener::Edit& edit) { durable_ = edit.sequence; }

void OpenRoom::edits_unsaved(const std::vector<Listener::Edit>& edits, const Problem& why) {
  sequence_ = pipeline_->sequence();
  tell([&](Listener& l) { l.edits_unsaved(edits, why); });
}

// ------------------------------------------------------------------------------------------------------ people

std::unique_ptr<Member> OpenRoom::join(std::string user, Listener* listener, stream::Viewer::Send send) {
  std::unique_ptr<RoomMember> member;
  {
    std::lock_guard lock(members_mutex_);
    member = std::make_unique<RoomMember>(shared_from_this(), std::move(user), kColors[joined_++ % kColors.size()], listener,
                                          std::move(send));
    members_.push_back(member.get());
  }
  touch();
  announce_presence();
  return member;
}

void OpenRoom::leave(RoomMember* member) {
  {
    std::lock_guard lock(members_mutex_);
    std::erase(members_, member);
  }
  touch();
  announce_presence();
}

void OpenRoom::announce_presence() {
  boost::asio::post(strand_, [self = shared_from_this()] { self->tell([](Listener& l) { l.presence_changed(); }); });
}

std::vector<Presence> OpenRoom::presence() const {
  std::lock_guard lock(members_mutex_);
  std::vector<Presence> people;
  for (const RoomMember* member : members_) people.push_back(member->presence());
  return people;
}

void OpenRoom::touch() {
  std::lock_guard lock(mutex_);
  last_used_ = std::chrono::steady_clock::now();
}

bool OpenRoom::deserted(std::chrono::steady_clock::time_point now) const {
  {
    std::lock_guard lock(members_mutex_);
    if (!members_.empty()) return false;
  }
  std::lock_guard lock(mutex_);
  return now - last_used_ > parts_.options.close_after;
}

bool OpenRoom::idle() {
  return on_strand([&] { return pipeline_->idle(); });
}

void OpenRoom::shut() {
  maps_->stop();
  on_strand([&] { pipeline_->close({503, "Model is closing", "The server is letting go of this model.", {}}); });
  parts_.renderer.remove_model(model_handle());
}

// ----------------------------------------------------------------------------------------------------- queries

std::shared_ptr<const mesh::SearchTree> OpenRoom::search_tree() {
  std::call_once(tree_once_, [&] { tree_ = std::make_shared<const mesh::SearchTree>(geometry_); });
  return tree_;
}

Result<std::vector<query::LayerView>> OpenRoom::layer_views(const std::vector<std::string>& refs) const {
  std::vector<query::LayerView> views;
  if (refs.empty()) {
    for (const auto& state : layer_states()) views.push_back({state.layer, state.mirror->snapshot()});
    return views;
  }
  for (const auto& ref : refs) {
    auto found = state(ref);
    if (!found) return tl::unexpected(found.error());
    views.push_back({found->layer, found->mirror->snapshot()});
  }
  return views;
}

Result<query::SurfacePoint> OpenRoom::position(const glm::dvec3& world, const std::vector<std::string>& layers) {
  touch();
  auto views = layer_views(layers);
  if (!views) return tl::unexpected(views.error());
  return query::nearest_point(*search_tree(), geometry_->origin, world, *views);
}

Result<std::vector<query::SurfacePoint>> OpenRoom::positions(const std::vector<glm::dvec3>& world,
                                                             const std::vector<std::string>& layers) {
  touch();
  auto views = layer_views(layers);
  if (!views) return tl::unexpected(views.error());
  const auto tree = search_tree();
  std::vector<query::SurfacePoint> points;
  points.reserve(world.size());
  for (const auto& point : world) points.push_back(query::nearest_point(*tree, geometry_->origin, point, *views));
  return points;
}

Result<query::SurfacePoint> OpenRoom::pick(const Camera& camera, double x, double y,
                                           const std::vector<std::string>& layers) {
  touch();
  auto views = layer_views(layers);
  if (!views) return tl::unexpected(views.error());
  return query::pick(*search_tree(), geometry_->origin, camera, x, y, *views);
}

Result<query::Statistics> OpenRoom::statistics(const std::string& layer) {
  touch();
  auto found = state(layer);
  if (!found) return tl::unexpected(found.error());
  auto map = maps_->wait(found->layer.resolution);
  if (!map) return tl::unexpected(map.error());
  return query::statistics({found->layer, found->mirror->snapshot()}, **map, geometry_->origin, model().metres());
}

Result<TileMirror::Snapshot> OpenRoom::tiles(const std::string& layer, std::optional<std::int64_t> at) {
  touch();
  auto found = state(layer);
  if (!found) return tl::unexpected(found.error());
  if (!at) return found->mirror->snapshot();
  if (*at > durable_)
    return fail(422, "Sequence not reached", "The newest durable edit of this model is " + std::to_string(durable_) + ".", "at");
  return parts_.store.load_tiles(found->layer, at);
}

}  // namespace strata::room
