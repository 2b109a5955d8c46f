#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"

namespace strata {
class MemoryLedger;
}
namespace strata::render {
class Renderer;
}
namespace strata::store {
class Store;
}
namespace strata::stream {
struct StreamContext;
}

namespace strata::room {

class Room;

struct RoomOptions {
  std::chrono::seconds close_after{60};  // after the last user left
  // of a room, not yet answered; more are refused (too_many_requests)
  std::size_t max_waiting_edits = 512;
  std::chrono::milliseconds retry_for{30'000};  // for failed commits
  std::chrono::milliseconds drain_for{40'000};  // longer than commits are retried
  // Limit of the main memory of open models: geometry, surface maps, layers. 0: 60 % of the
  // machine's or the container's memory.
  std::uint64_t memory_bytes = 0;
};

// Opens rooms on first use and closes them after the last user left.
class Rooms {
 public:
  Rooms(store::Store& store, render::Renderer& renderer, const stream::StreamContext& stream,
        RoomOptions options);
  ~Rooms();
  // Blocks: loads the model (geometry and layers) if it is not open. If memory is exhausted, closes
  // empty rooms first. `seen_by`: the user's role in the project; the server itself uses owner,
  // which sees everything.
  Result<std::shared_ptr<Room>> open(const std::string& model_ref, Role seen_by);
  // in the open models (Layers::records_changed)
  void records_changed(TableId table_id);
  // From now on, edits that would paint the key of the table are refused (conflict). Edits accepted
  // before are durable when it returns; after an Error this is uncertain, but the key is retired.
  // Blocks.
  Result<void> retire_key(TableId table_id, std::int64_t key);
  // Returns when every accepted edit is durable. After an Error this is uncertain, and the call may
  // be repeated. Blocks.
  Result<void> settle();
  // the keys have records again
  void admit_keys(TableId table_id, std::span<const std::int64_t> keys);
  void forget(ModelId model_id);  // the model was deleted: notifies listeners and closes the room
  std::size_t open_rooms() const;
  std::uint64_t memory_bytes_used() const;
  // of open models, and of pictures that are being added to one; thread-safe
  MemoryLedger& memory();
  // Refuses new edits, and returns when every other edit is durable or refused, after `drain_for`
  // at the latest: then refuses the rest.
  void drain();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::room
