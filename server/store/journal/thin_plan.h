#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

// After thinning, a layer has its state at the end of each of these periods (UTC; weeks begin on
// Monday).
enum class Period { day, week, month, year };
std::string_view name(Period period);
std::optional<Period> parse_period(std::string_view text);
// Reads a number and a unit, such as 90d, 26w, 18m or 2y. Returns nothing for other text, and for
// more than 100 years.
std::optional<std::chrono::days> parse_age(std::string_view text);

// An old edit of a model, with the facts that decide whether it can become part of a checkpoint.
struct OldEdit {
  std::int64_t sequence = 0;
  LayerId layer = 0;
  Uuid stroke;
  std::chrono::system_clock::time_point time;
  bool stays = false;         // the edit waits for review, or a newer edit can change its state
  bool is_effective = true;   // it paints, and is in force
  std::size_t revisions = 0;  // tiles that it wrote
  std::size_t answers = 0;    // responses to the batches that were merged into it
};

struct ThinRules {
  Period keep = Period::day;
  // Sequences of states that people have named, ascending. They stay exact.
  std::vector<std::int64_t> named_states;
  // Limits of one checkpoint, so that its transaction is short. They divide a stroke only if it
  // exceeds them. A checkpoint that is cut grows when the plan is made again.
  std::size_t max_edits = 1000;
  std::size_t max_revisions = 2048;
  std::size_t max_answers = 4096;
};

struct ThinPlan {
  // The edits that become a checkpoint, by index, ascending. All edits of a group are edits of one
  // layer, and this layer has no other edit between them.
  std::vector<std::vector<std::size_t>> groups;
  std::int64_t removed = 0;            // edits that the journal no longer has afterwards
  std::int64_t removed_revisions = 0;  // of tiles; an estimate
  bool is_cut = false;                 // a limit has ended a group
};

// Plans which edits become checkpoints. `edits` are the old edits of a model by ascending sequence.
// A group ends, on all layers, at the end of a period, at a named state, and before and after an
// edit that stays. So at these moments, the model has the same texels as before.
ThinPlan plan_thinning(std::span<const OldEdit> edits, const ThinRules& rules);

// Returns how many of the edits to plan together, if the journal has more edits after them: no
// stroke has edits on both sides of this place. If there is no such place, returns all of them.
std::size_t place_between_strokes(std::span<const OldEdit> edits);

}  // namespace strata::store
