#pragma once

#include "core/error.h"

namespace strata::store {

// Returns the error for an `after` that is not a position in the requested list.
inline tl::unexpected<Error> wrong_place() {
  return fail(
      ErrorCode::invalid, "Invalid position in the list",
      "`after` must be the value of `next` from a page of this list with the same filters and "
      "order. To read the first page, leave it out.",
      "after");
}

}  // namespace strata::store
