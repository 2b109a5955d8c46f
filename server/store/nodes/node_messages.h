#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

class PgConnection;

// A change that another node, or a program that is not a node, has committed. Triggers write the
// messages (db/migrations/000045_node_messages.sql). A message identifies the changed objects, but
// does not contain their data.
struct NodeMessage {
  enum class Kind { records, table, comment, view, snapshot, selection, tool, access, kiosk };
  enum class Event { created, changed, deleted };
  std::int64_t id = 0;
  std::chrono::system_clock::time_point time;
  Kind kind = Kind::records;
  Event event = Event::changed;
  std::optional<ProjectId> project;
  std::optional<ModelId> model;
  std::vector<std::int64_t> subjects;    // ids of tables, comments, …
  std::optional<std::int64_t> sequence;  // of the entry in the journal of the table
  // the author of the change; for `access` the user whose rights changed, or empty for all users
  std::string user;
};

// Reads the messages of other nodes, each once.
//
// The messages about one subject arrive in the order of their changes, because each change locks
// its subject until the commit. Messages about different subjects may arrive in another order:
// their ids become visible when their transactions end. So the reader does not remember the last
// id. It remembers the oldest transaction that was still running, and the ids that it has read of
// this and later transactions.
//
// Not thread-safe. Uses its own connection, which it opens again when it breaks.
class NodeMessages {
 public:
  struct Options {
    // Messages are deleted when their transactions ended this long ago.
    std::chrono::seconds keep{600};
    // After this time without a successful read, messages may be missing. Less than `keep`.
    std::chrono::seconds missed_after{300};
    std::size_t most_at_once = 1000;       // messages that `read` returns
    std::size_t most_unsettled = 100'000;  // ids to remember; with more ids, messages are missed
  };
  NodeMessages(std::string dsn, const Uuid& self, Options options);
  NodeMessages(std::string dsn, const Uuid& self) : NodeMessages(std::move(dsn), self, Options()) {}
  ~NodeMessages();

  struct News {
    std::vector<NodeMessage> messages;  // sorted by id
    // Messages may be missing, so everything must be read again.
    bool missed = false;
    bool more = false;                           // read again immediately
    std::chrono::system_clock::time_point time;  // of the read, by the clock of the database
  };
  // Returns the messages since the last call. The first call returns none, and later calls return
  // messages that were not visible before. The messages of `self` are left out, except after the
  // connection broke. The response to a commit of `self` may have been lost as well then, and no
  // other node reports that change.
  Result<News> read();
  // Returns true if a message may have arrived, and false after `limit`. Blocks.
  Result<bool> wait(std::chrono::milliseconds limit);
  // Returns whether the database answers now. Blocks.
  bool answers();
  // Deletes old messages, at most 10 000. Call it about once a minute.
  Result<void> prune();

 private:
  struct Position {
    // id of a transaction: all earlier ones have ended, and their messages have been read
    std::int64_t from = 0;
    // ids of the messages of this and later transactions, each with its transaction
    std::map<std::int64_t, std::int64_t> read;
    std::chrono::system_clock::time_point time;  // of the last read, by the clock of the database
  };
  Result<PgConnection*> connected();
  Result<News> begin(std::int64_t from, std::chrono::system_clock::time_point now);

  const std::string dsn_;
  const Uuid self_;
  const Options options_;
  std::unique_ptr<PgConnection> connection_;
  bool reconnected_ = false;  // since the last complete read
  std::optional<Position> position_;
  struct Ended {
    std::chrono::steady_clock::time_point when;
    std::int64_t oldest_running;
  };
  std::deque<Ended> ended_;  // which transactions had ended at earlier times
};

}  // namespace strata::store
