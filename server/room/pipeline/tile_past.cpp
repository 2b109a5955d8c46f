#include "room/pipeline/tile_past.h"
#include "store/journal/journal_reads.h"

#include <optional>

namespace strata::room {

Result<TileResolver> resolve_tile(const TileData& current, const TileMask& texels,
                                  const Layer& layer, TileAddress tile, store::Store& store,
                                  const std::function<void(PastRevision&)>& turn) {
  std::optional<TileResolver> resolver;
  STRATA_TRY(store.journal().tile_past(
      layer, tile, [&] { resolver.emplace(current, texels); },
      [&](PastRevision& revision) {
        if (!resolver->is_open()) return false;
        turn(revision);
        resolver->add(revision);
        return resolver->is_open();
      }));
  return std::move(*resolver);
}

}  // namespace strata::room
