#pragma once

#include "core/ids.h"
#include "net/auth/auth.h"

namespace strata::net {

// Returns whether a session with this secret has the role in the project. May query the database.
inline Result<bool> is_welcome(Authenticator& auth, const std::string& secret, ProjectId project_id,
                               Role role) {
  const auto who = STRATA_TRY(auth.identify_token(secret));
  return who && who->roles.in(project_id) == role;
}

// As is_welcome, but returns true while the database is unreachable.
inline bool is_still_welcome(Authenticator& auth, const std::string& secret, ProjectId project_id,
                             Role role) {
  return is_welcome(auth, secret, project_id, role).value_or(true);
}

}  // namespace strata::net
