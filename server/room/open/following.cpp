#include "room/open/following.h"

#include <algorithm>
#include <array>
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

// After more edits at once, participants only learn which layers have changed.
constexpr int kMaxEdits = 256;

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

void OpenRoom::FollowingPart::catch_up(const store::ModelState& now, Clock::time_point asked) {
  const bool resumes = resumes_.exchange(false);
  const auto done = now == known_ ? Result<void>{} : read(now);
  if (!done) {
    if (resumes) resumes_ = true;
    // While the room cannot take the news, the pipeline logs the reason if there is one.
    if (done.error().code != ErrorCode::busy && !fails_.exchange(true))
      log::warning("model " + to_string(room_.id()) +
                   " of another node is not up to date: " + done.error().detail);
  } else {
    known_ = now;
    current_at_ = asked;
    if (fails_.exchange(false))
      log::info("model " + to_string(room_.id()) + " of another node is up to date again");
    if (resumes) run_on(room_.strand_, [&] { room_.saving_continued(); });
  }
  busy_ = false;
}

Result<void> OpenRoom::FollowingPart::read(const store::ModelState& now) {
  store::Store& store = room_.services_.store;
  if (now.version != known_.version) {
    const auto model = STRATA_TRY(store.models().find(to_string(room_.id())));
    if (model.version != room_.model().version) room_.show_model(model);
  }
  if (now.images != known_.images) {
    const auto images = STRATA_TRY(store.surface_images().of_model(room_.id()));
    run_on(room_.strand_, [&] { room_.surface_images_part_->replace(images); });
  }
  // After a new claim, or if the database lost edits, the same sequences may be other edits.
  const bool starts_over = now.epoch != known_.epoch || now.sequence < known_.sequence;
  if (!starts_over && now.sequence == known_.sequence && now.layers == known_.layers) return {};
  return read_layers(now, starts_over);
}

Result<void> OpenRoom::FollowingPart::read_layers(const store::ModelState& now, bool starts_over) {
  store::Store& store = room_.services_.store;
  const auto edits =
      STRATA_TRY(store.journal().last_edits(room_.id(), known_.sequence, now.sequence, kMaxEdits));
  const auto stored = STRATA_TRY(store.layers().of_model(room_.id(), Role::owner));
  STRATA_TRY(room_.layers_part_->take(stored));
  std::vector<EditPipeline::LayerNews> news;
  std::int64_t last_sequence = now.sequence;
  for (const Layer& layer : stored) {
    auto changed = STRATA_TRY(read_layer(layer, edits, starts_over));
    if (!changed) continue;
    // The layers may contain edits that are newer than the state.
    last_sequence = std::max(last_sequence, changed->sequence);
    news.push_back(std::move(*changed));
  }
  if (run_on(room_.strand_, [&] { return take(last_sequence, news, edits); })) return {};
  return fail(ErrorCode::busy, "Model is busy", "The model is still being uploaded to the GPU.");
}

Result<std::optional<EditPipeline::LayerNews>> OpenRoom::FollowingPart::read_layer(
    const Layer& stored, const std::vector<store::TailEdit>& edits, bool starts_over) {
  const auto held = room_.layer_state(stored.id);
  if (!held) return std::nullopt;
  const auto before = held->mirror->snapshot();
  const bool has_edits = std::ranges::any_of(
      edits, [&](const store::TailEdit& edit) { return edit.layer_id == stored.id; });
  if (!starts_over && stored.sequence == before.sequence && !has_edits) return std::nullopt;
  store::Journal& journal = room_.services_.store.journal();
  const bool is_behind = !starts_over && stored.sequence >= before.sequence;
  const auto after = STRATA_TRY(is_behind ? journal.load_tiles_near(stored, stored.sequence, before)
                                          : journal.load_tiles(stored));
  auto marks = STRATA_TRY(read_marks(*held, stored, edits, starts_over));
  return EditPipeline::LayerNews{stored.id, after.sequence,
                                 changes_between(before.tiles, after.tiles), std::move(marks)};
}

// A decision or an undo can change the marks of any edit, so it makes all marks of the layer be
// read. Other edits change only the marks of the texels that they wrote.
Result<TileMap> OpenRoom::FollowingPart::read_marks(const LayerState& held, const Layer& stored,
                                                    const std::vector<store::TailEdit>& edits,
                                                    bool starts_over) {
  store::Store& store = room_.services_.store;
  const TileMap before = held.provisional->snapshot().tiles;
  bool reads_all = starts_over || edits.size() == kMaxEdits;
  bool has_pending = !before.empty();
  std::vector<std::int64_t> painted;
  for (const store::TailEdit& edit : edits) {
    if (edit.layer_id != stored.id) continue;
    reads_all = reads_all || turns_others(edit);
    has_pending = has_pending || edit.pending;
    painted.push_back(edit.sequence);
  }
  if (reads_all) {
    const auto now = STRATA_TRY(read_provisional(store, stored));
    return changes_between(before, now);
  }
  if (!has_pending || painted.empty()) return TileMap{};
  return read_provisional(store, stored, painted, before);
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
