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

// `applied` is called when the edit is visible. `saved` is called when it is durable or has failed.
using Applied = std::function<void(const EditAnswer&)>;
using Saved = std::function<void(Result<EditAnswer>)>;

// The newest state that an image can show, for use as `at`. For layers with texels that wait for
// review, it also contains these texels (room/pipeline/provisional.h).
struct DurableState {
  std::int64_t sequence = 0;
  std::map<LayerId, TileMap> provisional;
};

// The edits of an open model, in one order. Thread-safe. Callbacks run on the strand of the room.
class Edits {
 public:
  virtual ~Edits() = default;
  // `applied` may be empty. `saved` is called exactly once. If too many edits are waiting, the edit
  // is refused immediately, on the calling thread.
  virtual void submit(EditRequest request, Applied applied, Saved saved) = 0;
  virtual std::int64_t sequence() const = 0;
  virtual std::int64_t durable_sequence() const = 0;
  virtual DurableState durable_state() const = 0;
  // Computes the sums of all tiles of a layer for the journal (store::Layers::keep_sums). Edits
  // wait during the computation. Blocks.
  virtual Result<void> keep_sums(LayerId layer_id) = 0;
};

}  // namespace strata::room
