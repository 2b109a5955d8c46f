#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

class NodeMessages;
class Params;
class Pool;
class PresenceChannel;

// A server process of a site with several nodes.
struct NewNode {
  Uuid id;
  std::string url;  // its address, as in check_node_url
  std::string version, gpu;
};

// The values that a node reports with each renewal.
struct NodeLoad {
  int open_models = 0;
  int participants = 0;
  float processor_share = 0;  // processor cores in use
};

struct Node : NewNode {
  std::chrono::system_clock::time_point started, lease_until;
  bool lives = false;  // its lease has not ended, by the clock of the database
  bool draining = false;
  NodeLoad load;
};

// The models that a node owns, sorted by id. The list is limited, but `total` is not.
struct OwnedModels {
  struct Entry {
    ModelId id = 0;
    std::string name;
  };
  std::vector<Entry> models;
  std::int64_t total = 0;
};
struct Ownership {
  std::chrono::system_clock::time_point now;  // by the clock of the database
  std::map<Uuid, OwnedModels> by_node;        // without nodes that own no model
};

// Accepts an http or https URL with an optional path, of at most 255 characters. Returns it without
// slashes at the end. Other text is `malformed`, also a URL with a user, a query or a fragment.
Result<std::string> check_node_url(const std::string& url);

// Returns the connection string (libpq) with which a node must open its Store. Its sessions in
// PostgreSQL then have the name of the node. So a claim can end them, and the node gets no messages
// about its own changes.
std::string with_sessions_of(const Uuid& node, const std::string& dsn);

// The nodes of a site, and the models that each of them has. A model has one owner and an epoch, a
// number that grows with each claim. A commit of the journal names the epoch in which its room was
// opened (JournalEntry::epoch), so a node that lost a model can never change it.
//
// A node has a lease of `kLease`, which it renews every second. The clock of the database measures
// it. If the lease has ended, other nodes may claim its models. No session locks are used: if the
// database ends a session, its locks are free while their holder still relies on them.
//
// A server without other nodes has no row and no lease. Its claims have no owner. Part of Store,
// whose rules for threads and errors apply.
class Nodes {
 public:
  static constexpr std::chrono::milliseconds kLease{3000};
  static constexpr std::chrono::hours kForgetAfter{1};  // after the end of the lease

  explicit Nodes(Pool& pool);
  ~Nodes();

  // --- The lease of this process. These calls share one connection with short limits, so they
  // neither wait for a busy pool nor for a long statement.
  // Inserts the node, or renews its lease if the database has it already.
  Result<void> join(const NewNode& node);
  // Returns `gone` if the lease has ended or the node was removed. Then the node must suspend its
  // rooms and join again.
  Result<void> renew(const Uuid& node, const NodeLoad& load);
  // Then other nodes may claim the models of the node immediately, and the node may claim no model.
  Result<void> begin_drain(const Uuid& node);
  Result<void> leave(const Uuid& node);  // removes the node; its models have no owner then
  Result<void> forget_ended();           // removes nodes whose lease ended `kForgetAfter` ago

  // Opens the connections of the store again, except the one of the lease. Call it when the node
  // has a lease again, before the database is asked who has the models (Pool::drop_connections).
  void drop_connections();

  // --- Messages between nodes (store/nodes/node_messages.h)
  // Returns a new reader of the messages to `self`.
  std::unique_ptr<NodeMessages> messages(const Uuid& self);
  // Returns a new connection to the channel for presence (store/nodes/presence_channel.h).
  std::unique_ptr<PresenceChannel> presence(const Uuid& self);

  // --- Models
  // Makes `self` the owner of a model, and returns the new epoch. The model must have no owner, or
  // the owner must be `self`, or be draining, or its lease must have ended. Otherwise returns
  // `moved`, with the address of the owner. Returns `unavailable` if `self` has no lease or drains.
  // A node that hangs can keep the row of the model locked, because PostgreSQL waits for the end
  // of its transaction. If the lease of such an owner has ended, ends its sessions that write.
  // PostgreSQL permits this if all nodes use the same role. Returns `busy` if the row stays locked.
  Result<std::int64_t> claim(ModelId model, const std::optional<Uuid>& self);
  // Returns a new epoch without an owner, even if a node has claimed the model. Used by code that
  // writes the journal without a room: a room that is open on any server is closed when it next
  // uses the journal.
  Result<std::int64_t> begin_epoch(ModelId model);
  // Removes the owner of the model, if this epoch is the newest. The epoch does not change.
  Result<void> release(ModelId model, std::int64_t epoch);
  // Returns the owner, if it has a lease and does not drain. `ref` is an id or a slug. Also returns
  // nothing if there is no such model.
  Result<std::optional<Node>> owner_of(const std::string& ref);

  // Returns the address of another node that runs or ran the job, if it has a lease.
  Result<std::optional<std::string>> node_of_job(JobId job, const Uuid& self);

  // Returns all nodes, the longest running first.
  Result<std::vector<Node>> all();
  // Returns the models of each node, at most `most` of each.
  Result<Ownership> ownership(int most);
  // Returns the node with the fewest open models that has a lease, does not drain, and is not
  // `self`.
  Result<std::optional<Node>> another(const Uuid& self);

 private:
  // Sets `asked` when a connection was free.
  Result<std::int64_t> try_claim(ModelId model, const std::optional<Uuid>& self, bool& asked);
  // Ends the sessions of the owner that write, if its lease has ended.
  Result<void> end_sessions_of_owner(ModelId model);
  // Runs a statement on the connection of the lease. Returns the number of affected rows.
  Result<std::int64_t> run(const char* sql, const Params& params);

  Pool& pool_;
  struct LeaseConnection;
  const std::unique_ptr<LeaseConnection> lease_connection_;
};

}  // namespace strata::store
