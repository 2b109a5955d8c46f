#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// Returns the standard error for an entity that does not exist or that the caller cannot see:
// "There is no layer `cracks`." `ref` is the id or slug in the request.
inline tl::unexpected<Error> no_such(std::string_view kind, const std::string& ref,
                                     std::string field = {}) {
  return fail(ErrorCode::not_found, "Not found",
              "There is no " + std::string(kind) + " `" + ref.substr(0, 100) + "`.",
              std::move(field));
}

}  // namespace strata
