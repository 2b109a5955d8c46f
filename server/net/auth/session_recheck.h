#pragma once

#include "core/ids.h"
#include "net/auth/auth.h"

namespace strata::net {

// Returns whether a session with this secret still has the role in the project. Returns true while
// the database is unreachable. May query the database.
inline bool is_still_welcome(Authenticator& auth, const std::string& secret, ProjectId project_id,
                             Role role) {
  const auto who = auth.identify_token(secret);
  return !who || (*who && (*who)->roles.in(project_id) == role);
}

}  // namespace strata::net
