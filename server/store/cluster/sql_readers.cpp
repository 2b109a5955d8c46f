#include "store/cluster/sql_readers.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "core/secret.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace fs = std::filesystem;
namespace {

Result<std::string> password_in(const fs::path& file) {
  const auto trouble = [&](const char* why) {
    return fail(ErrorCode::internal, "Invalid password file", file.string() + " " + why,
                "--sql-listen");
  };
  std::error_code error;
  if (!fs::exists(file, error)) {
    const std::string fresh = random_token();
    const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0) return trouble("cannot be written.");
    const std::string line = fresh + "\n";
    const bool written = write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    close(fd);
    if (!written) return trouble("cannot be written.");
  }
  struct stat info {};
  if (stat(file.c_str(), &info) != 0 || (info.st_mode & 077) != 0)
    return trouble(
        "can be read by other users. Remove it; the server then creates a new password.");
  std::string password;
  std::ifstream(file) >> password;
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_';
  };
  if (password.size() < 16 || !std::ranges::all_of(password, is_plain))
    return trouble(
        "does not contain a password of at least 16 letters, digits, - and _. Remove "
        "it; the server then creates a new password.");
  return password;
}

}  // namespace

// The SQL needs no quoting: identifiers and settings are constants, and the password has no
// character that is special in SQL.
Result<void> admit_readers(const std::string& dsn, const fs::path& password_file) {
  const auto password = STRATA_TRY(password_in(password_file));
  auto connection = STRATA_TRY(PgConnection::connect(dsn));
  const std::string role = kReaderRole;
  auto known =
      STRATA_TRY(connection.query("SELECT 1 FROM pg_roles WHERE rolname = 'strata_reader'"));
  std::string sql = "BEGIN; SET LOCAL log_min_error_statement = panic; ";
  if (known.rows() == 0) sql += "CREATE ROLE " + role + "; ";
  sql += "ALTER ROLE " + role +
         " LOGIN NOSUPERUSER NOCREATEDB NOCREATEROLE NOINHERIT NOREPLICATION NOBYPASSRLS "
         "CONNECTION LIMIT 10 PASSWORD '" +
         password + "'; ";
  for (const char* setting :
       {"default_transaction_read_only = on", "statement_timeout = '30s'",
        "idle_in_transaction_session_timeout = '60s'", "idle_session_timeout = '1h'",
        "lock_timeout = '5s'", "temp_file_limit = '2GB'", "search_path = analysis"})
    sql += "ALTER ROLE " + role + " SET " + setting + "; ";
  sql += "REVOKE ALL ON DATABASE strata FROM PUBLIC; GRANT CONNECT ON DATABASE strata TO " + role +
         "; "
         "REVOKE ALL ON SCHEMA public, records FROM PUBLIC; GRANT USAGE ON SCHEMA analysis TO " +
         role +
         "; "
         "GRANT SELECT ON ALL TABLES IN SCHEMA analysis TO " +
         role +
         "; "
         "ALTER DEFAULT PRIVILEGES IN SCHEMA analysis GRANT SELECT ON TABLES TO " +
         role + "; ";
  // Revoke the right to call functions that store data or block other sessions. In a new database,
  // all roles may call them.
  sql +=
      "DO $$ DECLARE f regprocedure; BEGIN FOR f IN SELECT p.oid::regprocedure FROM pg_proc p "
      "WHERE p.pronamespace = 'pg_catalog'::regnamespace AND p.proname ~ '^(lo_|lowrite|loread|pg_(try_)?advisory_|pg_notify)' "
      "LOOP EXECUTE format('REVOKE EXECUTE ON FUNCTION %s FROM PUBLIC', f); END LOOP; END $$; COMMIT";
  auto done = connection.script(sql);
  if (!done) (void)connection.script("ROLLBACK");
  return done;
}

}  // namespace strata::store
