#pragma once

#include <map>
#include <memory>
#include <vector>

#include "app/services.h"
#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "query/statistics/key_areas.h"
#include "room/room.h"
#include "store/store.h"

// The texels with keys of a table, on all models of its project. All functions may open rooms and
// may block.
namespace strata::app {

struct PaintedLayer {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::map<std::int64_t, query::KeyArea> areas;  // areas by key
};
// Returns the table's layers that the role can see. Keys of deleted records may remain on the other
// layers, as after an undo. A user who deletes a record can neither see nor change these layers.
Result<std::vector<PaintedLayer>> painted_layers(const Services& services, TableId table_id,
                                                 Role seen_by);

// Describes the layers where one of the keys is painted, such as "12.5 cm² on Units of Trench 1".
// Returns an empty text if no texel has these keys.
std::string where_painted(const std::vector<PaintedLayer>& layers,
                          const std::vector<std::int64_t>& keys);

// Clears the texels with the key on these layers, or sets them to another key. On each layer with
// such texels, this is one edit of the author, which the author can undo like a fill. Changes
// nothing if one of the layers is locked for the author (403).
Result<void> repaint_key(const Services& services, const std::vector<PaintedLayer>& layers,
                         std::int64_t key, std::optional<std::int64_t> to, const Author& author);

// Creates records for keys of a database layer that have a name in the legend, but no record, for
// example after painting a new map. The first text column of the table gets the name. Adds one
// entry of the user to the journal of the table, and notifies participants. Refuses a locked layer
// (403).
Result<void> records_from_legend(const Services& services, const Layer& layer,
                                 const std::vector<std::int64_t>& keys, const Author& author);
// Refuses (422, `value`) keys of a database layer that have no record.
Result<void> check_keys(store::Store& store, const Layer& layer,
                        const std::vector<std::int64_t>& keys);

}  // namespace strata::app
