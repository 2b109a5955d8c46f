#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

// An edit of the journal, with the facts that decide whether it can be merged.
struct PlannedEdit {
  std::int64_t sequence = 0;
  LayerId layer = 0;
  Uuid stroke;
  std::string user;
  std::chrono::system_clock::time_point time;
  bool is_batch = false;  // one of the batches of a stroke
  // Only batches with equal traits can be merged: the state of undo and review, and the brush.
  std::string traits;
  // The tiles with a revision of the edit, as y * 128 + x, ascending.
  std::vector<std::int16_t> tiles;
  std::size_t points = 0;  // of the path of a batch
};

struct MergeRules {
  // A stroke without a batch since this time has ended.
  std::chrono::system_clock::time_point ended_before;
  // True if the journal may have more edits after the given ones.
  bool is_cut = false;
  // Sequences of states that people have named, ascending. They stay exact.
  std::vector<std::int64_t> named_states;
  // Limits of one merge, so that it locks the journal only for some milliseconds.
  std::size_t max_revisions = 512;
  std::int64_t max_span = 4096;  // from the first to the last sequence
  // Of the path of a merged edit, so that its record stays small enough for the database.
  std::size_t max_points = 16384;
};

struct MergePlan {
  // The plan covers all edits up to this one. Later edits may belong to strokes that continue.
  // 0: the plan covers no edit.
  std::int64_t through = 0;
  // The edits to merge into the last one of their group: at least two, by index, ascending.
  std::vector<std::vector<std::size_t>> groups;
};

// Plans which batches of the ended strokes of a model become one edit each. `edits` are the edits
// of the model after the previous plan, by ascending sequence.
//
// Merging moves the texels of earlier batches to the sequence of the last batch. So two rules limit
// a group:
// - Between its batches, no stroke or other edit of the model ends, and there is no named state. So
//   the model has the same texels at the end of every stroke and edit, and in named states.
// - Between its batches, no other edit writes to tiles that the group has written before. So the
//   order of the revisions of each tile stays the same, and undo restores the same texels.
MergePlan plan_merges(std::span<const PlannedEdit> edits, const MergeRules& rules);

}  // namespace strata::store
