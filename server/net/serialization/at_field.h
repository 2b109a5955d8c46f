#pragma once

#include <string>
#include <utility>

#include "core/error.h"

namespace strata::net {

// What a body names and is not there is a fault of the body.
inline tl::unexpected<Error> at_field(Error problem, std::string field) {
  if (problem.code == ErrorCode::not_found) problem.code = ErrorCode::invalid;
  problem.field = std::move(field);
  return tl::unexpected(std::move(problem));
}

}  // namespace strata::net
