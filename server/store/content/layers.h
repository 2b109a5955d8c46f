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

// Layers of models, among them those that are computed by a formula, which is created and changed
// with them. Part of Store: its rules for threads and errors hold.
class Layers {
 public:
  explicit Layers(Pool& pool) : pool_(pool) {}

  // Those that the role sees, by order; one that it does not see is not found.
  Result<std::vector<Layer>> of_model(ModelId model_id, Role seen_by);
  Result<Layer> find(ModelId model_id, const std::string& ref, Role seen_by);
  // A database layer that names no table gets one of its own name with `columns`.
  Result<Layer> create(Layer layer, const IdempotentResponse<Layer>& answer = {},
                       std::vector<Column> columns = {});
  Result<Layer> update(Layer layer, const IdempotentResponse<Layer>& answer = {});
  // for ever; people's go by the Trash
  Result<void> remove(LayerId id, const IdempotentResponse<>& answer = {});
  // Room for larger keys or values: its content, with all of its history, in a type that it
  // widens_to. Where version equals.
  Result<Layer> widen(const Layer& layer, ValueType type,
                      const IdempotentResponse<Layer>& answer = {});
  // Where the tables stand that the layer's formula reads, by id.
  Result<std::map<TableId, std::int64_t>> table_sequences_of(LayerId layer_id);
  // The layer shows what `expression` is of everything up to these sequences of its model and of
  // tables.
  Result<Layer> set_computed(LayerId layer_id, const std::string& expression, std::int64_t sequence,
                             const std::map<TableId, std::int64_t>& tables);
  // Automatic ones that something which they read has left behind; those computed longest ago come
  // first.
  Result<std::vector<Layer>> to_recompute();
  Result<std::vector<Layer>> of_table(TableId table_id, Role seen_by);
  // Layers whose tiles must be counted anew, since an edit was journalled without their sums.
  Result<std::vector<Layer>> to_sum();
  // What all tiles of the layer hold that hold anything. Nobody may be editing it.
  Result<void> keep_sums(LayerId layer_id, std::vector<TileKeys> tiles);

 private:
  Pool& pool_;
};

}  // namespace strata::store
