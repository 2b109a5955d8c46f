#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/layers/value_type.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "store/content/idempotent_response.h"
#include "store/journal/journal.h"

namespace strata::store {

class Pool;

// Layers of models. Computed layers are created and changed together with their formulas. Part of
// Store, whose rules for threads and errors apply.
class Layers {
 public:
  explicit Layers(Pool& pool) : pool_(pool) {}

  // Returns the layers that the role sees, sorted by their order. A layer that the role does not
  // see is `not_found`.
  Result<std::vector<Layer>> of_model(ModelId model_id, Role seen_by);
  Result<Layer> find(ModelId model_id, const std::string& ref, Role seen_by);
  // Creates a layer. A layer of records without a table gets a new table with the name of the layer
  // and with `columns`.
  Result<Layer> create(Layer layer, const IdempotentResponse<Layer>& answer = {},
                       std::vector<Column> columns = {});
  Result<Layer> update(Layer layer, const IdempotentResponse<Layer>& answer = {});
  // Deletes the layer permanently. Users move it to the Trash instead.
  Result<void> remove(LayerId id, const IdempotentResponse<>& answer = {});
  // Converts the content and its whole history to a type for larger keys or values, if
  // `layer.version` is the current version. `widens_to` must allow the conversion.
  Result<Layer> widen(const Layer& layer, ValueType type,
                      const IdempotentResponse<Layer>& answer = {});
  // Returns the current sequences, by id, of the tables that the formula of the layer reads.
  Result<std::map<TableId, std::int64_t>> table_sequences_of(LayerId layer_id);
  // Records that the layer contains the value of `expression`, computed from the state after these
  // sequences of its model and of tables.
  Result<Layer> set_computed(LayerId layer_id, const std::string& expression, std::int64_t sequence,
                             const std::map<TableId, std::int64_t>& tables);
  // Returns the automatic layers with inputs that are newer than the layer. The layers that were
  // computed longest ago are first.
  Result<std::vector<Layer>> to_recompute();
  Result<std::vector<Layer>> of_table(TableId table_id, Role seen_by);
  // Returns the layers whose sums must be computed again, because an edit was stored without the
  // sums of its tiles.
  Result<std::vector<Layer>> to_sum();
  // Stores the sums of each tile of the layer that contains values. The layer must not be edited
  // during this call.
  Result<void> keep_sums(LayerId layer_id, std::vector<TileKeys> tiles);

 private:
  Pool& pool_;
};

}  // namespace strata::store
