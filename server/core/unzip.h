#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "core/progress.h"

namespace strata {

struct UnzipLimits {
  std::uint64_t files = 1'000'000;
  std::uint64_t bytes = 0;  // of all files together
};

// Unpacks a zip into an existing, empty folder. Writes only plain files and folders. Returns an
// `invalid` error that names the file for a damaged or encrypted file, a path that leads out of the
// folder or appears twice, and a file that is larger than the zip states. Returns `too_large` above
// the limits and for files that share their bytes in the zip, as in zip bombs. Returns
// `storage_full` and `cancelled`. Blocks.
Result<void> unzip(const std::filesystem::path& zip, const std::filesystem::path& folder,
                   const UnzipLimits& limits, Progress& progress);

// Returns whether a path with `/` between folders is relative and stays in its folder, on any
// operating system.
bool is_safe_path(std::string_view path);

}  // namespace strata
