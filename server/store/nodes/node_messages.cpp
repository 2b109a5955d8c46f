#include "store/nodes/node_messages.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "store/pg/pg_row.h"

namespace strata::store {
namespace {

using std::chrono::milliseconds;

// The reader tries again every second, so it must not wait long for a database that hangs.
constexpr PgLimits kReaderLimits{milliseconds(5000), milliseconds(5000), milliseconds(2000)};

// After a crash, PostgreSQL can assign transaction ids again that it assigned shortly before
// the crash but did not save. The reader also looks for messages of this number of earlier
// ids.
constexpr std::int64_t kAssignedAgain = 1000;

constexpr std::array<std::string_view, 9> kKinds{
    "records", "table", "comment", "view", "snapshot", "selection", "tool", "access", "kiosk"};
constexpr std::array<std::string_view, 3> kEvents{"created", "changed", "deleted"};

template <class Value, std::size_t Count>
std::optional<Value> named(const std::array<std::string_view, Count>& names,
                           const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Value>(found - names.begin());
}

// Returns nothing for a message of a newer version that this version cannot read.
std::optional<NodeMessage> read_message(const PgResult& rows, int i) {
  PgRow row(rows, i);
  NodeMessage message;
  message.id = row.integer();
  message.time = row.time();
  const auto kind = named<NodeMessage::Kind>(kKinds, row.text());
  const auto event = named<NodeMessage::Event>(kEvents, row.text());
  message.project = row.id<std::optional<ProjectId>>();
  message.model = row.id<std::optional<ModelId>>();
  message.subjects = row.json().get<std::vector<std::int64_t>>();
  message.sequence = row.optional_integer();
  message.user = row.text();
  if (!kind || !event) return std::nullopt;
  message.kind = *kind;
  message.event = *event;
  return message;
}

}  // namespace

NodeMessages::NodeMessages(std::string dsn, const Uuid& self, Options options)
    : dsn_(std::move(dsn)), self_(self), options_(options) {}
NodeMessages::~NodeMessages() = default;

// Listens before it reads, so that it misses no message.
Result<PgConnection*> NodeMessages::connected() {
  if (!connection_ || !connection_->alive()) {
    connection_.reset();
    auto fresh = STRATA_TRY(PgConnection::connect(dsn_, kReaderLimits));
    STRATA_TRY(fresh.script("LISTEN strata_nodes"));
    connection_ = std::make_unique<PgConnection>(std::move(fresh));
    reconnected_ = true;
  }
  return connection_.get();
}

// Starts at the current state. Messages that are already visible are considered read.
Result<NodeMessages::News> NodeMessages::begin(std::int64_t from,
                                               std::chrono::system_clock::time_point now) {
  const bool missed = position_.has_value();
  auto rows = STRATA_TRY(connection_->query("SELECT id, xid FROM node_messages WHERE xid >= $1",
                                            Params().integer(from)));
  Position position{from, {}, now};
  for (int i = 0; i < rows.rows(); ++i) position.read[rows.integer(i, 0)] = rows.integer(i, 1);
  position_ = std::move(position);
  reconnected_ = false;
  return News{{}, missed, false, now};
}

Result<NodeMessages::News> NodeMessages::read() {
  PgConnection& connection = *STRATA_TRY(connected());
  // Run this statement before the messages are read: each transaction that has ended by then is
  // visible to the next statement.
  auto state = STRATA_TRY(connection.query(
      "SELECT pg_snapshot_xmin(pg_current_snapshot())::text::bigint, clock_timestamp(), "
      "pg_snapshot_xmax(pg_current_snapshot())::text::bigint"));
  const std::int64_t oldest_running = state.integer(0, 0), next = state.integer(0, 2);
  const std::int64_t settled = oldest_running - kAssignedAgain;
  const auto now = state.time(0, 1);
  if (ended_.empty() || std::chrono::steady_clock::now() - ended_.back().when >
                            std::min(options_.keep / 10, std::chrono::seconds(60)))
    ended_.push_back({std::chrono::steady_clock::now(), oldest_running});
  if (!position_) return begin(settled, now);
  if (position_->read.size() > options_.most_unsettled) {
    // An old transaction is still running. Skip its messages and the messages of all other running
    // transactions.
    return begin(next, now);
  }
  // The ids decrease if an older state of the database replaced it.
  if (now - position_->time > options_.missed_after || next < position_->from)
    return begin(settled, now);

  PgArray known(oid::kInt8);
  for (const auto& [id, transaction] : position_->read) known.add(id);
  auto rows = STRATA_TRY(connection.query(
      "SELECT m.id, m.time, m.kind, m.event, m.project_id, m.model_id, to_jsonb(m.subject_ids), m.sequence, m.user_name, "
      "m.from_node IS NOT DISTINCT FROM $3, m.xid FROM node_messages m WHERE m.xid >= $1 "
      "AND NOT EXISTS (SELECT FROM unnest($2::bigint[]) AS known (id) WHERE known.id = m.id) ORDER BY m.id LIMIT $4",
      Params()
          .integer(position_->from)
          .array(known)
          .uuid(self_)
          .integer(static_cast<std::int64_t>(options_.most_at_once))));
  News news;
  news.time = now;
  news.more = rows.rows() == static_cast<int>(options_.most_at_once);
  for (int i = 0; i < rows.rows(); ++i) {
    position_->read[rows.integer(i, 0)] = rows.integer(i, 10);
    if (rows.boolean(i, 9) && !reconnected_) continue;
    if (auto message = read_message(rows, i)) news.messages.push_back(std::move(*message));
  }
  position_->time = now;
  if (news.more) return news;
  reconnected_ = false;
  // Forget the ids of messages whose transactions have ended.
  position_->from = std::max(position_->from, settled);
  std::erase_if(position_->read, [&](const auto& entry) { return entry.second < position_->from; });
  return news;
}

Result<bool> NodeMessages::wait(milliseconds limit) {
  return STRATA_TRY(connected())->wait_for_notification(limit);
}

bool NodeMessages::answers() {
  const auto connection = connected();
  return connection && (*connection)->query("SELECT 1", Params()).has_value();
}

// Messages from a restored backup have transaction ids of another database. They are deleted by
// their age.
Result<void> NodeMessages::prune() {
  const auto keep_from = std::chrono::steady_clock::now() - options_.keep;
  std::optional<std::int64_t> ended_before;
  while (!ended_.empty() && ended_.front().when <= keep_from) {
    ended_before = ended_.front().oldest_running;
    ended_.pop_front();
  }
  if (!ended_before) return {};
  PgConnection& connection = *STRATA_TRY(connected());
  STRATA_TRY(connection.query(
      "DELETE FROM node_messages WHERE id IN (SELECT id FROM node_messages WHERE xid < $1 "
      "OR time < clock_timestamp() - interval '1 day' ORDER BY id LIMIT 10000)",
      Params().integer(*ended_before)));
  return {};
}

}  // namespace strata::store
