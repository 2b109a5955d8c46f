#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "domain/layers/history.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "store/journal/journal.h"
#include "store/journal/tail.h"
#include "store/journal/timeline.h"
#include "store/journal/undo_steps.h"

namespace strata::store {

class Pool;

// A tile that the given edits wrote, with the union of the masks of these edits.
struct WrittenTiles {
  TileAddress tile;
  TileMask written;
};

struct HistoryPage {
  std::vector<JournalRow> rows;
  std::int64_t total = 0;
};

// The last sequence and the epoch of a model (store/nodes/nodes.h), and then the rows of the given
// messages that the journal contained. The rows were read after the sequence and the epoch.
struct JournalState {
  std::int64_t last_sequence = 0;
  std::int64_t epoch = 0;
  std::vector<JournalRow> known;
};

// Reads the journal of edits. JournalWriter writes it, and JournalMerger makes it smaller. A merged
// edit has the sequence of its last batch. Therefore, a state at the sequence of an earlier batch
// does not contain any part of the stroke. JournalThinner removes old states: to read such a state
// is an error with the code `gone` (kept_states.h).
// Part of Store, whose rules for threads and errors apply.
class Journal {
 public:
  explicit Journal(Pool& pool) : pool_(pool) {}

  // Returns all tiles of a layer after the edit `at_sequence`, or the current tiles if it is empty.
  Result<TileMirror::Snapshot> load_tiles(const Layer& layer,
                                          std::optional<std::int64_t> at_sequence = {});
  // Returns all tiles of a layer as they were after the edit `sequence` (0: before all edits).
  // Reads only the tiles that edits between `sequence` and `near` wrote. The other tiles come from
  // `near`, which is a state in the journal.
  Result<TileMirror::Snapshot> load_tiles_near(const Layer& layer, std::int64_t sequence,
                                               const TileMirror::Snapshot& near);
  // Returns the last edit of each layer up to a sequence of the model. Layers without an edit are
  // left out.
  Result<std::map<LayerId, std::int64_t>> layer_sequences(ModelId model_id, std::int64_t sequence);
  // Passes the revisions of a tile, newest first, with the current state of their edits, until
  // `on_revision` returns false. Reads all revisions from one snapshot of the database, because the
  // merger may replace rows at any time (journal_merger.h). Calls `begin` first, and again if the
  // reading starts again after a lost connection.
  Result<void> tile_past(const Layer& layer, TileAddress tile, const std::function<void()>& begin,
                         const std::function<bool(PastRevision&)>& on_revision);
  Result<std::vector<WrittenTiles>> written_by(const Layer& layer,
                                               std::span<const std::int64_t> sequences);
  // Returns the history, newest first. `before` selects only edits with lower sequences.
  Result<HistoryPage> history(LayerId layer_id, int limit, int offset,
                              std::optional<std::int64_t> before = {});
  Result<JournalState> state(ModelId model_id, std::span<const Uuid> ids);
  // Waits until no transaction is writing edits of the model. A commit may still be running in the
  // database although its writer has given up. Returns an Error if this takes longer than the
  // request limit.
  Result<void> wait_for_commits(ModelId model_id);
  // Returns what rooms of other nodes compare (tail.cpp).
  Result<ModelState> model_state(ModelId model_id);
  std::unique_ptr<ModelStates> states();  // returns a new reader
  // Returns ModelState::last_edit of the last edit up to a sequence.
  Result<std::int64_t> last_edit(ModelId model_id, std::int64_t through);
  // Returns the edits after a sequence and up to another one, oldest first. If there are more than
  // `limit`, returns the newest ones.
  Result<std::vector<TailEdit>> last_edits(ModelId model_id, std::int64_t after,
                                           std::int64_t through, int limit);
  // Return the sequences, ascending, of a stroke of `user` on the layer, or nothing if there is no
  // such stroke. `undoable` returns the newest stroke in force. `redoable` returns the newest
  // undone stroke, unless a newer stroke of the same user is in force. `pending_only` selects only
  // strokes that wait for review.
  Result<std::vector<std::int64_t>> undoable(LayerId layer_id, const std::string& user,
                                             bool pending_only = false);
  Result<std::vector<std::int64_t>> redoable(LayerId layer_id, const std::string& user,
                                             bool pending_only = false);
  // Returns the edits of `user` that this undo has disabled and that no redo has restored.
  Result<std::vector<std::int64_t>> undone_by(LayerId layer_id, const std::string& user,
                                              std::int64_t undo);
  // Returns the strokes and other edits of a layer that are in force and wait for review, oldest
  // first (review.cpp). `after` selects only strokes and edits that begin with a higher sequence.
  Result<ReviewQueue> review_queue(LayerId layer_id, const std::optional<std::string>& user,
                                   int limit, int offset, std::int64_t after = 0);
  // Returns the edits that a decision affects: edits that wait for review and are in force, or, for
  // `reopen`, edits that were accepted or rejected. If the caller names one batch of a stroke, the
  // result contains all batches of the stroke. A batch that was merged selects the merged edit.
  Result<UnderReview> under_review(LayerId layer_id, Decision decision, const Reviewees& which);
  // Counts the edits of a model over time (timeline.cpp).
  Result<Timeline> timeline(ModelId model_id, const TimelineQuery& query);
  // Returns the strokes and other edits nearest to `from`: after it, or if `backward`, up to it.
  Result<TimelineSteps> timeline_steps(ModelId model_id, const std::vector<LayerId>& layers,
                                       std::int64_t from, bool backward, int limit);
  // Returns the steps that repeated undo and redo would change, in the order of these changes.
  Result<UndoSteps> undo_steps(ModelId model_id, const std::string& user, const UndoQuery& query);
  Result<std::int64_t> last_sequence(ModelId model_id);
  // Returns the sequence of the last edit up to a time (text as in core/text/timestamp.h), or 0
  // before the first edit. If the journal no longer has this state, returns the last one before it
  // that the journal has.
  Result<std::int64_t> sequence_at(ModelId model_id, const std::string& utc);
  // Returns the time of the last edit, up to a sequence, of the layers that are visible to all
  // roles. Returns nothing if no such edit exists.
  Result<std::optional<std::chrono::system_clock::time_point>> time_of_state(ModelId model_id,
                                                                             std::int64_t sequence);
  // Returns the bytes of the stored texels of all edits.
  Result<std::uint64_t> revision_bytes(ModelId model_id);

 private:
  friend class JournalMerger;
  friend class JournalThinner;
  Pool& pool_;
};

}  // namespace strata::store
