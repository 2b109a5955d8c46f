#pragma once

#include "core/error.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "room/rooms.h"
#include "store/nodes/node_messages.h"
#include "store/store.h"

namespace strata::net {

class Authenticator;

// Sends the changes of other nodes to the users of this node, like the changes of this node. Reads
// the subject of each message, so each user receives only what the user's role can see now.
class NodeEvents {
 public:
  // All arguments must outlive the object.
  NodeEvents(store::Store& store, room::Rooms& rooms, Authenticator& auth, LiveSockets& sockets,
             const TableEvents& tables)
      : store_(store), rooms_(rooms), auth_(auth), sockets_(sockets), tables_(tables) {}

  // Returns an error if the subject cannot be read. Does nothing if it no longer exists. Blocks.
  Result<void> receive(const store::NodeMessage& message);
  // Makes all clients of this node connect again and read everything again. Returns an error, and
  // closes no connection, if the tables cannot be listed. Blocks.
  Result<void> start_over();

 private:
  Result<void> receive_records(const store::NodeMessage& message, TableId table);
  Result<void> receive_table(const store::NodeMessage& message, TableId table);
  Result<void> receive_comment(const store::NodeMessage& message, CommentId comment);
  Result<void> receive_tool(const store::NodeMessage& message, ToolId tool);
  // Returns an error if the rights of a connected user cannot be read.
  Result<void> check_access(const std::string& user);

  store::Store& store_;
  room::Rooms& rooms_;
  Authenticator& auth_;
  LiveSockets& sockets_;
  const TableEvents& tables_;
};

}  // namespace strata::net
