#pragma once

#include <cstdint>
#include <map>
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
#include "store/journal/timeline.h"
#include "store/journal/undo_steps.h"

namespace strata::store {

class Pool;

// Tiles that the given edits wrote, with the union of their written masks.
struct WrittenTiles {
  TileAddress tile;
  TileMask written;
};

struct HistoryPage {
  std::vector<JournalRow> rows;
  std::int64_t total = 0;
};

// The model's last sequence, and the rows of the messages that were in the journal after it was
// read.
struct JournalState {
  std::int64_t last_sequence = 0;
  std::vector<JournalRow> known;
};

// Reads the journal of edits. Writes go through JournalWriter. Part of Store: its rules for threads
// and errors hold.
class Journal {
 public:
  explicit Journal(Pool& pool) : pool_(pool) {}

  // Returns all tiles of a layer after `at_sequence` (nothing: the newest).
  Result<TileMirror::Snapshot> load_tiles(const Layer& layer,
                                          std::optional<std::int64_t> at_sequence = {});
  // The same for the state after `sequence`, an edit of the layer or 0. Reads only tiles that edits
  // between it and `near` wrote; the others are those of `near`, a state that is in the journal.
  Result<TileMirror::Snapshot> load_tiles_near(const Layer& layer, std::int64_t sequence,
                                               const TileMirror::Snapshot& near);
  // Returns each layer's last edit up to a sequence of the model; layers without one are left out.
  Result<std::map<LayerId, std::int64_t>> layer_sequences(ModelId model_id, std::int64_t sequence);
  // Returns revisions of a tile older than `before`, newest first, at most `limit`, with the
  // present state of their edits.
  Result<std::vector<PastRevision>> tile_history(const Layer& layer, TileAddress tile,
                                                 std::int64_t before, int limit);
  Result<std::vector<WrittenTiles>> written_by(const Layer& layer,
                                               std::span<const std::int64_t> sequences);
  // Newest first; `before`: only edits with lower sequences.
  Result<HistoryPage> history(LayerId layer_id, int limit, int offset,
                              std::optional<std::int64_t> before = {});
  Result<JournalState> state(ModelId model_id, std::span<const Uuid> ids);
  // Return the sequences (ascending) of the newest stroke of `user` on the layer that is in force /
  // that is undone and not followed by a newer in-force stroke of the same user; empty if there is
  // no such stroke. `pending_only`: only strokes that wait for review.
  Result<std::vector<std::int64_t>> undoable(LayerId layer_id, const std::string& user,
                                             bool pending_only = false);
  Result<std::vector<std::int64_t>> redoable(LayerId layer_id, const std::string& user,
                                             bool pending_only = false);
  // review.cpp: returns the strokes and other edits of a layer that are in force and wait for
  // review, oldest first. `after`: only those that begin with a higher sequence.
  Result<ReviewQueue> review_queue(LayerId layer_id, const std::optional<std::string>& user,
                                   int limit, int offset, std::int64_t after = 0);
  // Returns the edits that a decision affects: those that wait for review and are in force, and,
  // for `reopen`, those that were accepted or rejected. Batches of a stroke belong together: naming
  // one of them selects all.
  Result<std::vector<UnderReview>> under_review(LayerId layer_id, Decision decision,
                                                const Reviewees& which);
  // timeline.cpp: counts the edits of a model over time.
  Result<Timeline> timeline(ModelId model_id, const TimelineQuery& query);
  // Returns the strokes and other edits up to `from` (backward) or after it, the nearest ones.
  Result<TimelineSteps> timeline_steps(ModelId model_id, const std::vector<LayerId>& layers,
                                       std::int64_t from, bool backward, int limit);
  // undo_steps.cpp: returns the steps that undo and redo would change, one after the other.
  Result<UndoSteps> undo_steps(ModelId model_id, const std::string& user, const UndoQuery& query);
  Result<std::int64_t> last_sequence(ModelId model_id);
  // Returns the sequence of the last edit until a time (the text of core/text/timestamp.h); 0
  // before the first edit.
  Result<std::int64_t> sequence_at(ModelId model_id, const std::string& utc);
  // Returns when the last edit of a layer that everybody sees was made, up to a sequence; nothing:
  // no such edit exists.
  Result<std::optional<std::chrono::system_clock::time_point>> time_of_state(ModelId model_id,
                                                                             std::int64_t sequence);
  Result<std::uint64_t> revision_bytes(ModelId model_id);

 private:
  Pool& pool_;
};

}  // namespace strata::store
