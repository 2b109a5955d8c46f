#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "core/error.h"

namespace strata::store {

// The user that runs PostgreSQL. PostgreSQL refuses to run as root, so for root this is the system
// user "postgres".
struct DatabaseUser {
  bool switch_user = false;
  uid_t uid = 0;
  gid_t gid = 0;
  std::vector<gid_t> groups;
  std::string name;
};
Result<DatabaseUser> database_user();

// Returns the folders of the installed programs by major version: N/bin in the folders that
// STRATA_POSTGRESQL lists, separated by colons, or by default in /usr/lib/postgresql.
std::map<int, std::filesystem::path> installed_programs();

// Returns the installed programs of the expected version (0 means the newest). If 0 is expected and
// none are installed, returns the folder of `postgres` on the PATH.
Result<std::filesystem::path> find_programs(int expected_major);

// Returns the major version of the PostgreSQL that made the data, or 0 if no data exist.
int data_version(const std::filesystem::path& pgdata);

// Returns the command that makes an empty cluster with the settings of all private clusters.
std::vector<std::string> initdb_command(const std::filesystem::path& programs,
                                        const std::filesystem::path& pgdata);

// Stops a postmaster that has the data open, although no server of Strata uses the data. If `strata
// upgrade-database` is killed, the postmaster that pg_upgrade has started continues. The caller
// must have the lock of the folder. With `only_of_upgrade`, does not stop a postmaster that was
// started in another way, such as by an administrator. Returns true if no postmaster is left after
// `patience`.
bool end_postmaster(const std::filesystem::path& pgdata, std::chrono::seconds patience,
                    bool only_of_upgrade = false);

// Makes `user` the owner of the folder, sets its mode to 0700, and verifies in a child process that
// this user can enter it.
Result<void> give_folder(const std::filesystem::path& folder, const DatabaseUser& user);

// Forks and runs a program as `user`, and returns its pid. Output is appended to `log`. The program
// has default signal handlers and no other open files. It is in a separate process group, so Ctrl-C
// reaches only the server. It receives `death_signal` when the calling thread ends. `folder` is its
// working directory.
Result<pid_t> spawn(const std::vector<std::string>& command, const DatabaseUser& user,
                    const std::filesystem::path& log, int death_signal,
                    const std::filesystem::path& folder = "/");

// Runs a program until it ends. Calls `goes_on` ten times a second. If `goes_on` returns false,
// kills the program and its children, and returns `cancelled`. Returns `storage_full` if the
// program reports a full disk, and `internal` with the end of `log` if it fails in another way.
Result<void> run_to_end(const std::vector<std::string>& command, const DatabaseUser& user,
                        const std::filesystem::path& log, const std::function<bool()>& goes_on,
                        const std::filesystem::path& folder = "/");

// Quotes a value for a connection string of libpq.
std::string dsn_value(std::string_view value);

// Returns the last lines of a log file, for the detail of an error.
std::string tail(const std::filesystem::path& file, std::size_t bytes = 800);

}  // namespace strata::store
