#pragma once

#include "core/problem.h"

namespace strata::room {

// A room knows which layers it has, so a handle that the renderer does not know is one of a context
// that was lost.
inline Problem gpu_problem(const Problem& why) {
  if (why.status != 404) return why;
  return {503, "GPU lost", "The graphics context is being restored; try again in a moment.", {}};
}

}  // namespace strata::room
