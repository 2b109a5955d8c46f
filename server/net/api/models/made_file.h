#pragma once

#include <functional>
#include <memory>

#include "core/progress.h"
#include "core/temporary_file.h"
#include "net/api/route_help.h"

namespace strata::net {

using MakeFile = std::function<Result<std::shared_ptr<const TemporaryFile>>(Progress&)>;

// Responds with a file that shows the state of a model after an edit. With `Prefer: respond-async`,
// adds a job that makes the file, and responds with the job.
Result<Response> respond_with_file(const RouteContext& context, const Request& request,
                                   const room::Room& room, std::int64_t sequence, MakeFile make);

}  // namespace strata::net
