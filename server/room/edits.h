#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/tile_mirror.h"

namespace strata::room {

struct EditAnswer;
struct EditRequest;

// `applied`: the edit is visible; `saved`: it is durable or has failed.
using Applied = std::function<void(const EditAnswer&)>;
using Saved = std::function<void(Result<EditAnswer>)>;

// The newest state that a picture can show `at`, and, for layers with texels that wait for review,
// these texels (room/pipeline/provisional.h).
struct DurableState {
  std::int64_t sequence = 0;
  std::map<LayerId, TileMap> provisional;
};

// The edits of an open model, in one order. Thread-safe; callbacks run on the room's strand.
class Edits {
 public:
  virtual ~Edits() = default;
  // `applied` may be empty; `saved` is called exactly once. Edits beyond the limit of waiting edits
  // are refused at once, on the calling thread.
  virtual void submit(EditRequest request, Applied applied, Saved saved) = 0;
  virtual std::int64_t sequence() const = 0;
  virtual std::int64_t durable_sequence() const = 0;
  virtual DurableState durable_state() const = 0;
  // Counts all tiles of a layer for the journal's sums (store::Layers::keep_sums). Edits wait
  // during the count. Blocks.
  virtual Result<void> keep_sums(LayerId layer_id) = 0;
};

}  // namespace strata::room
