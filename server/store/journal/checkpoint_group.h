#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "domain/layers/tile.h"
#include "store/journal/journal_rewrite.h"
#include "store/pg/pg.h"
#include "store/pg/sql.h"

// What JournalThinner reads and computes before the transaction that makes a checkpoint.
namespace strata::store {

// Edits that stay. The old edits end at sequence $3.
// - Newer edits can still change their state.
// - The content of a layer comes from the newest of its imports and computations. Only their
// records
//   contain its settings, or the recipe of a layer that was made from others.
inline constexpr auto kStays = sql(
    "(coalesce(e.review = 'pending', false) OR coalesce(e.undone_by, 0) > $3 OR coalesce(e.reviewed_by, 0) > $3 "
    "OR (e.op = 'import' AND e.record ? 'recipe') OR (e.op IN ('import', 'compute') AND e.in_force AND NOT EXISTS "
    "(SELECT 1 FROM edits n WHERE n.layer_id = e.layer_id AND n.sequence > e.sequence AND n.sequence <= $3 "
    "AND n.op IN ('import', 'compute') AND n.in_force)))");
// Everything about an edit that can change while the thinner works. The record of a checkpoint
// contains names, which change when an account is deleted.
inline constexpr auto kState = sql(
    "concat_ws('|', e.user_name, e.op, e.in_force, coalesce(e.undone_by, 0), coalesce(e.review, ''), "
    "coalesce(e.reviewed_by, 0), coalesce(e.first_sequence, 0), CASE WHEN e.op = 'checkpoint' THEN e.record::text ELSE '' END)");

// An edit of a group that becomes a checkpoint.
struct GroupEdit {
  std::int64_t sequence = 0;
  Uuid id, stroke;
  std::string user, op;
  Time time, first_time;
  std::int64_t first_sequence = 0;  // 0: neither merged nor a checkpoint
  bool is_effective = true;
  nlohmann::json record;  // of a checkpoint
  nlohmann::json answer;
  std::vector<std::int16_t> tiles;
  std::string state;
};

// Returns nothing if an edit is missing, or must stay now. `through` is the last sequence of the
// old edits.
Result<std::optional<std::vector<GroupEdit>>> read_edits(PgConnection& connection, ModelId model,
                                                         std::int64_t through,
                                                         const PgArray& sequences);

// The edits that replace a group.
struct NewEdits {
  // Sequence of the edit in force, which has the texels of all edits in force.
  std::optional<std::int64_t> written_at;
  // Sequence of the edit that is not in force. It is the last one, and has the other changes.
  std::optional<std::int64_t> rest_at;
};

NewEdits new_edits(const std::vector<GroupEdit>& edits);

// The rows that replace the rows of a group.
struct NewRevisions {
  struct Row {
    TileAddress tile;
    std::int64_t sequence = 0;
    std::vector<std::uint8_t> difference, key;
  };
  std::vector<Row> rows;
  std::vector<PackedSegment> segments;
  std::vector<std::pair<TileAddress, std::int64_t>> old_segments;  // with their first sequence
};

struct JoinedGroup {
  NewRevisions revisions;
  std::set<std::int16_t> tiles;  // of all its edits
  std::int64_t old_rows = 0;
};

constexpr std::size_t kMaxGroupBytes = std::size_t{16} << 20;
// Joins the revisions of the edits, and checks that the result has the same effect. Must run in the
// transaction in which the edits were read. Returns `internal` for damaged rows, and `too_large` if
// the old rows have more than kMaxGroupBytes.
Result<JoinedGroup> join_group(PgConnection& connection, LayerId layer, ValueType type,
                               const std::vector<GroupEdit>& edits, const PgArray& sequences);

}  // namespace strata::store
