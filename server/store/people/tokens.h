#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "store/people/people.h"

namespace strata::store {

class Pool;

// Sessions, links and tokens for scripts. Part of Store, whose rules for threads and errors
// apply.
class Tokens {
 public:
  explicit Tokens(Pool& pool) : pool_(pool) {}

  // Makes a token for a user who can sign in. At the limit, a new session replaces the oldest
  // session, but a new token for scripts is a `conflict`. With `hash`, returns an `unauthenticated`
  // error if it is not the hash of the current password. With `project`, a token for scripts is
  // valid only in that project, as viewer, annotator or curator; another role is `invalid`. Returns
  // a `not_found` error if the user or the project does not exist.
  Result<NewToken> create(TokenKind kind, const std::string& user, Role role,
                          std::optional<std::chrono::seconds> lifetime,
                          const std::string& label = {},
                          const std::optional<std::string>& hash = {},
                          std::optional<ProjectId> project = {});
  // Makes a link of this kind for the user. Earlier links of the kind become invalid.
  Result<NewToken> create_link(TokenKind kind, const std::string& user,
                               std::chrono::seconds lifetime);
  // Returns nothing if the secret is unknown, expired or revoked, or if its user may not sign in.
  Result<std::optional<Principal>> find(const std::string& secret);
  // Returns the valid tokens of the user, newest first.
  Result<std::vector<Token>> of_user(const std::string& user, TokenKind kind);
  // Returns the secret of a new session.
  Result<std::optional<std::string>> redeem_owner_link(const std::string& link,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label = {});
  Result<void> revoke(const std::string& secret);
  // Returns a `not_found` error if the user has no token of the kind with that id.
  Result<void> revoke(const std::string& user, TokenKind kind, TokenId id);
  Result<void> revoke_all(const std::string& user, TokenKind kind,
                          std::optional<TokenId> kept_token = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
