#pragma once

#include "core/problem.h"

namespace strata::store {

// The answer where `after` names no place of the list that is asked for.
inline tl::unexpected<Problem> wrong_place() {
  return fail(
      422, "Not a place in this list",
      "`after` is taken from the `next` of a page of this list, with the same filters and order. Begin without it.",
      "after");
}

}  // namespace strata::store
