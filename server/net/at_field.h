#pragma once

#include <string>
#include <utility>

#include "core/problem.h"

namespace strata::net {

// What a body names and is not there is a fault of the body.
inline tl::unexpected<Problem> at_field(Problem problem, std::string field) {
  if (problem.status == 404) problem.status = 422;
  problem.field = std::move(field);
  return tl::unexpected(std::move(problem));
}

}  // namespace strata::net
