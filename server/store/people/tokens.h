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

// Sessions, links and tokens for scripts. Part of Store: its rules for threads and errors hold.
class Tokens {
 public:
  explicit Tokens(Pool& pool) : pool_(pool) {}

  // Makes a token of a user who may sign in (not_found: there is no such user). At the limit, a new
  // session replaces the oldest one, and a new token for scripts is refused (conflict). With
  // `hash`: only while that is the user's password (unauthenticated). With `project`, for scripts:
  // valid in that project only (not_found: it does not exist), as viewer, annotator or curator
  // (invalid).
  Result<NewToken> create(TokenKind kind, const std::string& user, Role role,
                          std::optional<std::chrono::seconds> lifetime,
                          const std::string& label = {},
                          const std::optional<std::string>& hash = {},
                          std::optional<ProjectId> project = {});
  // Makes the only valid link of this kind of the user: earlier ones become invalid.
  Result<NewToken> create_link(TokenKind kind, const std::string& user,
                               std::chrono::seconds lifetime);
  // Nothing: unknown, expired or revoked, or of a user who may not sign in.
  Result<std::optional<Principal>> find(const std::string& secret);
  // Returns the valid ones, newest first.
  Result<std::vector<Token>> of_user(const std::string& user, TokenKind kind);
  // the secret of a session
  Result<std::optional<std::string>> redeem_owner_link(const std::string& link,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label = {});
  Result<void> revoke(const std::string& secret);
  // not_found: the user has no token of the kind with that id.
  Result<void> revoke(const std::string& user, TokenKind kind, TokenId id);
  Result<void> revoke_all(const std::string& user, TokenKind kind,
                          std::optional<TokenId> kept_token = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
