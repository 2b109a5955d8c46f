#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/uuid.h"

namespace strata::store {

class PgConnection;

// Carries the presence of people between the nodes of a site (room/presence_exchange.h). Uses
// NOTIFY without a table, because presence is never stored: the next text replaces one that was
// lost. The name of the PostgreSQL channel is a secret of the site, so that other roles of the
// database, such as those of analysts, can neither read nor send presence
// (db/migrations/000051_presence_channel.sql). Uses its own connection with short limits, which it
// opens again when it breaks. Not thread-safe.
class PresenceChannel {
 public:
  static constexpr std::size_t kMaxBytes = 7900;  // of a text. PostgreSQL refuses 8000

  PresenceChannel(std::string dsn, const Uuid& self);
  ~PresenceChannel();

  // Returns the texts that have arrived, in the order in which they were sent, also those of this
  // node. Returns nothing if none arrives within `limit`. Blocks.
  Result<std::vector<std::string>> receive(std::chrono::milliseconds limit);
  // Sends texts of at most kMaxBytes. They arrive without texts of other nodes between them.
  // Returns false, and sends nothing, if the lease of this node has ended. Returns `busy`, and
  // sends nothing, if a session does not read its notifications. Blocks.
  Result<bool> send(std::span<const std::string> texts);
  void disconnect();  // the next call opens another connection

 private:
  Result<PgConnection*> connected();

  const std::string dsn_;
  const Uuid self_;
  std::unique_ptr<PgConnection> connection_;
};

}  // namespace strata::store
