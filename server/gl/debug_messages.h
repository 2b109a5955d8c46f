#pragma once

#include <atomic>
#include <cstddef>
#include <string_view>

#include "core/error.h"

namespace strata::gl {

// After `install`, counts and logs KHR_debug errors of the current context. Must outlive the
// context.
class DebugMessages {
 public:
  void install();
  int errors() const { return errors_; }
  void count_error() { ++errors_; }

 private:
  std::atomic<int> errors_{0};
};

// Checks the allocation that precedes this call. Returns an Error `out_of_memory` that names `what`
// if the driver had no memory for `bytes`.
Result<void> check_memory(std::string_view what, std::size_t bytes);

}  // namespace strata::gl
