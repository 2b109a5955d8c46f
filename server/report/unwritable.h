#pragma once

#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "core/error.h"

namespace strata::report {

inline tl::unexpected<Error> unwritable() {
  return fail(ErrorCode::storage_full, "Report not written",
              "The server could not write the file to its disk. Free disk space.");
}

// Calls `write`, which writes `file`. Converts exceptions of libraries to errors. Deletes the
// unfinished file after an error.
template <class Write>
Result<void> without_exceptions(const std::filesystem::path& file, const Write& write) {
  Result<void> written;
  try {
    written = write();
  } catch (const std::bad_alloc&) {
    written = fail(ErrorCode::out_of_memory, "Report not written",
                   "The server has not enough memory for the report. Use smaller pictures.");
  } catch (const std::exception& error) {
    written = fail(ErrorCode::internal, "Report not written",
                   std::string("The server could not write the report: ") + error.what() + ".");
  }
  std::error_code ignored;
  if (!written) std::filesystem::remove(file, ignored);
  return written;
}

}  // namespace strata::report
