#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/pg/pg.h"

// The states of a model that the journal still has after it was thinned (journal_thinner.h). A
// checkpoint of a layer has replaced the states of the layer from its first sequence up to, but not
// including, its own sequence.
namespace strata::store {

// The states nearest to one that the journal no longer has. The journal has both of them.
struct KeptStates {
  std::int64_t before = 0, after = 0;
};
// Returns nothing if the journal has the state of all layers of the model.
Result<std::optional<KeptStates>> kept_around(PgConnection& connection, ModelId model,
                                              std::int64_t sequence);
// All spans of states of a model that the journal no longer has, for lists of many states.
class ThinnedSpans {
 public:
  struct Span {
    KeptStates states;
    Time ended;  // of the edit `states.after`
  };
  static Result<ThinnedSpans> read(PgConnection& connection, ModelId model);
  // Returns nothing if the journal has the state of all layers of the model.
  const Span* around(std::int64_t sequence) const;

 private:
  std::vector<Span> spans_;  // ascending, without overlaps
};
// Return `gone` if the journal no longer has the state of the model, or of the layer.
Result<void> check_kept(PgConnection& connection, ModelId model, std::int64_t sequence);
Result<void> check_kept(PgConnection& connection, LayerId layer, std::int64_t sequence);

}  // namespace strata::store
