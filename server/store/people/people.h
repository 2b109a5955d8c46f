#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/people/role.h"

namespace strata::store {

inline constexpr std::chrono::hours kInvitationLifetime{24 * 7};
// limit for the valid sessions of a user, and for tokens for scripts
inline constexpr std::size_t kMaxTokens = 100;

// A user with an account. `name` is used to sign in, ignoring case, and in journals.
struct Person {
  PersonId id = 0;
  std::string name;
  std::string full_name;
  Role role = Role::viewer;
  bool has_password = false;
  bool disabled = false;
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> last_seen;  // to within some minutes
  std::vector<std::string> groups;                                 // sorted by name
  bool has_sign_on = false;  // has signed in with OpenID Connect
};

// A change to a user. Properties without a value are not changed.
struct PersonChange {
  std::optional<std::string> full_name;
  std::optional<Role> role;
  std::optional<bool> disabled;
};

enum class TokenKind {
  session,  // session of a browser; has the rights of its user
  // has the rights of its user, but limited to its own role, and, if it has a project, to this
  // project
  script,
  owner_link,  // can be exchanged for sessions until it expires
  invitation,  // can be exchanged for a password and a session, once
};

// The description of a secret of 256 random bits. The store keeps only the SHA-256 of the secret.
struct Token {
  TokenId id = 0;
  TokenKind kind = TokenKind::session;
  std::string label;  // name of the browser, or purpose of the token
  Role role = Role::viewer;
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> expires, last_used;
  std::optional<std::string> project;  // slug of the only project where it is valid
};

struct NewToken {
  std::string secret;  // returned only once
  Token token;
};

// A user's role in one project: viewer, annotator or curator.
struct Membership {
  Person person;
  Role role = Role::viewer;
};

// The user, the roles and the kind of a secret.
struct Principal {
  std::string user;
  Roles roles;
  TokenKind kind = TokenKind::session;
  TokenId token = 0;  // id of the token
};

}  // namespace strata::store
