#include "store/nodes/nodes.h"

#include <mutex>

#include "core/log.h"
#include "core/no_such.h"
#include "store/nodes/node_messages.h"
#include "store/nodes/presence_channel.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// A longer renewal is useless, because the node no longer relies on its lease after this time.
constexpr PgLimits kLeaseLimits{std::chrono::milliseconds(1500), std::chrono::milliseconds(1500),
                                std::chrono::milliseconds(1000)};

constexpr auto kNodeColumns = sql(
    "n.id, n.url, n.version, n.gpu, n.started, n.lease_until, n.lease_until > clock_timestamp(), n.draining, "
    "n.open_models, n.participants, n.processor_share::float8 ");

Node read_node(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Node node;
  node.id = row.uuid();
  node.url = row.text();
  node.version = row.text();
  node.gpu = row.text();
  node.started = row.time();
  node.lease_until = row.time();
  node.lives = row.boolean();
  node.draining = row.boolean();
  node.load.open_models = static_cast<int>(row.integer());
  node.load.participants = static_cast<int>(row.integer());
  node.load.processor_share = static_cast<float>(row.real());
  return node;
}

// A claim waits this long for the row of the model before it ends the sessions of a dead owner.
constexpr PgLimits kClaimLimits = [] {
  PgLimits limits = kRequestLimits;
  limits.lock = std::chrono::milliseconds(1000);
  return limits;
}();

Result<std::optional<Node>> first_node(const Result<PgResult>& rows) {
  if (!rows) return tl::unexpected(rows.error());
  return rows->rows() == 0 ? std::nullopt : std::optional(read_node(*rows, 0));
}

// The name of a node's sessions in PostgreSQL, before the id of the node. Triggers read the name
// (db/migrations/000045_node_messages.sql).
constexpr const char* kSessionPrefix = "strata-";

// A null node is a server without other nodes.
Params& optional_node(Params& params, const std::optional<Uuid>& node) {
  return params.optional_text(node ? std::optional(to_string(*node)) : std::nullopt);
}

// Returns the reason why a claim changed nothing.
Result<Error> claim_problem(PgConnection& connection, ModelId model,
                            const std::optional<Uuid>& self) {
  Params params;
  params.id(model);
  auto rows = STRATA_TRY(connection.query(
      "SELECT $2::text IS NULL OR EXISTS (SELECT FROM nodes s WHERE s.id = $2::text::uuid "
      "AND s.lease_until > clock_timestamp() AND NOT s.draining), coalesce(n.url, '') "
      "FROM models m LEFT JOIN nodes n ON n.id = m.owner_node WHERE m.id = $1",
      optional_node(params, self)));
  if (rows.rows() == 0) return no_such("model", to_string(model)).value();
  if (!rows.boolean(0, 0))
    return Error{ErrorCode::unavailable, "Node not available",
                 "This node is stopping, or it has lost its connection to the database. Try again.",
                 ""};
  Error error = moved_to(rows.text(0, 1));
  if (!self)
    error.detail =
        "A node of this site has the model, and this server is not a node of the site. Use the "
        "address of the site, or start this server with --node-url.";
  return error;
}

}  // namespace

std::string with_sessions_of(const Uuid& node, const std::string& dsn) {
  // libpq also accepts the plain name of a database, but only if it is alone.
  if (!dsn.empty() && dsn.find('=') == std::string::npos && dsn.find("://") == std::string::npos) {
    std::string quoted;
    for (const char each : dsn) {
      if (each == '\\' || each == '\'') quoted += '\\';
      quoted += each;
    }
    return with_sessions_of(node, "dbname='" + quoted + "'");
  }
  const bool is_url = dsn.starts_with("postgresql://") || dsn.starts_with("postgres://");
  const char* separator = !is_url ? " " : dsn.find('?') == std::string::npos ? "?" : "&";
  return dsn + separator + "application_name=" + kSessionPrefix + to_string(node);
}

struct Nodes::LeaseConnection {
  std::mutex mutex;
  std::optional<PgConnection> connection;
};

Nodes::Nodes(Pool& pool) : pool_(pool), lease_connection_(std::make_unique<LeaseConnection>()) {}
Nodes::~Nodes() = default;

Result<std::int64_t> Nodes::run(const char* sql, const Params& params) {
  const std::lock_guard lock(lease_connection_->mutex);
  auto& connection = lease_connection_->connection;
  if (!connection || !connection->alive()) {
    connection.reset();
    auto fresh = STRATA_TRY(PgConnection::connect(pool_.dsn(), kLeaseLimits));
    connection.emplace(std::move(fresh));
  }
  auto done = STRATA_TRY(connection->query(sql, params));
  return done.affected();
}

Result<void> Nodes::join(const NewNode& node) {
  STRATA_TRY(check_texts({{&node.url, "url"}, {&node.version, "version"}, {&node.gpu, "gpu"}}));
  STRATA_TRY(run(
      "INSERT INTO nodes (id, url, version, gpu, lease_until) "
      "VALUES ($1, $2, left($3, 255), left($4, 255), clock_timestamp() + $5 * interval '1 millisecond') "
      "ON CONFLICT (id) DO UPDATE SET url = excluded.url, version = excluded.version, gpu = excluded.gpu, "
      "lease_until = excluded.lease_until, draining = false",
      Params()
          .uuid(node.id)
          .text(node.url)
          .text(node.version)
          .text(node.gpu)
          .integer(kLease.count())));
  return {};
}

Result<void> Nodes::renew(const Uuid& node, const NodeLoad& load) {
  const auto renewed = STRATA_TRY(
      run("UPDATE nodes SET lease_until = clock_timestamp() + $2 * interval '1 millisecond', "
          "open_models = $3, participants = $4, processor_share = $5 "
          "WHERE id = $1 AND lease_until > clock_timestamp()",
          Params()
              .uuid(node)
              .integer(kLease.count())
              .integer(load.open_models)
              .integer(load.participants)
              .real(load.processor_share)));
  if (renewed > 0) return {};
  return fail(ErrorCode::gone, "Lease is over",
              "This node did not renew its lease in time, so other nodes may have its models.");
}

Result<void> Nodes::begin_drain(const Uuid& node) {
  STRATA_TRY(run("UPDATE nodes SET draining = true WHERE id = $1", Params().uuid(node)));
  return {};
}

Result<void> Nodes::leave(const Uuid& node) {
  STRATA_TRY(run("DELETE FROM nodes WHERE id = $1", Params().uuid(node)));
  return {};
}

Result<void> Nodes::forget_ended() {
  STRATA_TRY(run("DELETE FROM nodes WHERE lease_until < clock_timestamp() - $1 * interval '1 hour'",
                 Params().integer(kForgetAfter.count())));
  return {};
}

Result<std::int64_t> Nodes::claim(ModelId model, const std::optional<Uuid>& self) {
  bool asked = false;
  auto claimed = try_claim(model, self, asked);
  // Without a free connection, the claim is `busy` as well, but nobody has locked the model.
  if (claimed || claimed.error().code != ErrorCode::busy || !asked) return claimed;
  if (auto ended = end_sessions_of_owner(model); !ended) {
    if (ended.error().code == ErrorCode::busy) return claimed;  // no connection was free
    log::warning("nodes: model " + to_string(model) +
                 " is locked, and the sessions of its former owner could not be ended. All nodes "
                 "must use the same role of PostgreSQL: " +
                 ended.error().detail);
    return claimed;
  }
  return try_claim(model, self, asked);
}

void Nodes::drop_connections() { pool_.drop_connections(); }

std::unique_ptr<NodeMessages> Nodes::messages(const Uuid& self) {
  return std::make_unique<NodeMessages>(pool_.dsn(), self);
}

std::unique_ptr<PresenceChannel> Nodes::presence(const Uuid& self) {
  return std::make_unique<PresenceChannel>(pool_.dsn(), self);
}

// After a wait for a concurrent claim, the condition is checked again, so only one of two claims
// for the same reason succeeds.
Result<std::int64_t> Nodes::try_claim(ModelId model, const std::optional<Uuid>& self, bool& asked) {
  return pool_.write_within(kClaimLimits, [&](PgConnection& connection) -> Result<std::int64_t> {
    asked = true;
    // The update below sees the leases at its begin, but may wait for the row of the model. An
    // owner that continues in the meantime cannot join again until this transaction has ended, so
    // it compares its room with the journal after the claim.
    // Both statements compare the lease of the owner with the begin of the transaction, so it
    // cannot end between them.
    STRATA_TRY(
        connection.query("SELECT FROM models m JOIN nodes n ON n.id = m.owner_node "
                         "WHERE m.id = $1 AND n.lease_until <= now() FOR SHARE OF n",
                         Params().id(model)));
    Params params;
    params.id(model);
    auto claimed = STRATA_TRY(connection.query(
        "UPDATE models m SET owner_node = $2::text::uuid, owner_epoch = m.owner_epoch + 1 WHERE m.id = $1 "
        "AND (m.owner_node IS NULL OR m.owner_node = $2::text::uuid OR NOT EXISTS (SELECT FROM nodes n "
        "WHERE n.id = m.owner_node AND n.lease_until > now() AND NOT n.draining)) "
        "AND ($2::text IS NULL OR EXISTS (SELECT FROM nodes s WHERE s.id = $2::text::uuid "
        "AND s.lease_until > clock_timestamp() AND NOT s.draining)) RETURNING m.owner_epoch",
        optional_node(params, self)));
    if (claimed.rows() > 0) return claimed.integer(0, 0);
    auto problem = STRATA_TRY(claim_problem(connection, model, self));
    return tl::unexpected(std::move(problem));
  });
}

Result<void> Nodes::end_sessions_of_owner(ModelId model) {
  auto ended = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query(
        "SELECT count(pg_terminate_backend(a.pid)) FROM models m JOIN nodes n ON n.id = m.owner_node "
        "JOIN pg_stat_activity a ON a.application_name = $2 || n.id::text AND a.datname = current_database() "
        "WHERE m.id = $1 AND n.lease_until <= clock_timestamp() AND a.backend_xid IS NOT NULL",
        Params().id(model).text(kSessionPrefix));
  }));
  if (ended.integer(0, 0) > 0)
    log::warning("nodes: a node whose lease is over kept model " + to_string(model) +
                 " locked; ended its sessions in PostgreSQL");
  return {};
}

Result<std::int64_t> Nodes::begin_epoch(ModelId model) {
  return pool_.write([&](PgConnection& connection) -> Result<std::int64_t> {
    auto begun = STRATA_TRY(connection.query(
        "UPDATE models SET owner_node = NULL, owner_epoch = owner_epoch + 1 WHERE id = $1 RETURNING owner_epoch",
        Params().id(model)));
    if (begun.rows() == 0) return no_such("model", to_string(model));
    return begun.integer(0, 0);
  });
}

Result<void> Nodes::release(ModelId model, std::int64_t epoch) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(connection.query(
        "UPDATE all_models SET owner_node = NULL WHERE id = $1 AND owner_epoch = $2",
        Params().id(model).integer(epoch)));
    return {};
  });
}

Result<std::optional<Node>> Nodes::owner_of(const std::string& ref) {
  if (!check_text(ref, "model")) return std::nullopt;
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<Node>> {
    constexpr auto kOwner = sql(
        "SELECT ", kNodeColumns,
        "FROM models m JOIN nodes n ON n.id = m.owner_node WHERE n.lease_until > clock_timestamp() AND NOT n.draining ");
    if (const auto id = id_of<ModelId>(ref))
      return first_node(connection.query(sql(kOwner, "AND m.id = $1"), Params().id(*id)));
    return first_node(connection.query(sql(kOwner, "AND m.slug = $1"), Params().text(ref)));
  });
}

Result<std::vector<Node>> Nodes::all() {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Node>> {
    auto rows = STRATA_TRY(
        connection.query(sql("SELECT ", kNodeColumns, "FROM nodes n ORDER BY n.started, n.id")));
    std::vector<Node> nodes;
    for (int i = 0; i < rows.rows(); ++i) nodes.push_back(read_node(rows, i));
    return nodes;
  });
}

Result<std::optional<Node>> Nodes::another(const Uuid& self) {
  return pool_.read([&](PgConnection& connection) {
    return first_node(connection.query(
        sql("SELECT ", kNodeColumns,
            "FROM nodes n WHERE n.id <> $1 AND n.lease_until > clock_timestamp() AND NOT n.draining "
            "ORDER BY n.open_models, n.processor_share, n.id LIMIT 1"),
        Params().uuid(self)));
  });
}

}  // namespace strata::store
