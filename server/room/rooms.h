#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "domain/people/role.h"

namespace strata {
class MemoryLedger;
}
namespace strata::render {
class Renderer;
}
namespace strata::store {
class JournalWriter;
class Store;
}  // namespace strata::store
namespace strata::stream {
struct StreamContext;
}

namespace strata::room {

struct EditTimings;
class Room;

struct RoomOptions {
  std::chrono::seconds close_after{60};  // after the last user has left
  // Maximum of unanswered edits of a room. Further edits are refused with `too_many_requests`.
  std::size_t max_waiting_edits = 512;
  std::chrono::milliseconds retry_for{30'000};  // time to retry failed commits
  std::chrono::milliseconds drain_for{40'000};  // longer than the time to retry commits
  // The limit of main memory for open models: geometry, surface maps and layers. 0: 60 % of the
  // memory of the machine or container.
  std::uint64_t memory_bytes = 0;
  // The id of this server as a node of a site (store/nodes/nodes.h). Empty if it is the only one.
  std::optional<Uuid> node{};
  // Whether this node shows models of other nodes to viewers (Rooms::follow).
  bool follows = true;
  // If a model of another node cannot be kept up to date for this time, its viewers are sent to the
  // owner.
  std::chrono::seconds stop_following_after{30};
  // Edits that take longer are logged with the times of their stages. 0: no limit.
  std::chrono::milliseconds slow_after{1000};
};

// Opens rooms on first use, and closes them after the last user has left. A server claims each
// model that it opens (store/nodes/nodes.h). If another node claims the model later, the room is
// closed and its listeners are notified (Listener::moved).
class Rooms {
 public:
  Rooms(store::Store& store, render::Renderer& renderer, const stream::StreamContext& stream,
        RoomOptions options);
  ~Rooms();
  // Loads the model (geometry and layers) if it is not open, and blocks during that time. If memory
  // is exhausted, closes empty rooms first. `seen_by` is the role of the user in the project. The
  // server itself uses owner, which sees everything.
  Result<std::shared_ptr<Room>> open(const std::string& model_ref, Role seen_by);
  // Like `open`, for a caller who only looks at a model that another node has. The room follows the
  // journal of the model: it shows each edit within half a second, as a rule, and refuses edits
  // with `moved`. If this node claims the model later, listeners are notified (Listener::moved).
  // Returns `moved`, with the address of the owner, if this node cannot show the model, for example
  // because it has too little memory. Call only if `may_follow`.
  Result<std::shared_ptr<Room>> follow(const std::string& model_ref, Role seen_by);
  // Returns whether this server shows models of other nodes. False while it drains.
  bool may_follow() const;
  // Returns whether such a room of the model is open, and has been up to date since the node last
  // lost its lease. Does not ask the database.
  bool is_followed(const std::string& model_ref) const;
  // Like `open`, but follows the model if another node has it and this server may do so. For reads
  // of several models, which may belong to different nodes.
  Result<std::shared_ptr<Room>> open_to_read(const std::string& model_ref, Role seen_by);
  // Returns the sequence that the open room of the model shows, also if it follows another node.
  // Returns nothing if the model is not open. Does not ask the database.
  std::optional<std::int64_t> shown_sequence(const std::string& model_ref) const;
  // Calls Layers::records_changed in the open models.
  void records_changed(TableId table_id);
  // Refuses later edits with `conflict` if they would paint one of these keys of the table. Edits
  // that were accepted earlier are durable or undone when the call returns. After an Error, the
  // keys are retired, but edits may not be durable. Blocks.
  Result<void> retire_keys(TableId table_id, std::span<const std::int64_t> keys);
  // Returns when every accepted edit is durable. After an Error, some edits may not be durable;
  // repeat the call. Blocks.
  Result<void> settle();
  // Allows painting these keys, because they have records again.
  void admit_keys(TableId table_id, std::span<const std::int64_t> keys);
  // Call after the model was deleted. Notifies listeners and closes the room.
  void forget(ModelId model_id);
  // Returns the address of another node that has the model, and nothing if this server has it or
  // may open it. Does not query the database if the model is open, or if this is the only server.
  // While this node drains, returns another node for a model that no node has.
  Result<std::optional<std::string>> elsewhere(const std::string& model_ref);
  // Call when this node has lost its lease. The open rooms draw for their participants, but refuse
  // edits, and no edit is acknowledged until `resume` is called. Their listeners are notified
  // (Listener::database_reachable). `open` returns an `unavailable` error, also for an open model,
  // so that new users open it on a node with a lease. Does not wait for the database.
  void suspend();
  // Call when the node has a lease again. Each room is compared with the journal before it accepts
  // edits, and is closed if another node has claimed its model (Listener::moved).
  void resume();
  // The number of open models, with those of other nodes.
  std::size_t open_rooms() const;
  std::size_t followed_models() const;  // the number of open models of other nodes
  // The time since every open model of other nodes showed everything that was in the database. 0 if
  // no such model is open.
  std::chrono::duration<double> follower_lag() const;
  // The models that this server has claimed, with the epochs of their claims (store/nodes/nodes.h).
  struct Claim {
    ModelId model = 0;
    std::int64_t epoch = 0;
  };
  std::vector<Claim> claims() const;
  std::size_t participants() const;  // connections to all rooms
  // The number of open models that this server gave to other servers or lost to them.
  std::uint64_t models_moved() const;
  std::uint64_t memory_bytes_used() const;
  // The memory of open models, and of images that are being added to a model. Thread-safe.
  MemoryLedger& memory();
  // For the metrics of the server. Thread-safe.
  const EditTimings& edit_timings() const;
  const store::JournalWriter& journal() const;
  // Refuses new edits. Returns when every other edit is durable or refused. After `drain_for`,
  // refuses the remaining edits. If the site has several nodes, each room is released as soon as
  // its edits are durable, and its listeners are notified (Listener::moved).
  void drain();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::room
