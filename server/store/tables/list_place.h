#pragma once

#include "core/error.h"

namespace strata::store {

// The error for an `after` that is no place of the requested list.
inline tl::unexpected<Error> wrong_place() {
  return fail(
      ErrorCode::invalid, "Not a place in this list",
      "`after` is taken from the `next` of a page of this list, with the same filters and order. Begin without it.",
      "after");
}

}  // namespace strata::store
