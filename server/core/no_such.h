#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace strata {

// The one wording for what does not exist, or is not shown to this person: "There is no layer
// `cracks`." `ref` is the id or slug as it was given.
inline tl::unexpected<Error> no_such(std::string_view kind, const std::string& ref,
                                     std::string field = {}) {
  return fail(ErrorCode::not_found, "Not found",
              "There is no " + std::string(kind) + " `" + ref.substr(0, 100) + "`.",
              std::move(field));
}

}  // namespace strata
