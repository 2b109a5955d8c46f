#pragma once

#include <string>

#include "core/progress.h"
#include "jobs/import_job.h"

namespace strata::cli {

// Uploads a file to a running server and waits for its import job. Returns the model as the
// server's JSON text.
Result<std::string> import_remotely(const std::string& server_url, const std::string& token,
                                    const jobs::ImportRequest& request, Progress& progress);

}  // namespace strata::cli
