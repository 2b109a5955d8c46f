#include "room/open/open_edits.h"

#include <boost/asio/post.hpp>

#include "room/pipeline/edit_pipeline.h"
#include "room/pipeline/retired_keys.h"
#include "room/pipeline/strand.h"
#include "room/pipeline/tile_changes.h"
#include "store/content/layers.h"
#include "store/store.h"

namespace strata::room {

void OpenRoom::EditsPart::submit(EditRequest request, Applied applied, Saved saved) {
  room_.touch();
  // Other nodes can accept the edit immediately.
  if (room_.following_part_ || (!room_.takes_edits_ && room_.services_.options.node))
    return saved(tl::unexpected(moved_to({})));
  if (!room_.takes_edits_)
    return saved(
        fail(ErrorCode::unavailable, "Server is stopping",
             "The server is saving its edits and will then stop. Send the edit again when it is "
             "running again."));
  // Counts the edit before posting it, because the queue of the strand has no limit.
  if (++room_.unanswered_ > room_.services_.options.max_waiting_edits) {
    --room_.unanswered_;
    return saved(fail(ErrorCode::too_many_requests, "Too many edits",
                      "Too many edits of this model are waiting. Send edits more slowly."));
  }
  boost::asio::post(
      room_.strand_, [room = room_.shared_from_this(), this, request = std::move(request),
                      applied = std::move(applied), saved = std::move(saved)]() mutable {
        if (auto free = check_not_retired(request); !free) {
          --room->unanswered_;
          return saved(tl::unexpected(free.error()));
        }
        // The callback keeps the room alive until the edit has a result.
        room->pipeline_->edit(std::move(request), std::move(applied),
                              [room, saved = std::move(saved)](Result<EditAnswer> answer) {
                                --room->unanswered_;
                                saved(std::move(answer));
                              });
      });
}

// Runs in the order of edits, because the deletion of a record changes its texels only after every
// accepted edit.
Result<void> OpenRoom::EditsPart::check_not_retired(const EditRequest& request) const {
  const LayerState* state = room_.find_layer(request.layer_id);
  if (!state || !state->layer.table ||
      !room_.services_.retired_keys.has_any_of(*state->layer.table))
    return {};
  for (const auto key : painted_by(state->layer, request))
    if (room_.services_.retired_keys.holds(*state->layer.table, key))
      return fail(ErrorCode::conflict, "Record was deleted",
                  "Record " + std::to_string(key) + " was deleted in the meantime.", "value");
  return {};
}

DurableState OpenRoom::EditsPart::durable_state() const {
  return run_on(room_.strand_, [&] {
    DurableState state{room_.durable_, {}};
    for (const auto& [id, layer] : room_.layers_)
      if (TileMap waiting = room_.pipeline_->durable_provisional(layer); !waiting.empty())
        state.provisional.emplace(id, std::move(waiting));
    return state;
  });
}

Result<void> OpenRoom::EditsPart::keep_sums(LayerId layer_id) {
  room_.touch();
  STRATA_TRY(room_.check_claimed());  // before the map is made
  const auto found = STRATA_TRY(room_.state(to_string(layer_id)));
  const auto map = room_.surface_map(found.layer.resolution);
  if (!map) return tl::unexpected(map.error());
  return room_.exclusively<void>(
      [this, layer = found.layer, mirror = found.mirror, map = *map]() -> Result<void> {
        std::vector<store::TileKeys> sums;
        for (const auto& [address, tile] : mirror->snapshot().tiles)
          sums.push_back({address, sum_tile(layer, *map, address, *tile)});
        return room_.services_.store.layers().keep_sums(layer.id, std::move(sums));
      });
}

}  // namespace strata::room
