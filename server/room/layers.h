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
#include "store/content/idempotent_response.h"

namespace strata {
struct Expression;
}
namespace strata::store {
struct TrashEntry;
struct TrashRestored;
}  // namespace strata::store

namespace strata::room {

// The layers of an open model. Thread-safe. Changes block (database), and listeners are notified of
// them.
class Layers {
 public:
  virtual ~Layers() = default;
  virtual std::vector<Layer> all() const = 0;                    // by order
  virtual Result<Layer> find(const std::string& ref) const = 0;  // id or slug
  // A database layer without a table gets a new table of its own name with `columns`.
  virtual Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>& answer = {},
                               std::vector<Column> columns = {}) = 0;
  // If it locks the layer, every edit that had begun is durable, or refused, when it returns.
  virtual Result<Layer> update(Layer layer,
                               const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // Makes room for larger keys or values, also in the history; `layer` as it was read. Refused
  // (invalid, `type`): a type that it does not widen to, and a computed layer.
  virtual Result<Layer> widen(const Layer& layer, ValueType type,
                              const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // permanent
  virtual Result<void> erase(LayerId id, const store::IdempotentResponse<>& answer = {}) = 0;
  // Move a layer into the Trash and restore it. Listeners are notified of a restored layer as of a
  // new one.
  virtual Result<void> put_in_trash(LayerId id, const store::IdempotentResponse<>& answer) = 0;
  virtual Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>& answer) = 0;
  // Records that a ComputeEdit of the layer is durable with this sequence, and that `tables` are
  // the sequences of the tables that its expression read.
  virtual Result<Layer> mark_computed(LayerId id, const std::string& expression,
                                      std::int64_t sequence,
                                      const std::map<TableId, std::int64_t>& tables) = 0;
  // Called after records of a table have changed: layers that are computed from them are stale, and
  // layers that take their colors from its terms change.
  virtual void records_changed(TableId table_id) = 0;
  // Checks whether a formula for a computed layer can be evaluated here. Refused (invalid at
  // `field`) as by bind_for_layer.
  virtual Result<void> check_expression(const Expression& expression, const std::string& field,
                                        Visibility layer) const = 0;
};

// Returns the error for a layer that does not exist or that the role does not see.
tl::unexpected<Error> no_such_layer(const std::string& ref);

}  // namespace strata::room
