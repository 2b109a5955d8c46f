#include "store/nodes/presence_channel.h"

#include <string_view>
#include <utility>

#include "store/pg/pg.h"

namespace strata::store {
namespace {

using std::chrono::milliseconds;

// Nobody needs old presence, so the channel does not wait long for a database that hangs.
constexpr PgLimits kPresenceLimits{milliseconds(2000), milliseconds(2000), milliseconds(1000)};

}  // namespace

PresenceChannel::PresenceChannel(std::string dsn, const Uuid& self)
    : dsn_(std::move(dsn)), self_(self) {}
PresenceChannel::~PresenceChannel() = default;

// A commit of notifications changes no data, so it need not wait for the disk or for a standby. The
// database checks that the name of the channel needs no quotes.
Result<PgConnection*> PresenceChannel::connected() {
  if (!connection_ || !connection_->alive()) {
    connection_.reset();
    auto fresh = STRATA_TRY(PgConnection::connect(dsn_, kPresenceLimits));
    const auto channel = STRATA_TRY(fresh.query("SELECT name FROM presence_channel"));
    if (channel.rows() == 0)
      return fail(ErrorCode::internal, "No channel", "The table presence_channel is empty.");
    STRATA_TRY(fresh.script("SET synchronous_commit = off; LISTEN " + channel.text(0, 0)));
    connection_ = std::make_unique<PgConnection>(std::move(fresh));
  }
  return connection_.get();
}

Result<std::vector<std::string>> PresenceChannel::receive(milliseconds limit) {
  return STRATA_TRY(connected())->notifications(limit);
}

// A session that hangs does not read the queue of notifications. If the queue were full, no
// transaction that notifies could commit, and the triggers of messages between nodes notify as well
// (db/migrations/000045_node_messages.sql). So presence uses only a part of the queue.
Result<bool> PresenceChannel::send(std::span<const std::string> texts) {
  if (texts.empty()) return true;
  PgArray all(oid::kText);
  for (const std::string_view text : texts) all.add(text);
  PgConnection& connection = *STRATA_TRY(connected());
  const auto sent = STRATA_TRY(connection.query(
      "SELECT pg_notify(c.name, t.text) IS NULL FROM presence_channel c, unnest($1::text[]) AS t (text) "
      "WHERE pg_notification_queue_usage() < 0.1 "
      "AND EXISTS (SELECT FROM nodes WHERE id = $2 AND lease_until > clock_timestamp())",
      Params().array(all).uuid(self_)));
  if (sent.rows() > 0) return true;
  const auto queue = STRATA_TRY(connection.query("SELECT pg_notification_queue_usage() < 0.1"));
  if (queue.boolean(0, 0)) return false;
  return fail(ErrorCode::busy, "Database busy",
              "A session of PostgreSQL does not read its notifications, so many are waiting.");
}

void PresenceChannel::disconnect() { connection_.reset(); }

}  // namespace strata::store
