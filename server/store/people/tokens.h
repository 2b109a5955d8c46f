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

  // A new one of somebody who may sign in (not_found: there is no such person). The oldest session
  // gives way where there are too many; tokens for scripts are refused then (conflict). With
  // `hash`: only while that is the person's password (unauthenticated). With `project`, for
  // scripts: good in that one alone (not_found: it is not there), as viewer, annotator or curator
  // (invalid).
  Result<NewToken> create(TokenKind kind, const std::string& user, Role role,
                          std::optional<std::chrono::seconds> lifetime,
                          const std::string& label = {},
                          const std::optional<std::string>& hash = {},
                          std::optional<ProjectId> project = {});
  // The only good link of the kind that the person has: earlier ones become worthless.
  Result<NewToken> create_link(TokenKind kind, const std::string& user,
                               std::chrono::seconds lifetime);
  // Nothing: unknown, expired or revoked, or of somebody who may not sign in.
  Result<std::optional<Principal>> find(const std::string& secret);
  // Those that are good, the newest first.
  Result<std::vector<Token>> of_user(const std::string& user, TokenKind kind);
  // the secret of a session
  Result<std::optional<std::string>> redeem_owner_link(const std::string& link,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label = {});
  Result<void> revoke(const std::string& secret);
  // not_found: the person has none of the kind with that id.
  Result<void> revoke(const std::string& user, TokenKind kind, TokenId id);
  Result<void> revoke_all(const std::string& user, TokenKind kind,
                          std::optional<TokenId> kept = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
