#pragma once

#include <libpq-fe.h>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "store/pg/bytes.h"
#include "store/pg/pg_limits.h"
#include "store/pg/sql.h"

namespace strata::store {

using Time = std::chrono::system_clock::time_point;

namespace oid {
constexpr Oid kBool = 16, kBytea = 17, kInt8 = 20, kInt2 = 21, kText = 25, kFloat8 = 701,
              kTimestamptz = 1184, kUuid = 2950, kJsonb = 3802;
}

// A one-dimensional PostgreSQL array in binary format, for `unnest($1)` and `= any($1)`.
class PgArray {
 public:
  explicit PgArray(Oid element) : element_(element) {}
  void add(std::int64_t value);
  template <class Kind>
  void add(Id<Kind> id) {
    add(id.number());
  }
  void add_int2(std::int16_t value);
  void add(double value);
  void add(std::string_view text);
  void add(Bytes bytes);
  void add(const Uuid& uuid);
  void add(const nlohmann::json& json);
  void add(Time time);
  void add_null();

  Oid element() const { return element_; }
  int size() const { return count_; }
  std::string encode() const;

 private:
  void add_raw(const void* data, std::size_t size);
  Oid element_;
  int count_ = 0;
  bool has_null_ = false;
  std::string body_;
};

// The values of $1, $2, … in binary format. Values of `bytes` are not copied, and must outlive the
// call that sends them.
class Params {
 public:
  Params() = default;
  Params(Params&&) = default;  // a copy would point into the original
  Params& operator=(Params&&) = default;

  Params& integer(std::int64_t value);
  Params& optional_integer(std::optional<std::int64_t> value);
  template <class Kind>
  Params& id(Id<Kind> id) {
    return integer(id.number());
  }
  template <class Kind>
  Params& optional_id(std::optional<Id<Kind>> id) {
    return optional_integer(id ? std::optional(id->number()) : std::nullopt);
  }
  Params& real(double value);
  Params& boolean(bool value);
  Params& text(std::string_view value);
  Params& optional_text(const std::optional<std::string>& value);
  Params& bytes(Bytes value);
  Params& uuid(const Uuid& value);
  // Throws nlohmann::json::type_error for text that is not UTF-8.
  Params& json(const nlohmann::json& value);
  Params& time(std::optional<Time> value);
  Params& array(const PgArray& value);

  int count() const { return static_cast<int>(types_.size()); }
  const Oid* types() const { return types_.data(); }
  const char* const* values() const { return values_.data(); }
  const int* lengths() const { return lengths_.data(); }
  const int* formats() const { return formats_.data(); }

 private:
  Params& own(Oid type, std::string value);
  Params& null(Oid type);
  std::deque<std::string> owned_;  // a deque, because its elements never move
  std::vector<Oid> types_;
  std::vector<const char*> values_;
  std::vector<int> lengths_;
  std::vector<int> formats_;
};

// The rows of a result in binary format. Each read function expects the matching SQL type.
class PgResult {
 public:
  PgResult() = default;
  explicit PgResult(PGresult* result) : result_(result) {}

  int rows() const { return PQntuples(result_.get()); }
  std::int64_t affected() const;
  bool null(int row, int column) const { return PQgetisnull(result_.get(), row, column) != 0; }
  std::int64_t integer(int row, int column) const;  // int2, int4, int8
  // Returns an id. If T is an optional id, it is empty for SQL null.
  template <class T>
  T id(int row, int column) const {
    if constexpr (requires { typename T::value_type; })
      return null(row, column) ? T() : T(typename T::value_type(integer(row, column)));
    else
      return T(integer(row, column));
  }
  double real(int row, int column) const;
  bool boolean(int row, int column) const;
  std::string text(int row, int column) const;
  Bytes bytes(int row, int column) const;  // valid while the result exists
  Uuid uuid(int row, int column) const;
  nlohmann::json json(int row, int column) const;
  Time time(int row, int column) const;
  std::vector<double> reals(int row, int column) const;  // float8[]

 private:
  struct Clear {
    void operator()(PGresult* result) const { PQclear(result); }
  };
  std::unique_ptr<PGresult, Clear> result_;
};

// One connection, used by one thread at a time. Statements are prepared once per connection. A call
// that waits longer than the limits closes the connection. It returns an `unavailable` error with
// the sqlstate "08006", as if the server had closed the connection. A commit whose wait for a
// synchronous standby was canceled returns the same error, because the change may be lost when the
// primary fails.
class PgConnection {
 public:
  // Makes one attempt of at most 5 seconds. Commits of the session are durable (synchronous_commit
  // on), and its encoding is UTF-8.
  static Result<PgConnection> connect(const std::string& dsn,
                                      const PgLimits& limits = kRequestLimits);
  // Sets the limits for later calls. Needs a round trip if the limits change.
  Result<void> set_limits(const PgLimits& limits);

  // Returns false if the server has closed the connection. Needs one system call.
  bool alive();
  // Returns the SQLSTATE of the last failure, or "08006" if the connection broke.
  const std::string& sqlstate() const { return sqlstate_; }

  // Returns true, once, if the last failure was a deadlock in which the server chose this session
  // as the victim.
  bool take_deadlock() { return std::exchange(sqlstate_, {}) == "40P01"; }

  Result<void> script(const std::string& sql);  // any number of statements without parameters
  Result<PgResult> query(const char* sql, const Params& params = {});
  template <std::size_t Length>
  Result<PgResult> query(const SqlText<Length>& sql, const Params& params = {}) {
    return query(sql.c_str(), params);
  }
  // Runs a query without preparing the statement. Use it for statements that name generated tables,
  // because their number is unlimited.
  Result<PgResult> query_once(const std::string& sql, const Params& params = {});
  // Passes rows as they arrive, each in a result of one row, so that memory use stays small. An
  // error from `on_row` ends the query and closes the connection, because canceling the query could
  // wait for the server without limit.
  Result<void> each_row(const char* sql, const Params& params,
                        const std::function<Result<void>(const PgResult&)>& on_row);

  // Waits for a notification after LISTEN, or returns false after `limit`, which may exceed the
  // limits of the connection. Forgets all notifications that have arrived.
  Result<bool> wait_for_notification(std::chrono::milliseconds limit);
  // The same, but returns the payloads of all notifications that have arrived, in their order.
  Result<std::vector<std::string>> notifications(std::chrono::milliseconds limit);

  // Makes the current transaction, or a new one, wait at its commit until the synchronous standbys
  // have all changes that this session can read. Call it before you report changes that another
  // session has committed: that commit may still wait for a standby, or its wait may have been
  // canceled.
  Result<void> confirm_visible();

  // Sends statements without waiting between them. Returns the first failure; the server skips the
  // later statements.
  struct Statement {
    const char* sql;
    Params params;
  };
  Result<std::vector<PgResult>> pipeline(const std::deque<Statement>& statements);

  // COPY … FROM STDIN (FORMAT binary): copy_begin, then copy_send for rows of fields, then
  // copy_end.
  Result<void> copy_begin(const char* sql);
  Result<void> copy_send(std::string_view data);
  Result<void> copy_end();
  void copy_abort(const char* reason);

 private:
  explicit PgConnection(PGconn* connection) : connection_(connection) {}
  Result<std::string> prepared(const char* sql, const Params& params);
  tl::unexpected<Error> failed(const PGresult* result);
  bool wait_for_socket(short events);
  bool flush();
  PGresult* next_result();
  Result<PgResult> outcome();
  Result<void> standby_confirmed();
  void close(std::string reason);
  struct Finish {
    void operator()(PGconn* connection) const { PQfinish(connection); }
  };
  std::unique_ptr<PGconn, Finish> connection_;
  std::map<std::string, std::string, std::less<>> prepared_;
  PgLimits limits_;
  // On the heap, because libpq keeps its address.
  std::unique_ptr<bool> wait_was_canceled_ = std::make_unique<bool>(false);
  std::string closed_because_;
  std::string sqlstate_;
};

// Runs BEGIN when it is made, and ROLLBACK when it is destroyed without a commit.
class Transaction {
 public:
  static Result<Transaction> begin(PgConnection& connection);
  // Begins a read-only transaction in which all reads see the same snapshot.
  static Result<Transaction> begin_reading(PgConnection& connection);
  // Makes a Transaction whose BEGIN is sent with a pipeline.
  static Transaction adopt(PgConnection& connection) { return Transaction(connection); }
  Transaction(Transaction&& other) noexcept
      : connection_(std::exchange(other.connection_, nullptr)) {}
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();
  // If the response of the server is lost, the error states that the commit may or may not have
  // happened.
  Result<void> commit();

 private:
  explicit Transaction(PgConnection& connection) : connection_(&connection) {}
  PgConnection* connection_;
};

// Parts of the data for a binary COPY.
std::string copy_header();
void append_field(std::string& row, Bytes bytes);
void append_int4(std::string& row, std::int32_t value);  // a field of type int4
void append_row_start(std::string& row, std::int16_t fields);
std::string copy_trailer();

// Returns the error for a failure of PostgreSQL: `unavailable` for the connection, `conflict` for
// 23xxx, `storage_full` for a full disk, `malformed` for invalid text, and so on.
Error problem_of(std::string_view sqlstate, std::string_view message);
Error unavailable(std::string_view why);
// Returns true if a later retry can succeed (connection, resources, deadlocks), and false if no
// retry can succeed.
bool is_transient(std::string_view sqlstate);

// Refuses text that PostgreSQL cannot store: invalid UTF-8 and U+0000.
Result<void> check_text(std::string_view text, const std::string& field);

}  // namespace strata::store
