#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
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

  // Returns whether the caller must now call `catch_up` for this state, which was requested at
  // `asked`. Returns false if there is nothing to read, or while another call is in progress.
  bool begin(const store::ModelState& now, Clock::time_point asked);
  // Reads all changes up to this state, or later ones, and notifies the participants. After an
  // error, the next call reads the rest. Blocks.
  void catch_up(const store::ModelState& now, Clock::time_point asked);
  // Returns a time at which the room showed everything that was in the database.
  Clock::time_point current_at() const { return current_at_; }
  bool is_slow() const { return is_slow_; }  // the last call of `catch_up` took long
  // The node has a lease again. Takes effect when the room has caught up with a state that was
  // requested later.
  void resume() { resumed_at_ = Clock::now(); }
  void suspend() { resumed_at_ = kNotResumed; }  // the node has no lease
  // Call when the room is closed. A call of `catch_up` in progress ends soon, and logs no error.
  void stop() { stopped_ = true; }

  // How the following ended. Then the owner of the room must close it.
  enum class End { none, failed, lost_edits };
  // `failed`: the room could not be kept up to date for RoomOptions::stop_following_after, although
  // the database answers. `lost_edits`: the database no longer contains edits that the room shows,
  // so the room must be read again.
  End end() const { return end_; }

 private:
  // Each step updates its part of `known_`. Returns false if the room cannot take the news yet.
  Result<bool> read(const store::ModelState& now);
  Result<bool> read_layers(const store::ModelState& now);
  Result<bool> read_images(const store::ModelState& now);
  Result<bool> read_model(const store::ModelState& now);
  Result<bool> read_content(const store::ModelState& now);
  Result<bool> load_layers(const store::ModelState& now);
  // Returns whether the journal contains all edits that the room has read.
  Result<bool> has_all_edits(const store::ModelState& now);
  // Returns nothing if the content of the layer has not changed. `sequence` is that of its last
  // edit.
  Result<std::optional<EditPipeline::LayerNews>> read_layer(
      const LayerState& held, std::int64_t sequence, const std::vector<store::TailEdit>& edits);
  Result<TileMap> read_marks(const LayerState& held, const std::vector<store::TailEdit>& edits);
  // Runs on the strand. Returns false if the room cannot take the news yet.
  bool take(std::int64_t last_sequence, const std::vector<EditPipeline::LayerNews>& news,
            const std::vector<store::TailEdit>& edits);
  void show_current(Clock::time_point asked);
  void on_failed(const Result<bool>& done);

  OpenRoom& room_;
  static constexpr auto kNotResumed = Clock::time_point::max();
  std::atomic<bool> busy_{false}, stopped_{false}, is_slow_{false};
  // From `resume` until the room has caught up.
  std::atomic<Clock::time_point> resumed_at_{kNotResumed};
  std::atomic<End> end_{End::none};
  std::atomic<Clock::time_point> current_at_{Clock::now()};
  // The other members are used by the one that catches up.
  store::ModelState known_;
  // Layers that must be loaded completely: new ones, those whose type has changed, and those that
  // could not be read. If that fails, it is repeated at `load_at_`.
  std::set<LayerId> to_load_;
  Clock::time_point load_at_{};
  std::optional<Clock::time_point> fails_since_;  // while the database answers
  bool is_reported_ = false;                      // the failure is in the log
};

}  // namespace strata::room
