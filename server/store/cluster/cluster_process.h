#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "core/error.h"

namespace strata::store {

// Who PostgreSQL runs as. It refuses to run as root: then it is the system user "postgres".
struct DatabaseUser {
  bool switch_user = false;
  uid_t uid = 0;
  gid_t gid = 0;
  std::vector<gid_t> groups;
  std::string name;
};
Result<DatabaseUser> database_user();

// /usr/lib/postgresql/N/bin, N as wanted (0: the newest), else the folder of `postgres` on the
// PATH.
Result<std::filesystem::path> find_programs(int wanted_major);

// Makes the folder the user's own with mode 0700, and proves in a child that he can enter it.
Result<void> give_folder(const std::filesystem::path& folder, const DatabaseUser& user);

// Forks and runs a program as `user`, with output appended to `log`, no other open files, default
// signals, a process group of its own (so that Ctrl-C reaches only us) and `death_signal` when the
// calling thread ends. Returns the pid.
Result<pid_t> spawn(const std::vector<std::string>& command, const DatabaseUser& user,
                    const std::filesystem::path& log, int death_signal);

// Quoted for a connection string of libpq.
std::string dsn_value(std::string_view value);

// The last lines of a log file, for an error's detail.
std::string tail(const std::filesystem::path& file, std::size_t bytes = 800);

}  // namespace strata::store
