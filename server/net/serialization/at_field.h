#pragma once

#include <string>
#include <utility>

#include "core/error.h"

namespace strata::net {

// Changes not_found to invalid at `field` (422), for a missing entity that the request body names.
inline tl::unexpected<Error> at_field(Error problem, std::string field) {
  if (problem.code == ErrorCode::not_found) problem.code = ErrorCode::invalid;
  problem.field = std::move(field);
  return tl::unexpected(std::move(problem));
}

}  // namespace strata::net
