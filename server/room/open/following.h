#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "room/open/open_room.h"
#include "room/pipeline/edit_pipeline.h"
#include "store/journal/tail.h"

namespace strata::room {

// Keeps a room up to date whose model another node has. The room reads what the journal and the
// tables of the model contain, and shows it: it claims nothing, accepts no edits and writes
// nothing. If the owner changes, it continues with the journal of the next owner.
class OpenRoom::FollowingPart {
 public:
  using Clock = std::chrono::steady_clock;

  // `state` was read before the content of the room.
  FollowingPart(OpenRoom& room, const store::ModelState& state) : room_(room), known_(state) {}

  // Returns whether the caller may now call `catch_up`: one call at a time.
  bool begin() { return !busy_.exchange(true); }
  // Reads all changes up to this state, or later ones, and notifies the participants. `asked` is
  // when the state was requested. After an error, the next call reads the rest. Blocks.
  void catch_up(const store::ModelState& now, Clock::time_point asked);
  // Returns a time at which the room showed everything that was in the database.
  Clock::time_point current_at() const { return current_at_; }
  // The node has a lease again. Takes effect when the room has caught up.
  void resume() { resumes_ = true; }

 private:
  Result<void> read(const store::ModelState& now);
  Result<void> read_layers(const store::ModelState& now, bool starts_over);
  // Returns nothing if the content of the layer has not changed.
  Result<std::optional<EditPipeline::LayerNews>> read_layer(
      const Layer& stored, const std::vector<store::TailEdit>& edits, bool starts_over);
  Result<TileMap> read_marks(const LayerState& held, const Layer& stored,
                             const std::vector<store::TailEdit>& edits, bool starts_over);
  // Runs on the strand. Returns false if the room cannot take the news yet.
  bool take(std::int64_t last_sequence, const std::vector<EditPipeline::LayerNews>& news,
            const std::vector<store::TailEdit>& edits);

  OpenRoom& room_;
  std::atomic<bool> busy_{false}, resumes_{false}, fails_{false};
  std::atomic<Clock::time_point> current_at_{Clock::now()};
  store::ModelState known_;  // used by the one that catches up
};

}  // namespace strata::room
