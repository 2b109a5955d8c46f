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

// What the keys of a table are on the surfaces of its project. Everything here may open rooms, and
// blocks.
namespace strata::app {

struct PaintedLayer {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::map<std::int64_t, query::KeyArea> areas;  // by key
};
// The layers of the table that the role sees. On the others keys may stay behind whose records are
// gone, as after an undo: who deletes a record hears nothing of them, and changes nothing there.
Result<std::vector<PaintedLayer>> painted_layers(const Services& services, TableId table_id,
                                                 Role seen_by);

// Those where one of the keys is painted, as they are named to a person: "12.5 cm² on Units of
// Trench 1"; empty where there are none.
std::string where_painted(const std::vector<PaintedLayer>& layers,
                          const std::vector<std::int64_t>& keys);

// Clears the key's texels on these layers, or gives them to another key: one edit of the author on
// each layer where it is painted, journalled and undone like a fill. None of them where one of the
// layers is locked for the author (403).
Result<void> repaint_key(const Services& services, const std::vector<PaintedLayer>& layers,
                         std::int64_t key, std::optional<std::int64_t> to, const Author& author);

// Makes records of those keys of a database layer that have none but are named in its legend, which
// a map may just have brought: the name goes into the table's first text column. As the user's
// entry in the table's journal, told to who looks. None for a layer that is locked for them (403).
Result<void> records_from_legend(const Services& services, const Layer& layer,
                                 const std::vector<std::int64_t>& keys, const Author& author);
// Refuses (422, `value`) keys of a database layer that have no record.
Result<void> check_keys(store::Store& store, const Layer& layer,
                        const std::vector<std::int64_t>& keys);

}  // namespace strata::app
