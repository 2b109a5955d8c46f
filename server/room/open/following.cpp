#include "room/open/following.h"

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "core/log.h"
#include "room/open/open_layers.h"
#include "room/open/open_participants.h"
#include "room/open/open_surface_images.h"
#include "room/pipeline/provisional.h"
#include "room/pipeline/tile_changes.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/surface_images.h"
#include "store/journal/journal_reads.h"

namespace strata::room {
namespace {

// Participants are notified of at most this number of edits at once. Of older edits, they only
// learn which layers have changed.
constexpr int kMaxEdits = 256;
constexpr auto kSlow = std::chrono::milliseconds(200);
constexpr auto kLoadPause = std::chrono::seconds(2);  // after a layer could not be loaded

// Returns whether the edit changes the state of earlier edits.
bool turns_others(const store::TailEdit& edit) {
  constexpr std::array<std::string_view, 5> kOps{"undo", "redo", "accept", "reject", "reopen"};
  return std::ranges::find(kOps, edit.op) != kOps.end();
}

// Returns the tiles that differ, as they are in `now`.
TileMap changes_between(const TileMap& before, const TileMap& now) {
  TileMap changes;
  for (const TileAddress address : differing_tiles(before, now)) {
    const auto found = now.find(address);
    changes[address] = found == now.end() ? nullptr : found->second;
  }
  return changes;
}

Listener::Edit event_of(const store::TailEdit& edit, const Layer& layer) {
  Listener::Edit event;
  event.layer_id = edit.layer_id;
  event.layer = layer.slug;
  event.sequence = edit.sequence;
  event.id = edit.id;
  event.stroke = edit.stroke;
  event.is_stroke = edit.op == "stroke";
  event.user = edit.user;
  event.op = edit.op;
  event.answer.sequence = edit.sequence;
  event.answer.provisional = edit.provisional;
  return event;
}

}  // namespace

bool OpenRoom::FollowingPart::begin(const store::ModelState& now, Clock::time_point asked) {
  if (busy_.exchange(true)) return false;
  if (now != known_ || !to_load_.empty() || resumed_at_.load() <= asked) return true;
  current_at_ = asked;
  busy_ = false;
  return false;
}

void OpenRoom::FollowingPart::catch_up(const store::ModelState& now, Clock::time_point asked) {
  const auto begun = Clock::now();
  Result<bool> done = true;
  try {
    done = read(now);
  } catch (const std::exception& error) {  // no memory, or no thread to decode tiles
    done = fail(ErrorCode::out_of_memory, "Out of memory", error.what());
  }
  if (done && *done)
    show_current(asked);
  else if (!stopped_)
    on_failed(done);
  is_slow_ = Clock::now() - begun > kSlow;
  busy_ = false;
}

void OpenRoom::FollowingPart::show_current(Clock::time_point asked) {
  current_at_ = asked;
  fails_since_.reset();
  if (std::exchange(is_reported_, false))
    log::info("model " + to_string(room_.id()) + " of another node is up to date again");
  run_on(room_.strand_, [&] {
    if (resumed_at_.load() > asked) return;
    resumed_at_ = kNotResumed;
    room_.saving_continued();
  });
}

void OpenRoom::FollowingPart::on_failed(const Result<bool>& done) {
  if (!done && !std::exchange(is_reported_, true))
    log::warning("model " + to_string(room_.id()) +
                 " of another node is not up to date: " + done.error().detail);
  // While the database is unreachable, no other node has a newer state.
  if (!done && done.error().code == ErrorCode::unavailable) return fails_since_.reset();
  if (!fails_since_) fails_since_ = Clock::now();
  if (Clock::now() - *fails_since_ >= room_.services_.options.stop_following_after &&
      end_ == End::none)
    end_ = End::failed;
}

// An error in one step does not stop the others. The properties of layers come first, because they
// determine who sees a layer. If the database does not answer, the next step would wait as long.
Result<bool> OpenRoom::FollowingPart::read(const store::ModelState& now) {
  using Part = FollowingPart;
  Result<bool> all = true;
  for (const auto step : {&Part::read_layers, &Part::read_images, &Part::read_model,
                          &Part::read_content, &Part::load_layers}) {
    const auto done = (this->*step)(now);
    if (all && !(done && *done)) all = done;
    if (stopped_ || end_ != End::none) return false;
    if (!done && done.error().code == ErrorCode::unavailable) break;
  }
  return all;
}

Result<bool> OpenRoom::FollowingPart::read_layers(const store::ModelState& now) {
  if (now.layers == known_.layers) return true;
  const auto stored = STRATA_TRY(room_.services_.store.layers().of_model(room_.id(), Role::owner));
  const auto lacking = room_.layers_part_->take(stored);
  to_load_.insert(lacking.begin(), lacking.end());
  std::erase_if(to_load_, [&](const LayerId id) {
    return std::ranges::find(stored, id, &Layer::id) == stored.end();
  });
  known_.layers = now.layers;
  return true;
}

Result<bool> OpenRoom::FollowingPart::read_images(const store::ModelState& now) {
  if (now.images == known_.images) return true;
  const auto images = STRATA_TRY(room_.services_.store.surface_images().of_model(room_.id()));
  run_on(room_.strand_, [&] { room_.surface_images_part_->replace(images); });
  known_.images = now.images;
  return true;
}

Result<bool> OpenRoom::FollowingPart::read_model(const store::ModelState& now) {
  if (now.version == known_.version) return true;
  const auto model = STRATA_TRY(room_.services_.store.models().find(to_string(room_.id())));
  if (model.version != room_.model().version) room_.show_model(model);
  known_.version = now.version;
  return true;
}

// The commits of each owner follow the last edit of the one before, so a new claim changes nothing.
// But a database that lost edits can contain others with the same sequences.
Result<bool> OpenRoom::FollowingPart::has_all_edits(const store::ModelState& now) {
  if (now.sequence < known_.sequence) return false;
  if (now.epoch == known_.epoch || now.last_edit == known_.last_edit) return true;
  const auto last =
      STRATA_TRY(room_.services_.store.journal().last_edit(room_.id(), known_.sequence));
  return last == known_.last_edit;
}

Result<bool> OpenRoom::FollowingPart::read_content(const store::ModelState& now) {
  const bool has_all = STRATA_TRY(has_all_edits(now));
  if (!has_all) {
    log::warning("the database has lost edits of model " + to_string(room_.id()) +
                 " of another node, so the model is read again");
    end_ = End::lost_edits;
    return false;
  }
  Result<bool> all = true;
  if (now.sequence != known_.sequence) {
    store::Journal& journal = room_.services_.store.journal();
    const auto edits =
        STRATA_TRY(journal.last_edits(room_.id(), known_.sequence, now.sequence, kMaxEdits));
    const auto sequences = STRATA_TRY(journal.layer_sequences(room_.id(), now.sequence));
    std::vector<EditPipeline::LayerNews> news;
    for (const LayerState& held : room_.layer_states()) {
      const auto sequence = sequences.find(held.layer.id);
      if (stopped_) return false;
      if (sequence == sequences.end() || to_load_.contains(held.layer.id)) continue;
      auto changed = read_layer(held, sequence->second, edits);
      if (changed && *changed) news.push_back(std::move(**changed));
      if (changed) continue;
      if (changed.error().code == ErrorCode::unavailable) return tl::unexpected(changed.error());
      to_load_.insert(held.layer.id);
      all = tl::unexpected(changed.error());
    }
    if (!run_on(room_.strand_, [&] { return take(now.sequence, news, edits); })) return false;
  }
  known_.sequence = now.sequence;
  known_.epoch = now.epoch;
  known_.last_edit = now.last_edit;
  return all;
}

Result<bool> OpenRoom::FollowingPart::load_layers(const store::ModelState&) {
  if (!to_load_.empty() && Clock::now() < load_at_) return false;
  Result<bool> all = true;
  for (auto id = to_load_.begin(); id != to_load_.end();) {
    if (stopped_) return false;
    const auto loaded = room_.layers_part_->load(*id);
    if (!loaded) all = tl::unexpected(loaded.error());
    id = loaded ? to_load_.erase(id) : std::next(id);
  }
  if (!all) load_at_ = Clock::now() + kLoadPause;
  return all;
}

Result<std::optional<EditPipeline::LayerNews>> OpenRoom::FollowingPart::read_layer(
    const LayerState& held, std::int64_t sequence, const std::vector<store::TailEdit>& edits) {
  const LayerId id = held.layer.id;
  const auto before = held.mirror->snapshot();
  const bool is_behind = sequence > before.sequence;
  const bool has_edits =
      std::ranges::any_of(edits, [&](const auto& edit) { return edit.layer_id == id; });
  if (!is_behind && !has_edits) return std::nullopt;
  store::Journal& journal = room_.services_.store.journal();
  const auto after =
      is_behind ? STRATA_TRY(journal.load_tiles_near(held.layer, sequence, before)) : before;
  auto marks = STRATA_TRY(read_marks(held, edits));
  return EditPipeline::LayerNews{id, after.sequence, changes_between(before.tiles, after.tiles),
                                 std::move(marks)};
}

// An undo changes the marks of the texels that the undone edits wrote, and other edits those of
// the texels that they wrote. The journal does not contain which edits a redo or a decision has
// changed, so all marks of the layer are read. They are also read if no texel waits, because then
// few edits can wait.
Result<TileMap> OpenRoom::FollowingPart::read_marks(const LayerState& held,
                                                    const std::vector<store::TailEdit>& edits) {
  store::Store& store = room_.services_.store;
  const TileMap before = held.provisional->snapshot().tiles;
  bool reads_all = edits.size() == kMaxEdits;
  const bool has_marks = !before.empty();
  bool has_pending = has_marks;
  std::vector<std::int64_t> painted;
  for (const store::TailEdit& edit : edits) {
    if (edit.layer_id != held.layer.id) continue;
    if (edit.op == "undo" && has_marks) {
      const auto undone =
          STRATA_TRY(store.journal().undone_by(held.layer.id, edit.user, edit.sequence));
      painted.insert(painted.end(), undone.begin(), undone.end());
    } else {
      reads_all = reads_all || turns_others(edit);
    }
    has_pending = has_pending || edit.pending;
    painted.push_back(edit.sequence);
  }
  if (reads_all) {
    const auto now = STRATA_TRY(read_provisional(store, held.layer));
    return changes_between(before, now);
  }
  if (!has_pending || painted.empty()) return TileMap{};
  return read_provisional(store, held.layer, painted, before);
}

bool OpenRoom::FollowingPart::take(std::int64_t last_sequence,
                                   const std::vector<EditPipeline::LayerNews>& news,
                                   const std::vector<store::TailEdit>& edits) {
  if (!room_.pipeline_->take_news(last_sequence, news)) return false;
  room_.sequence_ = room_.durable_ = last_sequence;
  std::set<LayerId> told;
  for (const store::TailEdit& edit : edits) {
    const auto state = room_.layer_state(edit.layer_id);
    if (!state) continue;
    const auto event = event_of(edit, state->layer);
    room_.participants_part_->tell_seen(state->layer,
                                        [&](Listener& listener) { listener.edit_applied(event); });
    room_.outdate_readers(edit.layer_id, edit.sequence);
    told.insert(edit.layer_id);
  }
  for (const auto& [id, sequence, tiles, marks] : news) {
    const auto state = room_.layer_state(id);
    if (!state || told.contains(id) || (tiles.empty() && marks.empty())) continue;
    room_.participants_part_->tell_layer(state->layer.visibility, state->layer);
    room_.outdate_readers(id, sequence);
  }
  return true;
}

}  // namespace strata::room
