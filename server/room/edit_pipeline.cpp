#include "room/edit_pipeline.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <limits>
#include <map>

#include "core/log.h"

namespace strata::room {
namespace {

constexpr int kStrokesInFlight = 8;   // keeps the GPU fed; more would only lengthen a rollback
constexpr int kKeyTileEvery = 64;     // revisions of a tile between two whole copies
constexpr std::size_t kUndoableTilesAtOnce = 256;  // history is loaded in groups to bound memory

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

const char* op_name(const EditRequest& request) {
  return std::visit(Overloaded{[](const StrokeEdit&) { return "stroke"; }, [](const FillEdit&) { return "fill"; },
                               [](const ImportEdit&) { return "import"; }, [](const UndoEdit&) { return "undo"; },
                               [](const RedoEdit&) { return "redo"; }, [](const RestoreEdit&) { return "restore"; }},
                    request.edit);
}

// Undo, redo and restore read the journal, so everything before them must be in it.
bool reads_journal(const EditRequest& request) {
  return std::holds_alternative<UndoEdit>(request.edit) || std::holds_alternative<RedoEdit>(request.edit) ||
         std::holds_alternative<RestoreEdit>(request.edit);
}

// The part of the surface that changed tiles lie on.
std::optional<render::FrameRequest::Box> box_of(const std::vector<TileChange>& changes, const mesh::SurfaceMap& map) {
  render::FrameRequest::Box box{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
  const int tiles_per_side = map.resolution / kTileSize;
  for (const TileChange& change : changes) {
    const auto& bounds = map.bounds_128[std::size_t(change.address.y) * tiles_per_side + change.address.x];
    if (bounds.radius < 0) continue;
    box.min = glm::min(box.min, bounds.center - bounds.radius);
    box.max = glm::max(box.max, bounds.center + bounds.radius);
  }
  if (box.min.x > box.max.x) return std::nullopt;
  return box;
}

}  // namespace

EditPipeline::EditPipeline(Parts parts, PipelineHost& host, std::int64_t last_sequence)
    : parts_(std::move(parts)), host_(&host), sequence_(last_sequence), durable_(last_sequence) {}

void EditPipeline::edit(EditRequest request, Room::Applied applied, Room::Saved saved) {
  auto no = [&](int status, const char* title, const char* detail) {
    saved(fail(status, title, detail));
  };
  if (closed_) return no(503, "Model is closing", "The server is letting go of this model; try again in a moment.");
  if (repeat(request, applied, saved)) return;
  if (!parts_.writer.accepting())
    return no(503, "Not saved", "The database does not take edits at the moment. Viewing goes on; try again shortly.");
  if (waiting_.size() >= parts_.max_waiting)
    return no(429, "Too many edits", "This model has as many waiting edits as it may; send more slowly.");
  if (verify_) {
    auto last = parts_.store.last_sequence(host_->pipeline_model().id);
    if (!last) return saved(tl::unexpected(last.error()));
    verify_ = false;
    // A commit whose answer was lost may have happened after all: the journal is right, the room is not.
    if (*last != durable_) {
      host_->reload_from_store();
      return no(503, "Model is reloading", "The model is being read anew from the database; send the edit again.");
    }
  }
  running_[request.id];
  waiting_.push_back({std::move(request), std::move(applied), std::move(saved), {}});
  step();
}

bool EditPipeline::repeat(const EditRequest& request, const Room::Applied& applied, Room::Saved& saved) {
  if (auto found = running_.find(request.id); found != running_.end()) {
    found->second.push_back(std::move(saved));
    return true;
  }
  auto row = parts_.store.find_edit(host_->pipeline_model().id, request.id);
  if (!row) {
    saved(tl::unexpected(row.error()));
    return true;
  }
  if (!*row) return false;
  const auto& answer_json = (*row)->answer;
  const EditAnswer answer{(*row)->sequence, answer_json.value("texels_changed", std::uint64_t{0}),
                          answer_json.value("area_m2", 0.0), true};
  if (applied) applied(answer);
  saved(answer);
  return true;
}

void EditPipeline::when_idle(std::function<void()> work) {
  waiting_.push_back({{}, {}, {}, std::move(work)});
  step();
}

void EditPipeline::step() {
  while (!waiting_.empty() && !paused_ && !busy_ && !failure_ && !closed_ && !waits_for_map_) {
    Waiting& front = waiting_.front();
    auto take = [&] {
      Waiting item = std::move(front);
      waiting_.pop_front();
      return item;
    };
    if (front.work) {
      if (in_flight_ > 0 || !pending_.empty()) return;
      busy_ = true;
      boost::asio::post(parts_.workers, [self = shared_from_this(), work = take().work] {
        work();
        boost::asio::post(self->parts_.strand, [self] {
          self->busy_ = false;
          self->step();
        });
      });
      return;
    }
    const LayerState* layer = host_->find_layer(front.request.layer_id);
    if (!layer) {
      Waiting item = take();
      refuse(item, {404, "No such layer", "The layer was deleted.", "layer"});
      continue;
    }
    if (!map_ready(layer->layer.resolution)) return;
    if (std::holds_alternative<StrokeEdit>(front.request.edit)) {
      if (in_flight_ >= kStrokesInFlight) return;
      start_stroke(take(), *layer);
    } else {
      if (in_flight_ > 0 || (reads_journal(front.request) && !pending_.empty())) return;
      start_computed(take(), *layer);
    }
  }
}

bool EditPipeline::map_ready(int resolution) {
  if (parts_.maps->get(resolution)) return true;
  waits_for_map_ = true;
  parts_.maps->request(resolution, [self = shared_from_this()](Result<SurfaceMaps::MapPtr> map) {
    boost::asio::post(self->parts_.strand, [self, map = std::move(map)] {
      self->waits_for_map_ = false;
      if (!map && !self->waiting_.empty() && !self->waiting_.front().work) {
        Waiting item = std::move(self->waiting_.front());
        self->waiting_.pop_front();
        self->refuse(item, map.error());
      }
      self->step();
    });
  });
  return false;
}

void EditPipeline::start_stroke(Waiting taken, const LayerState& layer) {
  ++in_flight_;
  auto item = std::make_shared<Waiting>(std::move(taken));
  parts_.renderer.paint(layer.handle, std::get<StrokeEdit>(item->request.edit).batch,
                        [self = shared_from_this(), item](Result<render::StrokeOutcome> outcome) {
                          boost::asio::post(self->parts_.strand, [self, item, outcome = std::move(outcome)]() mutable {
                            --self->in_flight_;
                            self->stroke_done(*item, std::move(outcome));
                            self->roll_back_when_answered();
                            self->step();
                          });
                        });
}

void EditPipeline::stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome) {
  if (!outcome) return refuse(item, outcome.error());
  LayerState* layer = closed_ ? nullptr : host_->find_layer(item.request.layer_id);
  if (!layer) return refuse(item, {404, "No such layer", "The layer was deleted.", "layer"});
  Computed computed;
  for (auto& tile : outcome->tiles) {
    auto before = layer->mirror->tile(tile.address);
    if (!before) before = std::make_shared<const TileData>(layer->layer.type);
    computed.changes.push_back(
        {tile.address, std::move(before), std::make_shared<const TileData>(std::move(tile.after)), tile.written});
  }
  std::optional<render::FrameRequest::Box> box;
  if (!computed.changes.empty()) box = render::FrameRequest::Box{outcome->written_min, outcome->written_max};
  commit(item, *layer, std::move(computed), box);
}

void EditPipeline::start_computed(Waiting item, const LayerState& layer) {
  busy_ = true;
  boost::asio::post(parts_.workers, [self = shared_from_this(), item = std::make_shared<Waiting>(std::move(item)),
                                     meta = layer.layer, tiles = layer.mirror->snapshot().tiles]() mutable {
    auto computed = self->compute(item->request, meta, tiles);
    boost::asio::post(self->parts_.strand, [self, item, computed = std::move(computed)]() mutable {
      self->busy_ = false;
      self->computed_done(*item, std::move(computed));
      self->roll_back_when_answered();
      self->step();
    });
  });
}

Result<EditPipeline::Computed> EditPipeline::compute(const EditRequest& request, const Layer& layer,
                                                     const TileMap& tiles) const {
  const auto map = parts_.maps->get(layer.resolution);
  if (!map) return fail(503, "GPU lost", "The graphics context is being restored; send the edit again.");
  return std::visit(
      Overloaded{
          [&](const FillEdit& fill) -> Result<Computed> {
            return Computed{fill_everywhere(tiles, layer.type, *map, fill.erase, fill.value_bits), {}, {}};
          },
          [&](const ImportEdit& import) -> Result<Computed> {
            return Computed{replace_content(tiles, import.tiles, layer.type, *map), {}, {}};
          },
          [&](const RestoreEdit& restore) -> Result<Computed> {
            auto past = parts_.store.load_tiles(layer, restore.sequence);
            if (!past) return tl::unexpected(past.error());
            return Computed{replace_content(tiles, past->tiles, layer.type, *map), {}, {}};
          },
          [&](const UndoEdit&) { return compute_undo(request, layer, tiles, false); },
          [&](const RedoEdit&) { return compute_undo(request, layer, tiles, true); },
          [&](const StrokeEdit&) -> Result<Computed> { return fail(500, "Internal error", "A stroke is painted, not computed."); },
      },
      request.edit);
}

Result<EditPipeline::Computed> EditPipeline::compute_undo(const EditRequest& request, const Layer& layer,
                                                          const TileMap& tiles, bool redo) const {
  auto sequences = redo ? parts_.store.redoable(layer.id, request.user) : parts_.store.undoable(layer.id, request.user);
  if (!sequences) return tl::unexpected(sequences.error());
  if (sequences->empty())
    return redo ? fail(409, "Nothing to redo", "You have no undone stroke on this layer that could come back.")
                : fail(409, "Nothing to undo", "You have no stroke in force on this layer.");
  auto written = parts_.store.written_by(layer, *sequences);
  if (!written) return tl::unexpected(written.error());

  Computed computed;
  (redo ? computed.enable : computed.disable) = *sequences;
  for (std::size_t first = 0; first < written->size(); first += kUndoableTilesAtOnce) {
    const std::size_t last = std::min(written->size(), first + kUndoableTilesAtOnce);
    std::vector<TileAddress> addresses;
    std::unordered_map<TileAddress, const TileMask*> masks;
    for (std::size_t i = first; i < last; ++i) {
      addresses.push_back((*written)[i].tile);
      masks[(*written)[i].tile] = &(*written)[i].written;
    }
    auto histories = parts_.store.load_history(layer, addresses);
    if (!histories) return tl::unexpected(histories.error());
    for (auto& history : *histories) {
      for (auto& entry : history.newest_first)
        if (std::find(sequences->begin(), sequences->end(), entry.sequence) != sequences->end()) entry.in_force = redo;
      computed.changes.push_back(
          resolve_change(tiles, history.tile, layer.type, history.newest_first, *masks.at(history.tile)));
    }
  }
  return computed;
}

void EditPipeline::computed_done(Waiting& item, Result<Computed> computed) {
  if (!computed) return refuse(item, computed.error());
  LayerState* layer = closed_ ? nullptr : host_->find_layer(item.request.layer_id);
  if (!layer) return refuse(item, {404, "No such layer", "The layer was deleted.", "layer"});
  const auto map = parts_.maps->get(layer->layer.resolution);
  if (!map) return refuse(item, {503, "GPU lost", "The graphics context is being restored; send the edit again.", {}});
  std::vector<render::TileUpload> uploads;
  for (const auto& change : computed->changes) uploads.push_back({change.address, change.after});
  // A failed upload means a lost context, and then every layer is put on the GPU again from its mirror.
  parts_.renderer.write_tiles(layer->handle, std::move(uploads), [](Result<void>) {});
  const auto box = box_of(computed->changes, *map);
  commit(item, *layer, std::move(*computed), box);
}

void EditPipeline::commit(Waiting& item, LayerState& layer, Computed computed,
                          const std::optional<render::FrameRequest::Box>& box) {
  const auto map = parts_.maps->get(layer.layer.resolution);
  const Model& model = host_->pipeline_model();
  const std::int64_t sequence = ++sequence_;

  store::JournalEntry entry;
  EditAnswer answer{sequence, 0, 0, false};
  TileMap tiles;
  auto& since_key_tile = since_key_tile_[layer.layer.id];
  for (const TileChange& change : computed.changes) {
    if (map) {
      const ChangeCount count = count_changes(change, *map);
      answer.texels_changed += count.texels;
      answer.area_m2 += count.area * model.metres() * model.metres();
    }
    tiles[change.address] = change.after;
    store::JournalEntry::Revision revision{
        change.address, encode_revision(make_revision(change.address, *change.before, *change.after, change.written)), {}};
    // The first revision in this room is stored whole: chains stay short however often rooms open and close.
    auto [since, first] = since_key_tile.try_emplace(change.address, 0);
    if (first || ++since->second >= kKeyTileEvery) {
      revision.key_tile = encode_tile(*change.after);
      since->second = 0;
    }
    entry.revisions.push_back(std::move(revision));
  }
  layer.mirror->put(tiles, sequence);
  host_->set_sequence(layer, sequence);

  const auto* stroke = std::get_if<StrokeEdit>(&item.request.edit);
  entry.model_id = model.id;
  entry.layer_id = layer.layer.id;
  entry.sequence = sequence;
  entry.id = item.request.id;
  entry.user = item.request.user;
  entry.stroke = stroke ? stroke->stroke : item.request.id;
  entry.op = op_name(item.request);
  entry.record = std::move(item.request.record);
  entry.answer = to_json(answer);
  entry.time = std::chrono::system_clock::now();
  entry.disable = std::move(computed.disable);
  entry.enable = std::move(computed.enable);

  const Listener::Edit event{layer.layer.id, layer.layer.slug, sequence,           entry.id,      entry.stroke,
                             stroke ? stroke->n : 0, stroke != nullptr, item.request.user, entry.op, answer};
  if (!tiles.empty()) host_->content_changed(layer, box, sequence);
  host_->edit_applied(event);
  if (item.applied) item.applied(answer);

  pending_.push_back({event, std::move(computed.changes), std::move(item.saved), false});
  if (failure_) {
    pending_.back().answered = true;
    return;
  }
  const bool taken = parts_.writer.submit(std::move(entry), [self = shared_from_this(), sequence](Result<void> result) {
    boost::asio::post(self->parts_.strand, [self, sequence, result = std::move(result)] {
      self->on_saved(sequence, result);
      self->roll_back_when_answered();
      self->step();
    });
  });
  if (!taken) {
    failure_ = Problem{503, "Not saved", "The database does not keep up with the edits; they were taken back.", {}};
    pending_.back().answered = true;
  }
}

void EditPipeline::on_saved(std::int64_t sequence, const Result<void>& result) {
  auto found = std::find_if(pending_.begin(), pending_.end(),
                            [&](const Pending& pending) { return pending.event.sequence == sequence; });
  if (found == pending_.end()) return;
  if (!result) {
    found->answered = true;
    if (!failure_) failure_ = result.error();
    return;
  }
  Pending pending = std::move(*found);
  pending_.erase(found);
  durable_ = sequence;
  if (host_) host_->edit_saved(pending.event);
  answer(pending.event.id, pending.saved, pending.event.answer);
}

void EditPipeline::roll_back_when_answered() {
  if (!failure_ || in_flight_ > 0 || busy_) return;
  for (const Pending& pending : pending_)
    if (!pending.answered) return;

  const Problem why = *failure_;
  failure_.reset();
  verify_ = true;
  sequence_ = durable_;
  std::map<std::int64_t, TileMap> before;  // by layer: what the tiles were before the oldest pending edit
  std::vector<Listener::Edit> events;
  for (auto pending = pending_.rbegin(); pending != pending_.rend(); ++pending)
    for (const auto& change : pending->changes) before[pending->event.layer_id][change.address] = change.before;
  for (const auto& pending : pending_) events.push_back(pending.event);
  std::deque<Pending> taken_back = std::move(pending_);
  pending_.clear();

  for (auto& [layer_id, tiles] : before) {
    LayerState* layer = host_ ? host_->find_layer(layer_id) : nullptr;
    if (!layer) continue;
    std::vector<render::TileUpload> uploads;
    for (const auto& [address, data] : tiles) uploads.push_back({address, data});
    parts_.renderer.write_tiles(layer->handle, std::move(uploads), [](Result<void>) {});
    layer->mirror->put(tiles, durable_);
    host_->set_sequence(*layer, std::min(layer->layer.sequence, durable_));
    since_key_tile_.erase(layer_id);  // the whole copies may be among what was not saved
    host_->content_changed(*layer, std::nullopt, durable_);
  }
  log::warning("took back " + std::to_string(events.size()) + " edits that could not be saved: " + why.title + ": " + why.detail);
  if (host_) host_->edits_unsaved(events, why);
  for (auto& pending : taken_back) answer(pending.event.id, pending.saved, tl::unexpected(why));
}

void EditPipeline::refuse(Waiting& item, const Problem& why) { answer(item.request.id, item.saved, tl::unexpected(why)); }

void EditPipeline::answer(const Uuid& id, const Room::Saved& saved, const Result<EditAnswer>& result) {
  std::vector<Room::Saved> followers;
  if (auto found = running_.find(id); found != running_.end()) {
    followers = std::move(found->second);
    running_.erase(found);
  }
  if (saved) saved(result);
  for (auto& follower : followers) {
    Result<EditAnswer> repeated = result;
    if (repeated) repeated->repeated = true;
    follower(repeated);
  }
}

void EditPipeline::pause() { paused_ = true; }

void EditPipeline::resume(std::int64_t last_sequence) {
  paused_ = false;
  since_key_tile_.clear();
  sequence_ = last_sequence;
  if (pending_.empty()) durable_ = last_sequence;
  step();
}

void EditPipeline::close(const Problem& why) {
  closed_ = true;
  host_ = nullptr;
  std::deque<Waiting> left = std::move(waiting_);
  waiting_.clear();
  for (auto& item : left)
    if (!item.work) refuse(item, why);
}

}  // namespace strata::room
