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

// The layers of an open model. Changes block on the database and notify the listeners. Thread-safe.
class Layers {
 public:
  virtual ~Layers() = default;
  virtual std::vector<Layer> all() const = 0;                    // by order
  virtual Result<Layer> find(const std::string& ref) const = 0;  // id or slug
  // Creates a layer. A database layer without a table gets a new table of the same name with
  // `columns`.
  virtual Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>& answer = {},
                               std::vector<Column> columns = {}) = 0;
  // If the update locks the layer, every edit that had begun is durable or refused when the call
  // returns.
  virtual Result<Layer> update(Layer layer,
                               const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // Converts the layer to a wider type, so it can hold larger keys or values. Includes the history.
  // `layer` is the layer as the caller read it. Returns an `invalid` error at `type` for a type to
  // which the layer cannot be widened, and for a computed layer.
  virtual Result<Layer> widen(const Layer& layer, ValueType type,
                              const store::IdempotentResponse<Layer>& answer = {}) = 0;
  // Erases the layer permanently.
  virtual Result<void> erase(LayerId id, const store::IdempotentResponse<>& answer = {}) = 0;
  // Move a layer into the Trash and restore it. Listeners are notified of a restored layer as if it
  // were new.
  virtual Result<void> put_in_trash(LayerId id, const store::IdempotentResponse<>& answer) = 0;
  virtual Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>& answer) = 0;
  // Records that a ComputeEdit of the layer is durable with this sequence. `tables` are the
  // sequences of the tables that its expression read.
  virtual Result<Layer> mark_computed(LayerId id, const std::string& expression,
                                      std::int64_t sequence,
                                      const std::map<TableId, std::int64_t>& tables) = 0;
  // Call after records of a table have changed. Layers that are computed from them become stale,
  // and layers that take their colors from the terms of the table change.
  virtual void records_changed(TableId table_id) = 0;
  // Checks whether a formula for a computed layer can be evaluated in this room, when it also has
  // the layers `planned`. Returns an `invalid` error at `field` in the same cases as
  // bind_for_layer.
  virtual Result<void> check_expression(const Expression& expression, const std::string& field,
                                        Visibility layer,
                                        const std::vector<Layer>& planned) const = 0;
};

// Returns the error for a layer that does not exist or that the role does not see.
tl::unexpected<Error> no_such_layer(const std::string& ref);

}  // namespace strata::room
