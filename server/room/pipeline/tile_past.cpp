#include "room/pipeline/tile_past.h"
#include "store/journal/journal_reads.h"

#include <limits>

namespace strata::room {

constexpr int kRevisionsAtOnce = 32;  // limits the part of a tile's history in memory

Result<void> walk_back(TileResolver& resolver, const Layer& layer, TileAddress tile,
                       store::Store& store, const std::function<void(PastRevision&)>& turn) {
  for (std::int64_t newest = std::numeric_limits<std::int64_t>::max(); resolver.is_open();) {
    auto revisions =
        STRATA_TRY(store.journal().tile_history(layer, tile, newest, kRevisionsAtOnce));
    if (revisions.empty()) break;
    for (auto& revision : revisions) {
      turn(revision);
      resolver.add(revision);
    }
    newest = revisions.back().sequence;
  }
  return {};
}

}  // namespace strata::room
