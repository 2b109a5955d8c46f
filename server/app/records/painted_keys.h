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

// The texels of a table's keys on the models of its project. All functions may open rooms and
// block.
namespace strata::app {

struct PaintedLayer {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::map<std::int64_t, query::KeyArea> areas;  // by key
};
// Returns the table's layers that the role sees. On the others, keys of deleted records may remain,
// as after an undo: the user who deletes a record does not see and does not change them.
Result<std::vector<PaintedLayer>> painted_layers(const Services& services, TableId table_id,
                                                 Role seen_by);

// Describes the layers where one of the keys is painted, such as "12.5 cm² on Units of Trench 1";
// empty if no texel has these keys.
std::string where_painted(const std::vector<PaintedLayer>& layers,
                          const std::vector<std::int64_t>& keys);

// Clears the key's texels on these layers, or sets them to another key: one edit of the author on
// each layer where it is painted, in the journal like a fill, with undo. Changes nothing if one
// of the layers is locked for the author (403).
Result<void> repaint_key(const Services& services, const std::vector<PaintedLayer>& layers,
                         std::int64_t key, std::optional<std::int64_t> to, const Author& author);

// Makes records for keys of a database layer that have none but are named in its legend, for
// example by a new map: the table's first text column gets the name. This is the user's entry in
// the table's journal, and participants are notified. Refuses a locked layer (403).
Result<void> records_from_legend(const Services& services, const Layer& layer,
                                 const std::vector<std::int64_t>& keys, const Author& author);
// Refuses (422, `value`) keys of a database layer that have no record.
Result<void> check_keys(store::Store& store, const Layer& layer,
                        const std::vector<std::int64_t>& keys);

}  // namespace strata::app
