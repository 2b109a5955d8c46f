#include "store/pg/pg.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace strata::store {
namespace {

std::string one_line(std::string_view message) {
  std::string out(message.substr(0, 400));
  std::replace(out.begin(), out.end(), '\n', ' ');
  while (!out.empty() && (out.back() == ' ' || out.back() == '.')) out.pop_back();
  return out;
}

bool starts_with_any(std::string_view sqlstate, std::initializer_list<std::string_view> prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](auto p) { return sqlstate.starts_with(p); });
}

constexpr const char* kConnectionLost = "08006";
constexpr std::chrono::milliseconds kConnectFor{5000};

// PostgreSQL only warns about a canceled wait, and the COMMIT succeeds. Warnings are translated, so
// this warning is recognized by the function that sends it.
void note_canceled_wait(void* canceled, const PGresult* notice) {
  const char* function = PQresultErrorField(notice, PG_DIAG_SOURCE_FUNCTION);
  if (function && std::string_view(function) == "SyncRepWaitForLSN")
    *static_cast<bool*>(canceled) = true;
}

Error unknown_outcome(Error lost) {
  lost.title = "Result unknown";
  lost.detail =
      "The database did not confirm the change, so it is not known whether it was saved. Check "
      "before you repeat it. A repeat with the same Idempotency-Key is safe.";
  return lost;
}

}  // namespace

Error unavailable(std::string_view why) {
  return {ErrorCode::unavailable, "Database unavailable",
          "PostgreSQL does not answer (" + one_line(why) +
              "). This request changed nothing. Try again.",
          ""};
}

Error problem_of(std::string_view sqlstate, std::string_view message) {
  const std::string what = one_line(message);
  if (sqlstate.empty() || starts_with_any(sqlstate, {"08", "57P"})) return unavailable(message);
  if (sqlstate == "53100")
    return {ErrorCode::storage_full, "Disk full",
            "The database's disk is full (" + what +
                "). Nothing changed. Ask an administrator to free disk space.",
            ""};
  if (sqlstate.starts_with("53"))
    return {ErrorCode::busy, "Database overloaded",
            "PostgreSQL is out of resources (" + what + "). Try again shortly.", ""};
  if (sqlstate == "23505")
    return {
        ErrorCode::conflict, "Already exists",
        "Something with this name or id already exists (" + what + "). Choose another name or id.",
        ""};
  if (sqlstate == "23503")
    return {
        ErrorCode::conflict, "Conflict",
        "The request refers to something that does not exist, or deletes something that is still "
        "in use (" +
            what + ").",
        ""};
  if (sqlstate.starts_with("23"))
    return {ErrorCode::conflict, "Conflict", "The database rejected these values (" + what + ").",
            ""};
  if (sqlstate == "22021" || sqlstate == "22P05")
    return {ErrorCode::malformed, "Text cannot be stored",
            "Text must be UTF-8 without the character U+0000.", ""};
  if (starts_with_any(sqlstate, {"22", "54"}))
    return {ErrorCode::malformed, "Value cannot be stored",
            "The database cannot store a value (" + what + ").", ""};
  if (starts_with_any(sqlstate, {"40", "55P03", "57014", "25006"}))
    return {ErrorCode::busy, "Database busy",
            "PostgreSQL cannot complete the request at the moment (" + what + "). Try again.", ""};
  if (sqlstate.starts_with("58"))
    return {ErrorCode::unavailable, "Database unavailable",
            "PostgreSQL cannot read or write its files (" + what + "). Check its disk.", ""};
  return {ErrorCode::internal, "Database error",
          "PostgreSQL reported " + std::string(sqlstate) + ": " + what + ".", ""};
}

bool is_transient(std::string_view sqlstate) {
  return !starts_with_any(sqlstate, {"22", "23", "42", "0A", "54"});
}

Result<PgConnection> PgConnection::connect(const std::string& dsn, const PgLimits& limits) {
  // libpq takes whole seconds, and uses 2 in place of 1. Settings in the DSN are later in the list
  // and take precedence.
  const auto patience =
      std::chrono::ceil<std::chrono::seconds>(std::min(limits.answer, kConnectFor));
  const std::string connect_timeout = std::to_string(std::max<std::int64_t>(patience.count(), 2));
  const char* keys[] = {"connect_timeout",  "tcp_user_timeout", "keepalives_idle",
                        "application_name", "dbname",           nullptr};
  const char* values[] = {connect_timeout.c_str(), "30000", "30", "strata", dsn.c_str(), nullptr};
  PgConnection connection(PQconnectdbParams(keys, values, 1));
  PGconn* raw = connection.connection_.get();
  if (!raw) return tl::unexpected(unavailable("out of memory"));
  if (PQstatus(raw) != CONNECTION_OK || PQsetnonblocking(raw, 1) != 0)
    return tl::unexpected(unavailable(PQerrorMessage(raw)));
  PQsetNoticeReceiver(raw, note_canceled_wait, connection.wait_was_canceled_.get());
  connection.limits_ = {std::min(limits.answer, kConnectFor), {}, {}};
  // The last five settings end the session of a client whose machine or network has failed, and
  // release its locks. Otherwise they would last for hours, until the network of PostgreSQL closes
  // the connection.
  STRATA_TRY(connection.script(
      "SET synchronous_commit = on; SET client_min_messages = warning; "
      "SET client_encoding = 'UTF8'; SET jit = off; "
      "SET idle_in_transaction_session_timeout = '60s'; SET tcp_keepalives_idle = 3; "
      "SET tcp_keepalives_interval = 1; SET tcp_keepalives_count = 3; SET tcp_user_timeout = '6s'"));
  // This setting ends a session, and releases its locks, when its client has disconnected. Not
  // every system supports it.
  if (PQserverVersion(raw) >= 140000)
    (void)connection.script("SET client_connection_check_interval = '2s'");
  STRATA_TRY(connection.set_limits(limits));
  return connection;
}

Result<void> PgConnection::set_limits(const PgLimits& limits) {
  if (limits == limits_) return {};
  if (limits.statement != limits_.statement || limits.lock != limits_.lock) {
    STRATA_TRY(script("SET statement_timeout = " + std::to_string(limits.statement.count()) +
                      "; SET lock_timeout = " + std::to_string(limits.lock.count())));
  }
  limits_ = limits;
  return {};
}

bool PgConnection::alive() {
  PGconn* raw = connection_.get();
  return raw && PQstatus(raw) == CONNECTION_OK && PQconsumeInput(raw) == 1 &&
         PQstatus(raw) == CONNECTION_OK && PQtransactionStatus(raw) == PQTRANS_IDLE;
}

void PgConnection::close(std::string reason) {
  // Shut the socket down first, because the closing message must not wait for a database that
  // hangs.
  shutdown(PQsocket(connection_.get()), SHUT_RDWR);
  connection_.reset();
  closed_because_ = std::move(reason);
}

// Waits for the socket. Closes the connection and returns false if no byte was transferred within
// the limits.
bool PgConnection::wait_for_socket(short events) {
  const auto deadline = std::chrono::steady_clock::now() + limits_.answer;
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd socket{PQsocket(connection_.get()), events, 0};
    const int ready = poll(&socket, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready > 0) return true;
    if (ready < 0 && errno == EINTR) continue;
    close("no answer for " + std::to_string(limits_.answer.count()) + " ms");
    return false;
  }
}

// Sends all queued data. Reads incoming data at the same time, so that the two sides cannot wait
// for each other.
bool PgConnection::flush() {
  for (;;) {
    const int rest = PQflush(connection_.get());
    if (rest <= 0) return rest == 0;
    if (!wait_for_socket(POLLIN | POLLOUT)) return false;
    if (PQconsumeInput(connection_.get()) != 1) return false;
  }
}

// Returns the next result, or null after the last result of a statement or if the connection was
// closed.
PGresult* PgConnection::next_result() {
  while (connection_ && PQisBusy(connection_.get())) {
    if (!wait_for_socket(POLLIN)) return nullptr;
    if (PQconsumeInput(connection_.get()) != 1) break;
  }
  return PQgetResult(connection_.get());
}

// Returns the last result of the sent statements, or the first failure.
Result<PgResult> PgConnection::outcome() {
  if (!flush()) return failed(nullptr);
  Result<PgResult> last;
  while (PGresult* result = next_result()) {
    PgResult owner(result);
    const auto status = PQresultStatus(result);
    if (!last) continue;
    if (status == PGRES_COPY_IN) return owner;
    if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK)
      last = std::move(owner);
    else
      last = failed(result);
  }
  if (!connection_) return failed(nullptr);
  if (last) STRATA_TRY(standby_confirmed());
  return last;
}

Result<void> PgConnection::standby_confirmed() {
  if (!std::exchange(*wait_was_canceled_, false)) return {};
  sqlstate_ = kConnectionLost;
  return tl::unexpected(unknown_outcome(unavailable("no standby confirmed the commit")));
}

tl::unexpected<Error> PgConnection::failed(const PGresult* result) {
  const char* state = result ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
  const char* primary = result ? PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY) : nullptr;
  const bool lost = PQstatus(connection_.get()) != CONNECTION_OK;
  sqlstate_ = state && !lost ? state : kConnectionLost;
  return tl::unexpected(problem_of(sqlstate_, primary       ? primary
                                              : connection_ ? PQerrorMessage(connection_.get())
                                                            : closed_because_.c_str()));
}

Result<void> PgConnection::script(const std::string& sql) {
  if (!PQsendQuery(connection_.get(), sql.c_str())) return failed(nullptr);
  auto done = outcome();
  return done ? Result<void>{} : tl::unexpected(done.error());
}

Result<std::string> PgConnection::prepared(const char* sql, const Params& params) {
  if (const auto known = prepared_.find(std::string_view(sql)); known != prepared_.end())
    return known->second;
  const std::string name = "s" + std::to_string(prepared_.size());
  if (!PQsendPrepare(connection_.get(), name.c_str(), sql, params.count(), params.types()))
    return failed(nullptr);
  STRATA_TRY(outcome());
  prepared_.emplace(sql, name);
  return name;
}

Result<PgResult> PgConnection::query(const char* sql, const Params& params) {
  const auto name = STRATA_TRY(prepared(sql, params));
  if (!PQsendQueryPrepared(connection_.get(), name.c_str(), params.count(), params.values(),
                           params.lengths(), params.formats(), 1))
    return failed(nullptr);
  return outcome();
}

Result<PgResult> PgConnection::query_once(const std::string& sql, const Params& params) {
  if (!PQsendQueryParams(connection_.get(), sql.c_str(), params.count(), params.types(),
                         params.values(), params.lengths(), params.formats(), 1))
    return failed(nullptr);
  return outcome();
}

Result<void> PgConnection::each_row(const char* sql, const Params& params,
                                    const std::function<Result<void>(const PgResult&)>& on_row) {
  const auto name = STRATA_TRY(prepared(sql, params));
  if (!PQsendQueryPrepared(connection_.get(), name.c_str(), params.count(), params.values(),
                           params.lengths(), params.formats(), 1))
    return failed(nullptr);
  PQsetSingleRowMode(connection_.get());
  if (!flush()) return failed(nullptr);
  Result<void> outcome;
  while (PGresult* result = next_result()) {
    const PgResult owner(result);
    const auto status = PQresultStatus(result);
    if (!outcome) continue;
    if (status == PGRES_SINGLE_TUPLE) {
      outcome = on_row(owner);
      if (!outcome) {
        close("the remaining rows are not needed");
        return outcome;
      }
    } else if (status != PGRES_TUPLES_OK) {
      outcome = failed(result);
    }
  }
  if (!connection_) return failed(nullptr);
  return outcome;
}

Result<bool> PgConnection::wait_for_notification(std::chrono::milliseconds limit) {
  const auto arrived = STRATA_TRY(notifications(limit));
  return !arrived.empty();
}

Result<std::vector<std::string>> PgConnection::notifications(std::chrono::milliseconds limit) {
  PGconn* raw = connection_.get();
  std::vector<std::string> payloads;
  const auto take_all = [&] {
    while (PGnotify* notification = PQnotifies(raw)) {
      payloads.emplace_back(notification->extra);
      PQfreemem(notification);
    }
    return !payloads.empty();
  };
  const auto deadline = std::chrono::steady_clock::now() + limit;
  // Notifications can arrive together with the results of statements.
  while (!take_all()) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return payloads;
    pollfd socket{PQsocket(raw), POLLIN, 0};
    const int ready = poll(&socket, 1, static_cast<int>(left.count()));
    if (ready > 0 && PQconsumeInput(raw) != 1) return failed(nullptr);
  }
  return payloads;
}

// Writes a message to the WAL that no program reads, because only a transaction that writes WAL
// waits for standbys.
Result<void> PgConnection::confirm_visible() {
  STRATA_TRY(query("SELECT pg_logical_emit_message(true, 'strata', '')"));
  return {};
}

Result<std::vector<PgResult>> PgConnection::pipeline(const std::deque<Statement>& statements) {
  std::vector<std::string> names;
  for (const auto& statement : statements) {
    auto name = STRATA_TRY(prepared(statement.sql, statement.params));
    names.push_back(std::move(name));
  }
  PGconn* raw = connection_.get();
  if (!PQenterPipelineMode(raw)) return failed(nullptr);
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const Params& p = statements[i].params;
    if (!PQsendQueryPrepared(raw, names[i].c_str(), p.count(), p.values(), p.lengths(), p.formats(),
                             1))
      return failed(nullptr);
    // flush each statement before the next, so that there is only one copy of the bytes
    if (!flush()) return failed(nullptr);
  }
  if (!PQpipelineSync(raw) || !flush()) return failed(nullptr);

  std::vector<PgResult> results;
  Result<void> outcome;
  for (bool synced = false; !synced;) {
    PGresult* result = next_result();
    if (!result) {
      if (PQstatus(connection_.get()) != CONNECTION_OK) return failed(nullptr);
      continue;  // the end of the results of one statement
    }
    PgResult owner(result);
    const auto status = PQresultStatus(result);
    if (status == PGRES_PIPELINE_SYNC) {
      synced = true;
    } else if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) {
      results.push_back(std::move(owner));
    } else if (status != PGRES_PIPELINE_ABORTED && outcome) {
      outcome = failed(result);
      if (PQstatus(raw) != CONNECTION_OK) return tl::unexpected(outcome.error());
    }
  }
  if (!PQexitPipelineMode(raw)) return failed(nullptr);
  if (!outcome) return tl::unexpected(outcome.error());
  STRATA_TRY(standby_confirmed());
  return results;
}

Result<void> PgConnection::copy_begin(const char* sql) {
  if (!PQsendQuery(connection_.get(), sql)) return failed(nullptr);
  STRATA_TRY(outcome());
  return copy_send(copy_header());
}

Result<void> PgConnection::copy_send(std::string_view data) {
  if (PQputCopyData(connection_.get(), data.data(), static_cast<int>(data.size())) != 1 || !flush())
    return failed(nullptr);
  return {};
}

Result<void> PgConnection::copy_end() {
  STRATA_TRY(copy_send(copy_trailer()));
  if (PQputCopyEnd(connection_.get(), nullptr) != 1) return failed(nullptr);
  auto done = outcome();
  return done ? Result<void>{} : tl::unexpected(done.error());
}

void PgConnection::copy_abort(const char* reason) {
  // the COPY fails, as requested
  if (PQputCopyEnd(connection_.get(), reason) == 1) (void)outcome();
}

Result<Transaction> Transaction::begin(PgConnection& connection) {
  STRATA_TRY(connection.script("BEGIN"));
  return Transaction(connection);
}

Result<Transaction> Transaction::begin_reading(PgConnection& connection) {
  STRATA_TRY(connection.script("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY"));
  return Transaction(connection);
}

Transaction::~Transaction() {
  // an error is ignored: the pool closes a broken connection
  if (connection_) (void)connection_->script("ROLLBACK");
}

Result<void> Transaction::commit() {
  PgConnection& connection = *std::exchange(connection_, nullptr);
  auto committed = connection.script("COMMIT");
  if (!committed && connection.sqlstate() == kConnectionLost)
    return tl::unexpected(unknown_outcome(committed.error()));
  return committed;
}

}  // namespace strata::store
