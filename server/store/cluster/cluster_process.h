#pragma once

#include <filesystem>
#include <functional>
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

// Returns /usr/lib/postgresql/N/bin with the expected N (0 means the newest). If it does not exist,
// returns the folder of `postgres` on the PATH.
Result<std::filesystem::path> find_programs(int expected_major);

// Makes `user` the owner of the folder, sets its mode to 0700, and verifies in a child process that
// this user can enter it.
Result<void> give_folder(const std::filesystem::path& folder, const DatabaseUser& user);

// Forks and runs a program as `user`, and returns its pid. Output is appended to `log`. The program
// has default signal handlers and no other open files. It is in a separate process group, so Ctrl-C
// reaches only the server. It receives `death_signal` when the calling thread ends.
Result<pid_t> spawn(const std::vector<std::string>& command, const DatabaseUser& user,
                    const std::filesystem::path& log, int death_signal);

// Runs a program until it ends. Calls `goes_on` ten times a second. If `goes_on` returns false,
// kills the program and its children, and returns `cancelled`. Returns `storage_full` if the
// program reports a full disk, and `internal` with the end of `log` if it fails in another way.
Result<void> run_to_end(const std::vector<std::string>& command, const DatabaseUser& user,
                        const std::filesystem::path& log, const std::function<bool()>& goes_on);

// Quotes a value for a connection string of libpq.
std::string dsn_value(std::string_view value);

// Returns the last lines of a log file, for the detail of an error.
std::string tail(const std::filesystem::path& file, std::size_t bytes = 800);

}  // namespace strata::store
