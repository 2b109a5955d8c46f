#include "store/pg.h"

#include <algorithm>
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
  return std::any_of(prefixes.begin(), prefixes.end(), [&](auto p) { return sqlstate.starts_with(p); });
}

constexpr const char* kConnectionLost = "08006";

}  // namespace

Problem unavailable(std::string_view why) {
  return {503, "Database unavailable",
          "PostgreSQL does not answer (" + one_line(why) + "). Nothing was changed by this call unless said; try again.", ""};
}

Problem problem_of(std::string_view sqlstate, std::string_view message) {
  const std::string what = one_line(message);
  if (sqlstate.empty() || starts_with_any(sqlstate, {"08", "57P"})) return unavailable(message);
  if (sqlstate == "53100")
    return {507, "Disk full", "The database's disk is full (" + what + "). Free space on it; nothing was changed.", ""};
  if (sqlstate.starts_with("53"))
    return {503, "Database overloaded", "PostgreSQL is out of resources (" + what + "). Try again shortly.", ""};
  if (sqlstate == "23505") return {409, "Already exists", "Something with this name or id exists already (" + what + ").", ""};
  if (sqlstate == "23503")
    return {409, "Conflict", "What this refers to does not exist, or is still in use (" + what + ").", ""};
  if (sqlstate.starts_with("23")) return {409, "Conflict", "The database refuses these values (" + what + ").", ""};
  if (sqlstate == "22021" || sqlstate == "22P05")
    return {400, "Text not storable", "Text must be UTF-8 without the character U+0000.", ""};
  if (starts_with_any(sqlstate, {"22", "54"}))
    return {400, "Value not storable", "The database cannot keep a value (" + what + ").", ""};
  if (starts_with_any(sqlstate, {"40", "55P03", "57014", "25006"}))
    return {503, "Database busy", "PostgreSQL could not do it now (" + what + "). Try again.", ""};
  if (sqlstate.starts_with("58"))
    return {503, "Database unavailable", "PostgreSQL cannot read or write its files (" + what + "). Check its disk.", ""};
  return {500, "Database error", "PostgreSQL reported " + std::string(sqlstate) + ": " + what + ".", ""};
}

bool is_transient(std::string_view sqlstate) {
  return !starts_with_any(sqlstate, {"22", "23", "42", "0A", "54"});
}

Result<PgConnection> PgConnection::connect(const std::string& dsn) {
  // Settings given in the DSN come later in the list and win.
  const char* keys[] = {"connect_timeout", "tcp_user_timeout", "keepalives_idle", "application_name", "dbname", nullptr};
  const char* values[] = {"5", "30000", "30", "strata", dsn.c_str(), nullptr};
  PgConnection connection(PQconnectdbParams(keys, values, 1));
  PGconn* raw = connection.connection_.get();
  if (!raw) return tl::unexpected(unavailable("out of memory"));
  if (PQstatus(raw) != CONNECTION_OK) return tl::unexpected(unavailable(PQerrorMessage(raw)));
  PQsetNoticeProcessor(raw, [](void*, const char*) {}, nullptr);
  auto set = connection.script("SET synchronous_commit = on; SET client_encoding = 'UTF8'; SET jit = off");
  if (!set) return tl::unexpected(set.error());
  return connection;
}

bool PgConnection::alive() {
  PGconn* raw = connection_.get();
  return raw && PQstatus(raw) == CONNECTION_OK && PQconsumeInput(raw) == 1 && PQstatus(raw) == CONNECTION_OK &&
         PQtransactionStatus(raw) == PQTRANS_IDLE;
}

tl::unexpected<Problem> PgConnection::failed(const PGresult* result) {
  const char* state = result ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
  const char* primary = result ? PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY) : nullptr;
  const bool lost = PQstatus(connection_.get()) != CONNECTION_OK;
  sqlstate_ = state && !lost ? state : kConnectionLost;
  return tl::unexpected(problem_of(sqlstate_, primary ? primary : PQerrorMessage(connection_.get())));
}

Result<void> PgConnection::script(const std::string& sql) {
  const std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection_.get(), sql.c_str()), &PQclear);
  const auto status = PQresultStatus(result.get());
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) return failed(result.get());
  return {};
}

Result<std::string> PgConnection::prepared(const char* sql, const Params& params) {
  if (const auto known = prepared_.find(std::string_view(sql)); known != prepared_.end()) return known->second;
  const std::string name = "s" + std::to_string(prepared_.size());
  const std::unique_ptr<PGresult, decltype(&PQclear)> result(
      PQprepare(connection_.get(), name.c_str(), sql, params.count(), params.types()), &PQclear);
  if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) return failed(result.get());
  prepared_.emplace(sql, name);
  return name;
}

Result<PgResult> PgConnection::query(const char* sql, const Params& params) {
  const auto name = prepared(sql, params);
  if (!name) return tl::unexpected(name.error());
  PGresult* result = PQexecPrepared(connection_.get(), name->c_str(), params.count(), params.values(), params.lengths(),
                                    params.formats(), 1);
  PgResult owner(result);
  const auto status = PQresultStatus(result);
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) return failed(result);
  return owner;
}

Result<void> PgConnection::each_row(const char* sql, const Params& params,
                                    const std::function<Result<void>(const PgResult&)>& on_row) {
  const auto name = prepared(sql, params);
  if (!name) return tl::unexpected(name.error());
  PGconn* raw = connection_.get();
  if (!PQsendQueryPrepared(raw, name->c_str(), params.count(), params.values(), params.lengths(), params.formats(), 1))
    return failed(nullptr);
  PQsetSingleRowMode(raw);
  Result<void> outcome;
  bool cancelled = false;
  while (PGresult* result = PQgetResult(raw)) {
    const PgResult owner(result);
    const auto status = PQresultStatus(result);
    if (!outcome) {
      if (cancelled) continue;
      // The caller wants no more: ask the server to stop instead of reading the rest.
      cancelled = true;
      const std::unique_ptr<PGcancel, decltype(&PQfreeCancel)> cancel(PQgetCancel(raw), &PQfreeCancel);
      char ignored[256];
      if (cancel) PQcancel(cancel.get(), ignored, sizeof ignored);
    } else if (status == PGRES_SINGLE_TUPLE) {
      outcome = on_row(owner);
    } else if (status != PGRES_TUPLES_OK) {
      outcome = failed(result);
      cancelled = true;
    }
  }
  return outcome;
}

Result<std::vector<PgResult>> PgConnection::pipeline(const std::deque<Statement>& statements) {
  std::vector<std::string> names;
  for (const auto& statement : statements) {
    auto name = prepared(statement.sql, statement.params);
    if (!name) return tl::unexpected(name.error());
    names.push_back(std::move(*name));
  }
  PGconn* raw = connection_.get();
  if (!PQenterPipelineMode(raw)) return failed(nullptr);
  for (std::size_t i = 0; i < statements.size(); ++i) {
    const Params& p = statements[i].params;
    if (!PQsendQueryPrepared(raw, names[i].c_str(), p.count(), p.values(), p.lengths(), p.formats(), 1))
      return failed(nullptr);
  }
  if (!PQpipelineSync(raw)) return failed(nullptr);

  std::vector<PgResult> results;
  Result<void> outcome;
  for (bool synced = false; !synced;) {
    PGresult* result = PQgetResult(raw);
    if (!result) {
      if (PQstatus(raw) != CONNECTION_OK) return failed(nullptr);
      continue;  // the end of one statement's results
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
  return results;
}

Result<void> PgConnection::copy_begin(const char* sql) {
  const std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection_.get(), sql), &PQclear);
  if (PQresultStatus(result.get()) != PGRES_COPY_IN) return failed(result.get());
  return copy_send(copy_header());
}

Result<void> PgConnection::copy_send(std::string_view data) {
  if (PQputCopyData(connection_.get(), data.data(), static_cast<int>(data.size())) != 1) return failed(nullptr);
  return {};
}

Result<void> PgConnection::copy_end() {
  if (auto sent = copy_send(copy_trailer()); !sent) return sent;
  if (PQputCopyEnd(connection_.get(), nullptr) != 1) return failed(nullptr);
  Result<void> outcome;
  while (PGresult* result = PQgetResult(connection_.get())) {
    const PgResult owner(result);
    if (PQresultStatus(result) != PGRES_COMMAND_OK) outcome = failed(result);
  }
  return outcome;
}

void PgConnection::copy_abort(const char* reason) {
  PQputCopyEnd(connection_.get(), reason);
  while (PGresult* result = PQgetResult(connection_.get())) PQclear(result);
}

Result<Transaction> Transaction::begin(PgConnection& connection) {
  if (auto begun = connection.script("BEGIN"); !begun) return tl::unexpected(begun.error());
  return Transaction(connection);
}

Transaction::~Transaction() {
  if (connection_) (void)connection_->script("ROLLBACK");  // a broken connection is closed by the pool
}

Result<void> Transaction::commit() {
  return std::exchange(connection_, nullptr)->script("COMMIT");
}

}  // namespace strata::store
