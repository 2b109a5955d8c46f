#pragma once

#include "core/ids.h"
#include "net/auth/auth.h"

namespace strata::net {

// Whether who came in with the secret may still do the same in the project; where the database is
// away they may stay. May ask the database.
inline bool is_still_welcome(Authenticator& auth, const std::string& secret, ProjectId project_id,
                             Role role) {
  const auto who = auth.identify_token(secret);
  return !who || (*who && (*who)->roles.in(project_id) == role);
}

}  // namespace strata::net
