#pragma once

#include "core/error.h"

namespace strata::room {

// Converts an error of the renderer. A room has only valid handles, so a handle that the renderer
// does not find belongs to a lost context.
inline Error gpu_problem(const Error& why) {
  if (why.code != ErrorCode::not_found) return why;
  return {ErrorCode::gpu_lost,
          "GPU lost",
          "The graphics context is being restored; try again in a moment.",
          {}};
}

}  // namespace strata::room
