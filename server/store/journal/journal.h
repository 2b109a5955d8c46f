#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/trace.h"
#include "core/uuid.h"
#include "domain/layers/review.h"
#include "domain/layers/tile.h"

namespace strata::store {

// The sums of one key in one tile, in model space and model units. `moment` is area × position, and
// `low` and `high` are the bounding box of the texels.
struct KeySum {
  std::optional<std::int64_t> key;  // nothing if the layer does not distinguish values
  std::uint64_t texels = 0;
  double area = 0;
  glm::dvec3 moment{0}, low{0}, high{0};
};
struct TileKeys {
  TileAddress tile;
  std::vector<KeySum> keys;  // empty if no texel of the tile is valid
};

// One edit with everything that becomes durable with it, in one transaction.
struct JournalEntry {
  ModelId model_id = 0;
  LayerId layer_id = 0;
  std::int64_t sequence = 0;  // number in the model, from 1, without gaps
  std::int64_t epoch = 0;     // of the claim of the model (store/nodes/nodes.h)
  Uuid id;                    // id of the message; unique per model
  std::string user;           // display name of the author
  Uuid stroke;                // groups the batches of one stroke; equal to `id` for single edits
  // "stroke", "fill", "polygon", "import", "cleanup", "undo", "redo", "restore", "accept",
  // "reject", "reopen"
  std::string op;
  nlohmann::json record;  // the edit as requested
  nlohmann::json answer;  // the response to the caller, also for a later request with the same `id`
  std::chrono::system_clock::time_point time;
  struct Revision {
    TileAddress tile;
    std::vector<std::uint8_t> difference;  // strata::encode_revision
    // strata::encode_tile after the edit, for every 64th revision of a tile; otherwise empty
    std::vector<std::uint8_t> key_tile;
  };
  std::vector<Revision> revisions;
  // Returns the sums of a tile in `revisions` after the edit. Called on the thread of the writer,
  // at each attempt, for tiles that no later edit of the same transaction changes. If empty, the
  // sums are not known, and the sums of the layer must be computed again (Layers::to_sum).
  std::function<std::vector<KeySum>(TileAddress)> sum_tile;
  // for undo, redo and reviews: sequences of edits whose `in_force` becomes false or true
  std::vector<std::int64_t> disable, enable;
  Review review = Review::none;  // review of this edit: none or pending
  struct Reviewed {
    std::vector<std::int64_t> edits;
    Review becomes = Review::pending;
  };
  std::optional<Reviewed> reviewed;  // the decision that the entry makes
  TraceId trace{};                   // of the edit, for the log; not stored
};

// A row of the history of a layer (GET …/edits), which is sorted newest first. A row with the op
// "checkpoint" has no user; its record has the authors of its edits (journal_thinner.h).
struct JournalRow {
  std::int64_t sequence = 0;
  Uuid id, stroke;
  std::string user, op;
  nlohmann::json record, answer;
  std::chrono::system_clock::time_point time;
  bool in_force = true;
  Review review = Review::none;
  struct Reviewer {  // reviewer of an accepted or rejected edit
    std::string user, reason;
    std::chrono::system_clock::time_point time;
  };
  std::optional<Reviewer> reviewer{};
};

// The edits of a layer that wait for review.
struct ReviewQueue {
  struct Stroke {  // a stroke or another edit
    Uuid stroke;
    std::int64_t sequence = 0;  // sequence of the first batch, which identifies the stroke
    std::int64_t last = 0;
    std::string user, op;
    std::chrono::system_clock::time_point begun, time;  // times of the first and the last batch
    std::uint64_t texels = 0;                           // sum over all batches
    double area_m2 = 0;
    nlohmann::json record;  // record of the first batch
  };
  struct Person {
    std::string user;
    std::int64_t strokes = 0;
  };
  std::vector<Stroke> strokes;  // strokes on this page, oldest first
  std::int64_t total = 0;
  std::vector<Person> people;  // users with edits in the whole layer, sorted by name
};

// Selects the edits of a decision: the given edits, the edits of a user, or all edits if neither is
// given.
struct Reviewees {
  std::vector<std::int64_t> edits;
  std::optional<std::string> user;
};
struct UnderReview {
  struct Edit {
    std::int64_t sequence = 0;
    Uuid stroke;
    std::string user;
  };
  std::vector<Edit> edits;  // by ascending sequence
  // The edits that the caller named, in the same order. An edit that was merged is replaced by the
  // merged one.
  std::vector<std::int64_t> named;
};

}  // namespace strata::store
