#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace strata {

// How a program ended.
struct ChildExit {
  int status = 0;          // the exit status, or 128 + the number of the signal that ended it
  std::string last_words;  // the end of what it wrote to standard error, at most 2000 bytes
};

// Runs a program without a shell and waits for its end. `line` gets each line that the program
// writes to standard output, without the end of line. Lines longer than 4096 bytes are cut.
//
// The program has its own process group. If the work is cancelled, the group is killed, and the
// function returns `cancelled_problem()`. The program is also killed if the server ends. Returns
// the error `internal` if the program could not be started. Can be called on any thread, which
// waits.
Result<ChildExit> run_child(const std::filesystem::path& program,
                            const std::vector<std::string>& arguments, Progress& progress,
                            const std::function<void(std::string_view line)>& line);

}  // namespace strata
