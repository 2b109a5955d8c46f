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
// Store: its rules for threads and errors hold.
class Layers {
 public:
  explicit Layers(Pool& pool) : pool_(pool) {}

  // Returns the layers that the role sees, by order; a layer that it does not see is not_found.
  Result<std::vector<Layer>> of_model(ModelId model_id, Role seen_by);
  Result<Layer> find(ModelId model_id, const std::string& ref, Role seen_by);
  // A database layer without a table gets a new table of its own name with `columns`.
  Result<Layer> create(Layer layer, const IdempotentResponse<Layer>& answer = {},
                       std::vector<Column> columns = {});
  Result<Layer> update(Layer layer, const IdempotentResponse<Layer>& answer = {});
  // permanent; deletion by users goes through the Trash
  Result<void> remove(LayerId id, const IdempotentResponse<>& answer = {});
  // Makes room for larger keys or values: converts the content and its whole history to a type that
  // the layer's type widens_to, if the version equals.
  Result<Layer> widen(const Layer& layer, ValueType type,
                      const IdempotentResponse<Layer>& answer = {});
  // Returns the current sequences, by id, of the tables that the layer's formula reads.
  Result<std::map<TableId, std::int64_t>> table_sequences_of(LayerId layer_id);
  // Records that the layer shows the value of `expression`, computed from everything up to these
  // sequences of its model and of tables.
  Result<Layer> set_computed(LayerId layer_id, const std::string& expression, std::int64_t sequence,
                             const std::map<TableId, std::int64_t>& tables);
  // Returns automatic layers whose inputs are newer than they are, those computed longest ago
  // first.
  Result<std::vector<Layer>> to_recompute();
  Result<std::vector<Layer>> of_table(TableId table_id, Role seen_by);
  // Returns layers whose tiles must be counted again, because an edit was journaled without their
  // sums.
  Result<std::vector<Layer>> to_sum();
  // Stores the sums of all tiles of the layer that hold a value. The layer must not be edited
  // during this call.
  Result<void> keep_sums(LayerId layer_id, std::vector<TileKeys> tiles);

 private:
  Pool& pool_;
};

}  // namespace strata::store
