#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/tile.h"
#include "store/journal/merge_plan.h"

namespace strata::store {

class Journal;
class PgConnection;

// Makes the journal of a model smaller after strokes have ended, without a change of its meaning:
// - It merges the batches of a stroke into one edit, with one revision for each tile
//   (merge_plan.h).
// - It packs the revisions of each tile into segments (domain/layers/tile_segment.h).
//
// Each step is one short transaction that replaces rows. It compares the epoch of the model
// (store/nodes/nodes.h), so a server that has lost the model changes nothing. The commits do not
// wait for the disk: if a transaction is lost, its rows do not change. Used by one thread at a
// time. Damaged rows do not change, and the log names them.
class JournalMerger {
 public:
  static constexpr std::chrono::seconds kEndedAfter{60};
  static constexpr int kRevisionsPerSegment = 32;
  // A node that has checked the database before the mark joins the site within this time.
  static constexpr std::chrono::seconds kJoinsWithin{60};

  // Called between transactions. It may wait. If it returns false, the merger stops.
  using Continue = std::function<bool()>;

  // Reads up to `edits_at_once` edits of a model and plans their merges together.
  explicit JournalMerger(Journal& journal, std::size_t edits_at_once = 20'000)
      : journal_(journal), edits_at_once_(edits_at_once) {}

  // Returns whether the journal may be merged. Programs before this one cannot read the result, so
  // it first marks the database, and returns false until `after_mark` has passed. It also returns
  // false while the database has a node with another version, even if its lease is over: a node
  // that was paused joins again without another check of the database.
  Result<bool> may_merge(std::string_view version,
                         std::chrono::milliseconds after_mark = kJoinsWithin);

  struct Done {
    std::int64_t edits = 0;      // edits that were merged into others
    std::int64_t revisions = 0;  // revisions that were merged or packed
    bool more = false;           // more edits can be merged now
  };
  // Merges strokes that ended before the time, and packs the tiles that they wrote. `epoch` is the
  // epoch of this server's claim. Returns `moved` if another server has claimed the model.
  Result<Done> merge(ModelId model, std::int64_t epoch,
                     std::chrono::system_clock::time_point ended_before, const Continue& go_on);

 private:
  struct Claim {
    ModelId model = 0;
    std::int64_t epoch = 0;
  };
  struct Window {
    std::vector<PlannedEdit> edits;
    MergeRules rules;
  };
  Result<Window> read_window(ModelId model, std::chrono::system_clock::time_point ended_before);
  // Returns the number of revisions that it replaced; nothing if the edits do not change.
  Result<std::optional<std::int64_t>> merge_group(const Claim& claim, LayerId layer,
                                                  const std::vector<std::int64_t>& sequences);
  Result<bool> list_tiles(const Claim& claim, const Window& window, std::int64_t through,
                          const Continue& go_on);
  Result<void> advance(const Claim& claim, std::int64_t through);
  Result<std::int64_t> pack_layer(const Claim& claim, LayerId layer, std::int64_t through,
                                  const Continue& go_on);
  Result<std::int64_t> pack_tiles(const Claim& claim, LayerId layer, std::int64_t through,
                                  const std::vector<TileAddress>& tiles);

  Journal& journal_;
  const std::size_t edits_at_once_;
  // Revisions of each layer since its tiles were last counted. No entry: they were never counted.
  std::map<LayerId, std::size_t> since_packed_;
  // Tiles with damaged revisions. They stay as they are, and the log has one line about each.
  std::map<LayerId, std::set<TileAddress>> unpackable_;
};

}  // namespace strata::store
