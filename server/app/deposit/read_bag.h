#pragma once

#include <filesystem>

#include "core/error.h"
#include "core/progress.h"

namespace strata::app {

// Checks a bag (RFC 8493) in a folder: every file of the payload is in manifest-sha256.txt and has
// its checksum, and no file is missing. Also checks the tag manifest and Payload-Oxum. Returns an
// `invalid` error that names the file. Refuses symbolic links, and paths that lead out of the bag.
Result<void> check_bag(const std::filesystem::path& bag, Progress& progress);

// Unpacks the zip of a deposit into an empty folder, and returns the folder of the bag, which is
// not checked yet. Refuses more bytes than the disk has free.
Result<std::filesystem::path> unpack_bag(const std::filesystem::path& zip,
                                         const std::filesystem::path& folder, Progress& progress);

}  // namespace strata::app
