#include "room/pipeline/edit_pipeline.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <limits>
#include <map>
#include <new>

#include "core/log.h"
#include "core/overloaded.h"
#include "room/pipeline/gpu_problem.h"
#include "room/pipeline/provisional.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// Keeps the GPU busy. A larger number would only make rollbacks longer.
constexpr int kStrokesInFlight = 8;
constexpr int kKeyTileEvery = 64;  // revisions of a tile between two key tiles
constexpr auto kRepairPause = std::chrono::milliseconds(500);
constexpr auto kComparePause = std::chrono::seconds(1);

const char* op_name(const EditRequest& request) {
  return std::visit(
      Overloaded{
          [](const StrokeEdit&) { return "stroke"; }, [](const FillEdit&) { return "fill"; },
          [](const PolygonEdit&) { return "polygon"; }, [](const ImportEdit&) { return "import"; },
          [](const ComputeEdit&) { return "compute"; }, [](const PatchEdit&) { return "cleanup"; },
          [](const UndoEdit&) { return "undo"; }, [](const RedoEdit&) { return "redo"; },
          [](const RestoreEdit&) { return "restore"; },
          [](const ReviewEdit& review) { return name(review.decision).data(); }},
      request.edit);
}

// Undo, redo, reviews and restore read the journal, so the journal must contain every earlier edit.
bool reads_journal(const EditRequest& request) {
  return !paints(request) || std::holds_alternative<RestoreEdit>(request.edit);
}

// Returns whether the content also depends on other layers.
bool reads_layers(const EditRequest& request) {
  if (std::holds_alternative<ComputeEdit>(request.edit)) return true;
  const auto* fill = std::get_if<FillEdit>(&request.edit);
  return fill && std::holds_alternative<FillEdit::Where>(fill->region);
}

TileAddress address_of(const TileChange& change) { return change.address; }
TileAddress address_of(TileAddress tile) { return tile; }

// Returns the bounding box of the surface in the changed tiles.
template <class Tiles>
std::optional<render::FrameRequest::Box> box_of(
    const Tiles& changes, const std::vector<mesh::BoundingSphere>& bounds_of_tile, int resolution) {
  render::FrameRequest::Box box{glm::vec3(std::numeric_limits<float>::max()),
                                glm::vec3(std::numeric_limits<float>::lowest())};
  const int tiles_per_side = resolution / kTileSize;
  for (const auto& change : changes) {
    const TileAddress tile = address_of(change);
    const auto& bounds = bounds_of_tile[std::size_t(tile.y) * tiles_per_side + tile.x];
    if (bounds.radius < 0) continue;
    box.min = glm::min(box.min, bounds.center - bounds.radius);
    box.max = glm::max(box.max, bounds.center + bounds.radius);
  }
  if (box.min.x > box.max.x) return std::nullopt;
  return box;
}

// The error for an id that belongs to an edit of another user. Only the author of an edit may get
// its result.
Error taken_id() {
  return {ErrorCode::invalid, "Edit id already used",
          "Another edit of this model has this id. Use a new id for each edit.", "id"};
}

// Only computations write a layer with an expression, until the layer is unlocked for editing by
// hand. After that, computations do not overwrite painted texels.
Result<void> check_formula(const Layer& layer, const EditRequest& request) {
  const auto* compute = std::get_if<ComputeEdit>(&request.edit);
  if (compute && !layer.formula)
    return fail(ErrorCode::conflict, "No expression",
                "This layer has no expression, so the server cannot compute it. Set an "
                "expression first.",
                "layer");
  if (compute && layer.edited_by_hand && !compute->overwrites)
    return fail(ErrorCode::conflict, "Edited by hand",
                "Somebody edited this layer by hand. To overwrite these edits, send "
                "overwrite=true.",
                "layer");
  if (!compute && layer.formula && !layer.edited_by_hand)
    return fail(ErrorCode::conflict, "Layer is computed",
                "The server computes the values of this layer from its expression. Unlock the "
                "layer to edit it by hand.",
                "layer");
  return {};
}

}  // namespace

EditPipeline::EditPipeline(Parts parts, PipelineHost& host, std::int64_t last_sequence)
    : parts_(std::move(parts)),
      host_(&host),
      sequence_(last_sequence),
      durable_(last_sequence),
      repair_timer_(parts_.strand),
      compare_timer_(parts_.strand) {}

template <class Handler>
auto EditPipeline::then(Handler handler) {
  return [self = shared_from_this(), handler = std::move(handler)](auto value) mutable {
    boost::asio::post(self->parts_.strand,
                      [self, handler = std::move(handler), value = std::move(value)]() mutable {
                        handler(std::move(value));
                        self->step();
                      });
  };
}

void EditPipeline::edit(EditRequest request, Applied applied, Saved saved) {
  if (closed_) return saved(tl::unexpected(*closed_));
  if (not_saving_) return saved(tl::unexpected(*not_saving_));
  if (auto found = running_.find(request.id); found != running_.end()) {
    if (found->second.user != request.author.user) return saved(tl::unexpected(taken_id()));
    return found->second.followers.push_back(std::move(saved));
  }
  if (!parts_.writer.accepting())
    return saved(fail(ErrorCode::unavailable, "Not saved",
                      "The database does not accept edits at the moment. You can still view the "
                      "model. Try again shortly."));
  if (parts_.memory.exceeded())
    return saved(tl::unexpected(parts_.memory.used_up(0, "the data of an edit")));
  running_[request.id].user = request.author.user;
  EditTrace trace{request.trace ? request.trace : random_trace_id()};
  waiting_.push_back({.request = std::move(request),
                      .applied = std::move(applied),
                      .saved = std::move(saved),
                      .work = {},
                      .trace = trace});
  step();
}

void EditPipeline::when_idle(Work work) {
  if (closed_) return work(tl::unexpected(*closed_));
  if (not_saving_) return work(tl::unexpected(*not_saving_));
  waiting_.push_back(
      {.request = {{}, {{}, Role::viewer}}, .applied = {}, .saved = {}, .work = std::move(work)});
  step();
}

// --- look-up in the journal

// Runs one look-up at a time in the journal, for all edits that have arrived. If `verify_` is set,
// the room also compares the end of the journal with the sequence that it expects. If the last
// look-up failed, a comparison starts only when an edit waits for it.
void EditPipeline::ask_journal() {
  if (asking_ || not_saving_) return;
  const bool settled = in_flight_ == 0 && !busy_ && !paused_ && pending_.empty();
  const bool verifying = verify_ && settled && !(journal_away_ && waiting_.empty());
  if (verify_ && !verifying) return;
  std::vector<Uuid> ids;
  for (Waiting& item : waiting_) {
    if (item.work || item.lookup != Waiting::Lookup::none) continue;
    item.lookup = Waiting::Lookup::requested;
    ids.push_back(item.request.id);
  }
  if (ids.empty() && !verifying) return;
  asking_ = true;
  using State = Result<store::JournalState>;
  boost::asio::post(parts_.readers, [&store = parts_.store, model_id = host_->pipeline_model().id,
                                     ids = std::move(ids), was_away = journal_away_,
                                     done = then([this, verifying](const State& state) {
                                       on_journal(verifying, state);
                                     })]() mutable {
    // The pool waits for a database that restarts. One wait is enough, so later callers get the
    // error immediately.
    if (was_away && !store.ready())
      return done(
          State(fail(ErrorCode::unavailable, "Database unavailable",
                     "The database does not answer, so the server cannot save anything. You can "
                     "still view the model. Try again shortly.")));
    done(store.journal().state(model_id, ids));
  });
}

void EditPipeline::on_journal(bool verifying, const Result<store::JournalState>& state) {
  asking_ = false;
  if (closed_ || std::exchange(lookup_outdated_, false)) return;
  journal_away_ = !state;
  // While the room was suspended, any node could delete the model, and this room did not notice.
  if (!state && compares_ && state.error().code == ErrorCode::not_found)
    return host_->deposed(state.error());
  if (!state) {
    // Refuses all edits that wait for the journal, not only those in the look-up, because the edits
    // of one stroke must stay in order.
    std::deque<Waiting> all = std::exchange(waiting_, {});
    for (Waiting& item : all) {
      if (!verify_ && (item.work || item.lookup == Waiting::Lookup::is_new))
        waiting_.push_back(std::move(item));
      else
        refuse(item, state.error());
    }
    if (compares_) compare_later();
    return;
  }
  if (state->epoch != parts_.epoch) return host_->deposed(moved_to({}));
  // A commit may have succeeded although its confirmation was lost. Then the journal is correct,
  // and the room lacks edits. Until the room contains everything in the journal, a repeated request
  // must not get the result that its edit is saved. So all ids are looked up in the journal again.
  // (If a look-up began before `verify_` was set, its result is not used.)
  if (verifying && state->last_sequence == durable_) verify_ = false;
  const auto is_beyond = [&](const store::JournalRow& row) { return row.sequence > durable_; };
  if (std::any_of(state->known.begin(), state->known.end(), is_beyond)) verify_ = true;
  if (!verify_) {
    report_compared();
    return on_known(state->known);
  }
  for (Waiting& item : waiting_)
    if (item.lookup == Waiting::Lookup::requested) item.lookup = Waiting::Lookup::none;
  if (verifying && state->last_sequence != durable_) host_->journal_differs();
}

void EditPipeline::on_known(const std::vector<store::JournalRow>& known) {
  std::deque<Waiting> all = std::exchange(waiting_, {});
  for (Waiting& item : all) {
    const auto row = item.lookup == Waiting::Lookup::requested
                         ? std::find_if(known.begin(), known.end(),
                                        [&](const auto& r) { return r.id == item.request.id; })
                         : known.end();
    if (row != known.end() && row->user != item.request.author.user) {
      refuse(item, taken_id());
      continue;
    }
    if (row != known.end()) {
      const EditAnswer first = idempotent_response(*row);
      if (item.applied) item.applied(first);
      answer(item.request.id, item.saved, first);
      continue;
    }
    if (item.lookup == Waiting::Lookup::requested) item.lookup = Waiting::Lookup::is_new;
    waiting_.push_back(std::move(item));
  }
}

// --- start of edits

void EditPipeline::step() {
  roll_back_when_answered();
  if (closed_) return;
  ask_journal();
  if (paused_) {
    if (in_flight_ == 0 && !busy_ && std::exchange(tell_paused_, false)) host_->paused();
    return;
  }
  if (busy_ || failure_) return;
  if (repair() || verify_ || not_saving_) return;
  while (!waiting_.empty() && !busy_ && !waits_for_map_)
    if (!start_front()) return;
}

bool EditPipeline::start_front() {
  Waiting& front = waiting_.front();
  const auto take = [&] {
    Waiting item = std::move(front);
    waiting_.pop_front();
    return item;
  };
  if (front.work) {
    if (in_flight_ > 0 || !pending_.empty()) return false;
    start_work(take().work);
    return true;
  }
  if (front.lookup != Waiting::Lookup::is_new) return false;
  const LayerState* layer = host_->find_layer(front.request.layer_id);
  // An author who no longer sees the layer gets the same error as for a deleted layer.
  if (!layer || !sees(front.request.author.role, layer->layer.visibility)) {
    Waiting item = take();
    refuse(item, {ErrorCode::not_found, "Layer not found", "The layer was deleted.", "layer"});
    return true;
  }
  if (auto may = check_not_locked(layer->layer, front.request.author.role, computes(front.request));
      !may) {
    Waiting item = take();
    refuse(item, may.error());
    return true;
  }
  if (auto may = check_formula(layer->layer, front.request); !may) {
    Waiting item = take();
    refuse(item, may.error());
    return true;
  }
  if (!map_ready(layer->layer.resolution)) return false;
  if (std::holds_alternative<StrokeEdit>(front.request.edit)) {
    if (in_flight_ >= kStrokesInFlight) return false;
    start_stroke(take(), *layer);
  } else {
    if (in_flight_ > 0 || (reads_journal(front.request) && !pending_.empty())) return false;
    start_computed(take(), *layer);
  }
  return true;
}

void EditPipeline::start_work(Work work) {
  busy_ = true;
  boost::asio::post(parts_.workers, [work = std::move(work),
                                     done = then([this](bool) { busy_ = false; })]() mutable {
    work({});
    done(true);
  });
}

bool EditPipeline::map_ready(int resolution) {
  if (parts_.maps->get(resolution)) return true;
  waits_for_map_ = true;
  parts_.maps->request(resolution, then([this](const Result<SurfaceMaps::MapPtr>& map) {
                         waits_for_map_ = false;
                         if (map || waiting_.empty() || waiting_.front().work) return;
                         Waiting item = std::move(waiting_.front());
                         waiting_.pop_front();
                         refuse(item, gpu_problem(map.error()));
                       }));
  return false;
}

void EditPipeline::start_stroke(Waiting taken, const LayerState& layer) {
  ++in_flight_;
  auto item = std::make_shared<Waiting>(std::move(taken));
  item->hold = layer.mirror->hold();
  item->trace.started = EditTrace::Clock::now();
  const TraceScope scope(item->trace.id);
  parts_.renderer.paint(layer.handles.content, std::get<StrokeEdit>(item->request.edit).batch,
                        then([this, item](Result<render::StrokeOutcome> outcome) {
                          --in_flight_;
                          stroke_done(*item, std::move(outcome));
                        }));
}

void EditPipeline::stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome) {
  const TraceScope scope(item.trace.id);
  if (!outcome) return refuse(item, gpu_problem(outcome.error()));
  if (closed_) return refuse(item, *closed_);
  LayerState* layer = host_->find_layer(item.request.layer_id);
  if (!layer)
    return refuse(item,
                  {ErrorCode::not_found, "Layer not found", "The layer was deleted.", "layer"});
  item.trace.paint_ms = outcome->edit_ms;
  ComputedEdit computed;
  for (const auto& tile : outcome->tiles) {
    auto before = layer->mirror->tile(tile.address);
    if (!before) before = std::make_shared<const TileData>(layer->layer.type);
    computed.changes.push_back(
        painted_change(tile.address, std::move(before), tile.written, tile.after));
  }
  std::optional<render::FrameRequest::Box> box;
  if (!computed.changes.empty())
    box = render::FrameRequest::Box{outcome->written_min, outcome->written_max};
  commit(item, *layer, std::move(computed), box);
}

void EditPipeline::start_computed(Waiting taken, const LayerState& layer) {
  busy_ = true;
  auto item = std::make_shared<Waiting>(std::move(taken));
  item->trace.started = EditTrace::Clock::now();
  auto done = then(
      [this, item](Result<ComputedEdit> computed) { upload_computed(item, std::move(computed)); });
  std::vector<query::LayerView> layers;
  if (reads_layers(item->request)) layers = host_->layer_snapshots();
  boost::asio::post(parts_.workers, [this, self = shared_from_this(), item, meta = layer.layer,
                                     tiles = layer.mirror->snapshot().tiles,
                                     layers = std::move(layers),
                                     metres = host_->pipeline_model().metres(),
                                     model = host_->model_handle(),
                                     done = std::move(done)]() mutable {
    const auto map = parts_.maps->get(meta.resolution);
    if (!map)
      return done(Result<ComputedEdit>(
          fail(ErrorCode::gpu_lost, "GPU lost",
               "The server lost the GPU context and is restoring it. Send the edit again.")));
    auto question = item->request.question;
    const Author& author = item->request.author;
    if (!question)
      question = std::make_shared<Question>(author.user, limits_of(author.role), nullptr);
    question->skip_turns();
    const Question::Scope scope(question);
    const TraceScope traced(item->trace.id);
    try {
      question->check();
      done(compute_edit(item->request, meta,
                        {*map, tiles, layers, metres, parts_.store, *parts_.surface,
                         parts_.renderer, model, meta.visibility, item->request.author.role}));
    } catch (const QuestionEnded& ended) {
      done(Result<ComputedEdit>(tl::unexpected(ended.problem())));
    } catch (const std::bad_alloc&) {
      done(Result<ComputedEdit>(fail(
          ErrorCode::out_of_memory, "Out of memory",
          "The server does not have enough memory for this edit at the moment. Try again later.")));
    }
  });
}

// The edit is applied only after the upload, because the next stroke is painted over the content of
// the mirror.
void EditPipeline::upload_computed(const std::shared_ptr<Waiting>& item,
                                   Result<ComputedEdit> computed) {
  busy_ = false;
  const TraceScope scope(item->trace.id);
  item->trace.computed = EditTrace::Clock::now();
  if (!computed) return refuse(*item, computed.error());
  if (closed_) return refuse(*item, *closed_);
  LayerState* layer = host_->find_layer(item->request.layer_id);
  if (!layer)
    return refuse(*item,
                  {ErrorCode::not_found, "Layer not found", "The layer was deleted.", "layer"});
  std::vector<render::TileUpload> uploads;
  for (const auto& change : computed->changes)
    if (change.after != change.before) uploads.push_back({change.address, change.after});
  busy_ = true;
  item->hold = layer->mirror->hold();
  parts_.renderer.write_tiles(
      layer->handles.content, std::move(uploads),
      then([this, item, computed = std::move(*computed)](const Result<void>& uploaded) mutable {
        busy_ = false;
        computed_uploaded(*item, std::move(computed), uploaded);
      }));
}

void EditPipeline::computed_uploaded(Waiting& item, ComputedEdit computed,
                                     const Result<void>& uploaded) {
  const TraceScope scope(item.trace.id);
  if (closed_) return refuse(item, *closed_);
  LayerState* layer = host_->find_layer(item.request.layer_id);
  if (!layer)
    return refuse(item,
                  {ErrorCode::not_found, "Layer not found", "The layer was deleted.", "layer"});
  if (!uploaded) {
    for (const auto& change : computed.changes) stale_[layer->layer.id].insert(change.address);
    return refuse(item, gpu_problem(uploaded.error()));
  }
  const auto map = parts_.maps->get(layer->layer.resolution);
  const auto box =
      map ? box_of(computed.changes, map->bounds_of_tile, map->resolution) : std::nullopt;
  commit(item, *layer, std::move(computed), box);
}

// --- saving and rollback

void EditPipeline::commit(Waiting& item, LayerState& layer, ComputedEdit computed,
                          const std::optional<render::FrameRequest::Box>& box) {
  const auto map = parts_.maps->get(layer.layer.resolution);
  const Model& model = host_->pipeline_model();
  const std::int64_t sequence = ++sequence_;
  item.trace.painted = EditTrace::Clock::now();

  const bool is_provisional = waits_for_review(layer.layer, item.request);
  TileMap tiles, provisional_before, provisional;
  for (TileChange& change : computed.changes) {
    if (is_provisional) change.provisional = change.written;
    if (auto marked = layer.provisional->tile(change.address); marked || change.provisional.any()) {
      provisional[change.address] = with_provisional(marked, change);
      provisional_before[change.address] = std::move(marked);
    }
    if (change.before != change.after) tiles[change.address] = change.after;
  }
  const std::int64_t sequence_before = layer.layer.sequence;
  layer.mirror->put(tiles, sequence);
  put_provisional(layer, provisional, sequence, box);
  host_->set_sequence(layer, sequence);
  // The frames of the edit are requested before its texels are counted and compressed for the
  // journal, so these milliseconds do not delay the pixels.
  if (!tiles.empty() || !provisional.empty()) host_->content_changed(layer, box, sequence);

  store::JournalEntry entry;
  EditAnswer answer{sequence, 0, 0, false, is_provisional};
  auto& since_key_tile = since_key_tile_[layer.layer.id];
  for (const TileChange& change : computed.changes) {
    if (change.before == change.after) continue;  // no texel changes
    if (map) {
      const ChangeCount count = count_changes(change, *map);
      answer.texels_changed += count.texels;
      answer.area_m2 += count.area * model.metres() * model.metres();
    }
    store::JournalEntry::Revision revision{
        change.address,
        encode_revision(
            make_revision(change.address, *change.before, *change.after, change.written)),
        {}};
    // The first revision of a tile in this room is stored with a key tile. So chains of revisions
    // stay short, even if rooms open and close often.
    auto [since, first] = since_key_tile.try_emplace(change.address, 0);
    if (first || ++since->second >= kKeyTileEvery) {
      revision.key_tile = encode_tile(*change.after);
      since->second = 0;
    }
    entry.revisions.push_back(std::move(revision));
  }
  if (map) {
    entry.sum_tile = [map, about = layer.layer, after = std::move(tiles)](TileAddress address) {
      return sum_tile(about, *map, address, *after.at(address));
    };
  }

  const auto* stroke = std::get_if<StrokeEdit>(&item.request.edit);
  entry.model_id = model.id;
  entry.layer_id = layer.layer.id;
  entry.sequence = sequence;
  entry.epoch = parts_.epoch;
  entry.id = item.request.id;
  entry.trace = item.trace.id;
  entry.user = item.request.author.user;
  entry.stroke = stroke ? stroke->stroke : item.request.id;
  entry.op = op_name(item.request);
  entry.record = std::move(item.request.record);
  entry.answer = to_json(answer);
  entry.time = std::chrono::system_clock::now();
  entry.disable = std::move(computed.disable);
  entry.enable = std::move(computed.enable);
  if (is_provisional) entry.review = Review::pending;
  entry.reviewed = std::move(computed.reviewed);

  Listener::Edit event{layer.layer.id,    layer.layer.slug,
                       sequence,          entry.id,
                       entry.stroke,      stroke ? stroke->n : 0,
                       stroke != nullptr, item.request.author.user,
                       entry.op,          answer};
  if (auto* review = std::get_if<ReviewEdit>(&item.request.edit))
    event.review = {review->decision, std::move(review->reason), std::move(computed.authors)};
  if (item.applied) item.applied(answer);

  pending_.push_back({event, std::move(computed.changes), std::move(provisional_before),
                      sequence_before, std::move(item.saved), item.trace, false});
  submit(std::move(entry), pending_.back());
  // The author and the journal do not wait for hundreds of messages to others.
  host_->edit_applied(event);
  // After the event, whose author it would otherwise not recognize.
  if (not_saving_) refuse_pending(*not_saving_);
}

// Passes a pending edit to the writer. After a failure, no edit is written before the rollback.
void EditPipeline::submit(store::JournalEntry entry, Pending& pending) {
  if (failure_) {
    pending.answered = true;
    return;
  }
  pending.trace.submitted = EditTrace::Clock::now();
  const bool taken = parts_.writer.submit(
      std::move(entry), then([this, sequence = pending.event.sequence](const Result<void>& result) {
        on_saved(sequence, result);
      }));
  if (taken) return;
  failure_ = Error{ErrorCode::unavailable,
                   "Not saved",
                   "The database is too slow for the edits, so the server undid them. Send edits "
                   "more slowly.",
                   {}};
  pending.answered = true;
}

void EditPipeline::refuse_pending(const Error& why) {
  for (Pending& pending : pending_)
    answer(pending.event.id, std::exchange(pending.saved, {}), tl::unexpected(why));
}

void EditPipeline::put_provisional(LayerState& layer, const TileMap& tiles, std::int64_t sequence,
                                   const std::optional<render::FrameRequest::Box>& box) {
  if (tiles.empty()) return;
  const bool was_empty = layer.provisional->empty();
  layer.provisional->put(tiles, sequence);
  if (layer.provisional->empty() != was_empty) host_->styles_changed();
  std::set<TileAddress> addresses = std::exchange(stale_marks_[layer.layer.id], {});
  const auto area = addresses.empty() ? box : std::nullopt;
  for (const auto& [address, tile] : tiles) addresses.insert(address);
  std::vector<render::TileUpload> uploads;
  for (const TileAddress address : addresses)
    uploads.push_back({address, layer.provisional->tile(address)});
  // The upload can wait for a stroke on the GPU. Frames drawn during this wait show the edit
  // without its marks, so the views draw the marked area once more.
  const auto written = [this, id = layer.layer.id, area,
                        addresses = std::move(addresses)](const Result<void>& uploaded) {
    if (!uploaded) {
      stale_marks_[id].insert(addresses.begin(), addresses.end());
    } else if (LayerState* marked = closed_ ? nullptr : host_->find_layer(id)) {
      const std::int64_t newest = marked->layer.sequence;
      area ? host_->content_changed(*marked, area, newest)
           : announce_tiles(*marked, addresses, newest);
    }
  };
  parts_.renderer.write_tiles(layer.handles.provisional, std::move(uploads), then(written));
}

TileMap EditPipeline::durable_provisional(const LayerState& layer) const {
  TileMap tiles = layer.provisional->snapshot().tiles;
  for (auto pending = pending_.rbegin(); pending != pending_.rend(); ++pending)
    if (pending->event.layer_id == layer.layer.id)
      for (const auto& [address, before] : pending->provisional) tiles[address] = before;
  std::erase_if(tiles, [](const auto& entry) { return !entry.second; });
  return tiles;
}

void EditPipeline::on_saved(std::int64_t sequence, const Result<void>& result) {
  auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& pending) {
    return pending.event.sequence == sequence;
  });
  if (found == pending_.end()) return;
  if (!result && result.error().code == ErrorCode::moved && host_)
    return host_->deposed(result.error());
  if (!result) {
    found->answered = true;
    if (!failure_) failure_ = result.error();
    return;
  }
  Pending pending = std::move(*found);
  pending_.erase(found);
  durable_ = sequence;
  report(pending, nullptr);
  if (host_) host_->edit_saved(pending.event);
  answer(pending.event.id, pending.saved, pending.event.answer);
}

// Does not roll back while the room is paused, because the room then reads and uploads its layers.
void EditPipeline::roll_back_when_answered() {
  if (!failure_ || in_flight_ > 0 || busy_ || (paused_ && !closed_)) return;
  for (const Pending& pending : pending_)
    if (!pending.answered) return;

  const Error why = *failure_;
  failure_.reset();
  verify_ = true;
  sequence_ = durable_;
  std::deque<Pending> taken_back = std::exchange(pending_, {});
  struct Before {
    TileMap tiles, provisional;
    std::int64_t sequence = 0;
  };
  std::map<LayerId, Before> layers;  // the layers before their oldest pending edit
  for (auto pending = taken_back.rbegin(); pending != taken_back.rend(); ++pending) {
    Before& before = layers[pending->event.layer_id];
    before.sequence = pending->layer_sequence_before;
    for (const auto& change : pending->changes) before.tiles[change.address] = change.before;
    for (const auto& [address, tile] : pending->provisional) before.provisional[address] = tile;
  }
  for (auto& [layer_id, before] : layers) {
    LayerState* layer = closed_ ? nullptr : host_->find_layer(layer_id);
    if (!layer) continue;
    layer->mirror->put(before.tiles, before.sequence);
    put_provisional(*layer, before.provisional, before.sequence, std::nullopt);
    host_->set_sequence(*layer, before.sequence);
    since_key_tile_.erase(layer_id);  // the key tiles may be in unsaved edits
    for (const auto& [address, data] : before.tiles) stale_[layer_id].insert(address);
  }
  if (!closed_) repair();  // starts before listeners are notified
  std::vector<Listener::Edit> events;
  for (const auto& pending : taken_back) events.push_back(pending.event);
  log::warning("undid " + std::to_string(events.size()) +
               " edits that could not be saved: " + why.title + ": " + why.detail);
  if (!closed_) host_->edits_unsaved(events, why);
  for (auto& pending : taken_back) {
    report(pending, &why);
    answer(pending.event.id, pending.saved, tl::unexpected(why));
  }
}

// Writes the content of the mirrors to the GPU where it may differ. Writes empty tiles first,
// because they free pages that the other tiles may need.
bool EditPipeline::repair() {
  std::erase_if(stale_, [&](const auto& entry) { return !host_->find_layer(entry.first); });
  if (stale_.empty()) return false;
  if (repair_waits_ || in_flight_ > 0) return true;
  busy_ = true;
  auto left = std::make_shared<std::size_t>(4 * stale_.size());
  auto failure = std::make_shared<std::optional<Error>>();
  const auto write = [&](LayerId id, render::LayerHandle handle, const TileMirror& mirror,
                         const std::set<TileAddress>& tiles, bool empty_ones) {
    std::vector<render::TileUpload> uploads;
    for (const TileAddress address : tiles)
      if (auto tile = mirror.tile(address); !tile == empty_ones)
        uploads.push_back({address, std::move(tile)});
    parts_.renderer.write_tiles(handle, std::move(uploads),
                                then([=, this](const Result<void>& uploaded) {
                                  if (!uploaded && !*failure && has(id, handle))
                                    *failure = uploaded.error();
                                  if (--*left == 0) repaired(*failure);
                                }));
  };
  for (const bool empty_ones : {true, false})
    for (const auto& [layer_id, tiles] : stale_) {
      const LayerState* layer = host_->find_layer(layer_id);
      write(layer_id, layer->handles.content, *layer->mirror, tiles, empty_ones);
      write(layer_id, layer->handles.provisional, *layer->provisional, tiles, empty_ones);
    }
  return true;
}

bool EditPipeline::has(LayerId id, render::LayerHandle handle) const {
  const LayerState* layer = host_ ? host_->find_layer(id) : nullptr;
  return layer && (layer->handles.content == handle || layer->handles.provisional == handle);
}

void EditPipeline::repaired(const std::optional<Error>& failure) {
  busy_ = false;
  if (closed_) return;
  if (!failure) {
    for (const auto& [layer_id, tiles] : std::exchange(stale_, {})) {
      const LayerState* layer = host_->find_layer(layer_id);
      if (layer) announce_tiles(*layer, tiles, sequence_);
    }
    return;
  }
  if (paused_) return;  // the context was lost, so everything is uploaded again
  log::warning("tiles were not written to the GPU, trying again: " + failure->detail);
  refuse_waiting(gpu_problem(*failure));
  repair_waits_ = true;
  repair_timer_.expires_after(kRepairPause);
  repair_timer_.async_wait([self = shared_from_this()](const boost::system::error_code& cancelled) {
    self->repair_waits_ = false;
    if (!cancelled) self->step();
  });
}

// Requests new frames of an area whose content is now on the GPU.
void EditPipeline::announce_tiles(const LayerState& layer, const std::set<TileAddress>& tiles,
                                  std::int64_t sequence) {
  const int resolution = layer.layer.resolution;
  const auto bounds = parts_.maps->bounds(resolution);
  host_->content_changed(layer, bounds ? box_of(tiles, *bounds, resolution) : std::nullopt,
                         sequence);
}

bool EditPipeline::take_news(std::int64_t last_sequence, const std::vector<LayerNews>& news) {
  if (closed_ || paused_ || busy_ || !stale_.empty()) return false;
  sequence_ = durable_ = last_sequence;
  for (const auto& [layer_id, sequence, tiles, provisional] : news) {
    LayerState* layer = host_->find_layer(layer_id);
    if (!layer) continue;
    const bool was_empty = layer->provisional->empty();
    layer->mirror->put(tiles, sequence);
    layer->provisional->put(provisional, sequence);
    host_->set_sequence(*layer, sequence);
    if (layer->provisional->empty() != was_empty) host_->styles_changed();
    for (const TileMap* changed : {&tiles, &provisional})
      for (const auto& [address, tile] : *changed) stale_[layer_id].insert(address);
  }
  step();
  return true;
}

void EditPipeline::refuse(Waiting& item, const Error& why) {
  if (item.work) return item.work(tl::unexpected(why));
  report_edit(item.trace,
              {parts_.model_id, item.request.layer_id, op_name(item.request),
               std::holds_alternative<StrokeEdit>(item.request.edit)},
              &why, parts_.timings, parts_.slow_after);
  answer(item.request.id, item.saved, tl::unexpected(why));
}

void EditPipeline::report(const Pending& pending, const Error* why) {
  report_edit(pending.trace,
              {parts_.model_id, pending.event.layer_id, pending.event.op, pending.event.is_stroke},
              why, parts_.timings, parts_.slow_after);
}

void EditPipeline::refuse_waiting(const Error& why) {
  std::deque<Waiting> all = std::exchange(waiting_, {});
  for (Waiting& item : all) refuse(item, why);
}

void EditPipeline::answer(const Uuid& id, const Saved& saved, const Result<EditAnswer>& result) {
  std::vector<Saved> followers;
  if (auto found = running_.find(id); found != running_.end()) {
    followers = std::move(found->second.followers);
    running_.erase(found);
  }
  if (saved) saved(result);
  for (auto& follower : followers) {
    Result<EditAnswer> repeated = result;
    if (repeated) repeated->repeated = true;
    follower(repeated);
  }
}

// --- pause and close

void EditPipeline::stop_saving(const Error& why) {
  if (closed_ || not_saving_) return;
  not_saving_ = why;
  verify_ = true;
  compares_ = false;
  lookup_outdated_ = asking_;
  reading_outdated_ = paused_;
  refuse_waiting(why);
  refuse_pending(why);
}

void EditPipeline::continue_saving() {
  if (closed_ || !not_saving_) return;
  not_saving_.reset();
  compares_ = true;
  journal_away_ = false;  // the comparison starts immediately
  step();
}

void EditPipeline::report_compared() {
  if (std::exchange(compares_, false)) host_->saving_continued();
}

void EditPipeline::compare_later() {
  compare_timer_.expires_after(kComparePause);
  compare_timer_.async_wait(
      [self = shared_from_this()](const boost::system::error_code& cancelled) {
        if (cancelled || !self->compares_) return;
        self->journal_away_ = false;
        self->step();
      });
}

void EditPipeline::pause() {
  paused_ = tell_paused_ = true;
  step();
}

void EditPipeline::journal_read(std::int64_t last_sequence) {
  // No edit is pending, because the last rollback removed all pending edits.
  sequence_ = durable_ = last_sequence;
  verify_ = std::exchange(reading_outdated_, false);
  since_key_tile_.clear();
}

void EditPipeline::gpu_lacks(LayerId layer_id, const std::vector<TileAddress>& tiles) {
  stale_[layer_id].insert(tiles.begin(), tiles.end());
}

void EditPipeline::resume() {
  paused_ = false;
  if (!verify_) report_compared();
  step();
}

void EditPipeline::close(const Error& why) {
  if (closed_) return;
  closed_ = why;
  host_ = nullptr;
  repair_timer_.cancel();
  compare_timer_.cancel();
  refuse_waiting(why);
  if (why.code == ErrorCode::moved) {
    failure_.reset();
    for (Pending& pending : std::exchange(pending_, {}))
      answer(pending.event.id, pending.saved, tl::unexpected(why));
  }
  roll_back_when_answered();
}

}  // namespace strata::room
