#pragma once

#include <string>
#include <utility>

#include "core/error.h"

namespace strata::net {

// An entity that the request body names but that does not exist is a 422 on that field.
inline tl::unexpected<Error> at_field(Error problem, std::string field) {
  if (problem.code == ErrorCode::not_found) problem.code = ErrorCode::invalid;
  problem.field = std::move(field);
  return tl::unexpected(std::move(problem));
}

}  // namespace strata::net
