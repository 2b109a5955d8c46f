#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/visibility.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "store/content/idempotent_response.h"
#include "store/content/trash.h"

namespace strata::room {

// The layers of an open model. Thread-safe. Changes block (database) and are announced to the
// listeners.
class Layers {
 public:
  virtual ~Layers() = default;
  virtual std::vector<Layer> all() const = 0;                    // by order
  virtual Result<Layer> find(const std::string& ref) const = 0;  // id or slug
  // A database layer that names no table gets one of its own name with `columns`.
  virtual Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>& answer = {},
                               std::vector<Column> columns = {}) = 0;
  // Of a layer that it locks every edit that had begun is durable, or refused, when it returns.
  virtual Result<Layer> update(Layer layer,
                               const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // The layer with room for larger keys or values, its history too; `layer` as it was read. Refused
  // (invalid, `type`): a type that it does not widen to, and a computed layer.
  virtual Result<Layer> widen(const Layer& layer, ValueType type,
                              const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // for ever
  virtual Result<void> erase(LayerId id, const store::IdempotentResponse<>& answer = {}) = 0;
  // Into the trash, and out of it: who restored layers hear of is one that is made.
  virtual Result<void> put_in_trash(LayerId id, const store::IdempotentResponse<>& answer) = 0;
  virtual Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>& answer) = 0;
  // A ComputeEdit of the layer was durable with this sequence, and the tables that its expression
  // reads stood there before it.
  virtual Result<Layer> mark_computed(LayerId id, const std::string& expression,
                                      std::int64_t sequence,
                                      const std::map<TableId, std::int64_t>& tables) = 0;
  // Records of a table have changed: layers that are computed from them are stale, those that take
  // their colours from its terms others.
  virtual void records_changed(TableId table_id) = 0;
  // Whether a formula for a computed layer can be evaluated here. Refused (invalid at `field`) as
  // by bind_for_layer.
  virtual Result<void> check_expression(const Expression& expression, const std::string& field,
                                        Visibility layer) const = 0;
};

// The answer for a layer that is not there, and for one that somebody does not see.
tl::unexpected<Error> no_such_layer(const std::string& ref);

}  // namespace strata::room
