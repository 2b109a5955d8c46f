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
  std::chrono::milliseconds retry_for{30'000};  // commits that fail
  std::chrono::milliseconds drain_for{40'000};  // longer than commits are retried
  // Budget of what open models hold in main memory: geometry, surface maps, layers. 0: 60 % of the
  // machine's or the container's.
  std::uint64_t memory_bytes = 0;
};

// Opens rooms on first use and closes them after the last user left.
class Rooms {
 public:
  Rooms(store::Store& store, render::Renderer& renderer, const stream::StreamContext& stream,
        RoomOptions options);
  ~Rooms();
  // Blocking: loads the model (geometry and layers) when it is not open. Where memory is used up,
  // rooms that nobody is in are closed for it. `seen_by`: what they may do in the project; the
  // server itself sees all, as its owner.
  Result<std::shared_ptr<Room>> open(const std::string& model_ref, Role seen_by);
  // in the models that are open (Room::records_changed)
  void records_changed(TableId table_id);
  // From now on edits that would paint the key of the table are refused (conflict). Those that were
  // let in are durable when it returns; of an Error this is not known, and the key is retired all
  // the same. Blocks.
  Result<void> retire_key(TableId table_id, std::int64_t key);
  // Returns when every edit that was let in is durable. Of an Error this is not known, and to ask
  // again is right. Blocks.
  Result<void> settle();
  // they have records again
  void admit_keys(TableId table_id, std::span<const std::int64_t> keys);
  void forget(ModelId model_id);  // the model was deleted: members are told, the room closes
  std::size_t open_rooms() const;
  std::uint64_t memory_bytes_used() const;
  // of what open models, and pictures on their way to one, hold; thread-safe
  MemoryLedger& memory();
  // Refuses new edits, and returns when every other is durable or refused, after `drain_for` at the
  // latest: then what still waits is refused.
  void drain();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::room
