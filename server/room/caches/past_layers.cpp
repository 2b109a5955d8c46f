#include "room/caches/past_layers.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "room/open/contents.h"
#include "room/pipeline/gpu_problem.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

std::uint64_t tile_bytes(const TileData& tile) { return sizeof(TileData) + tile.values.size(); }

// Returns the size in bytes of the tiles that are in `snapshot` but not in `newest`.
std::uint64_t own_bytes(const TileMirror::Snapshot& snapshot,
                        const std::optional<TileMirror::Snapshot>& newest) {
  std::uint64_t bytes = 0;
  for (const auto& [address, tile] : snapshot.tiles) {
    if (newest)
      if (const auto same = newest->tiles.find(address);
          same != newest->tiles.end() && same->second == tile)
        continue;
    bytes += tile_bytes(*tile);
  }
  return bytes;
}

bool serves(const PastMoment& moment, const PastLayers::Request& request,
            render::ModelHandle model) {
  return moment.model == model && moment.sequence == request.at &&
         std::ranges::all_of(request.layers, [&](const Layer& layer) {
           return moment.layers.contains(layer.id) &&
                  (!layer.table || moment.features.contains(*layer.table));
         });
}

}  // namespace

PastLayer::~PastLayer() {
  if (handle) renderer.remove_layer(handle);
}

class PastLayers::Place {
 public:
  Request wanted;  // all members are protected by the mutex of PastLayers
  Found found;
  // The last request that failed. It is not tried again until `allow_retries`.
  std::optional<std::tuple<std::int64_t, render::ModelHandle, int>> failed;
  bool running = false;
};

PastLayers::PastLayers(store::Store& store, render::Renderer& renderer,
                       boost::asio::thread_pool& workers, MemoryLedger& memory,
                       std::shared_ptr<RecordFeatures> features, ModelId model_id, Newest newest,
                       std::function<void()> ready)
    : store_(store),
      renderer_(renderer),
      workers_(workers),
      memory_(memory),
      features_(std::move(features)),
      model_id_(model_id),
      newest_(std::move(newest)),
      ready_(std::move(ready)) {}

PastLayers::~PastLayers() = default;

std::shared_ptr<PastLayers::Place> PastLayers::new_place() { return std::make_shared<Place>(); }

PastLayers::Found PastLayers::find(const std::shared_ptr<Place>& place, const Request& request) {
  std::lock_guard lock(mutex_);
  place->wanted = request;
  if (place->found.moment && place->found.moment->model != model_) place->found.moment = nullptr;
  if (place->found.moment && serves(*place->found.moment, request, model_)) {
    place->found.problem = nullptr;
    return place->found;
  }
  if (!place->running && !stopped_ && place->failed != std::tuple(request.at, model_, retries_)) {
    place->running = true;
    boost::asio::post(workers_, [self = shared_from_this(), place] { self->run(place); });
  }
  return place->found;
}

void PastLayers::run(const std::shared_ptr<Place>& place) {
  for (;;) {
    Request request;
    render::ModelHandle model = 0;
    int retries = 0;
    {
      std::lock_guard lock(mutex_);
      request = place->wanted;
      model = model_;
      retries = retries_;
    }
    auto made = make(request, model);
    bool is_current = false;
    {
      std::lock_guard lock(mutex_);
      is_current = place->wanted.at == request.at;
      if (stopped_) {
        place->running = false;
        return;
      }
      if (model != model_) continue;  // the context was lost
      if (made) {
        place->found = {std::move(*made), nullptr};
        place->failed.reset();
        is_current = serves(*place->found.moment, place->wanted, model_);
      } else if (is_current) {
        place->found.problem = std::make_shared<const Error>(made.error());
        place->failed = {request.at, model, retries};
      }
      if (is_current) place->running = false;
    }
    if (ready_) ready_();
    if (is_current) return;
  }
}

Result<std::shared_ptr<const PastMoment>> PastLayers::make(const Request& request,
                                                           render::ModelHandle model) {
  auto moment = std::make_shared<PastMoment>();
  moment->sequence = request.at;
  moment->model = model;
  const auto sequences = STRATA_TRY(store_.journal().layer_sequences(model_id_, request.at));
  for (const Layer& layer : request.layers) {
    // A layer that did not exist at that time is empty.
    const auto last = sequences.find(layer.id);
    auto content = STRATA_TRY(layer_at(layer, last == sequences.end() ? 0 : last->second, model));
    moment->layers.emplace(layer.id, std::move(content));
    if (!layer.table || moment->features.contains(*layer.table)) continue;
    auto features = STRATA_TRY(features_->when(*layer.table, request.sight, request.at));
    moment->features.emplace(*layer.table, std::move(features));
  }
  return moment;
}

Result<std::shared_ptr<const PastLayer>> PastLayers::layer_at(const Layer& layer,
                                                              std::int64_t sequence,
                                                              render::ModelHandle model) {
  const Key key{layer.id, layer.type, sequence};
  const auto newest = newest_(layer);
  std::optional<TileMirror::Snapshot> near = newest;
  {
    std::lock_guard lock(mutex_);
    const auto known =
        std::ranges::find_if(kept_, [&](const Kept& kept) { return kept.key == key; });
    if (known != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, known);
      return known->layer;
    }
    const auto distance = [&](std::int64_t other) {
      return other < sequence ? sequence - other : other - sequence;
    };
    for (const Kept& kept : kept_) {
      const auto& [id, type, last] = kept.key;
      if (id == layer.id && type == layer.type &&
          (!near || distance(last) < distance(near->sequence)))
        near = kept.layer->snapshot;
    }
  }
  auto snapshot = STRATA_TRY(near ? store_.journal().load_tiles_near(layer, sequence, *near)
                                  : store_.journal().load_tiles(layer, sequence));
  auto share =
      STRATA_TRY(memory_.reserve(own_bytes(snapshot, newest), "an earlier state of a layer"));
  auto mirror = std::make_shared<TileMirror>(layer.type, layer.resolution);
  mirror->assign(snapshot.tiles, snapshot.sequence);
  auto past = std::make_shared<PastLayer>(renderer_, std::move(snapshot));
  past->memory = std::move(share);
  auto handle = add_layer(renderer_, model, std::move(mirror));
  if (!handle) return tl::unexpected(gpu_problem(handle.error()));
  past->handle = *handle;
  std::lock_guard lock(mutex_);
  if (model == model_ && !stopped_) keep({key, past});
  return past;
}

void PastLayers::keep(Kept kept) {
  kept_.push_front(std::move(kept));
  std::size_t count = 0;
  std::uint64_t bytes = 0;
  for (auto each = kept_.begin(); each != kept_.end();) {
    bytes += each->layer->memory.bytes();
    const bool stays = ++count <= kKeptLayers && (count == 1 || bytes <= kKeptBytes);
    each = stays ? std::next(each) : kept_.erase(each);
  }
}

void PastLayers::set_model(render::ModelHandle model) {
  std::list<Kept> gone;  // destroyed after the mutex is released
  std::lock_guard lock(mutex_);
  model_ = model;
  gone.swap(kept_);
}

void PastLayers::allow_retries() {
  std::lock_guard lock(mutex_);
  ++retries_;
}

bool PastLayers::drop_unused() {
  std::list<Kept> gone;
  std::lock_guard lock(mutex_);
  for (auto each = kept_.begin(); each != kept_.end();) {
    const auto next = std::next(each);
    if (each->layer.use_count() == 1) gone.splice(gone.end(), kept_, each);
    each = next;
  }
  return !gone.empty();
}

void PastLayers::stop() {
  std::list<Kept> gone;
  std::lock_guard lock(mutex_);
  stopped_ = true;
  gone.swap(kept_);
}

}  // namespace strata::room
