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
// valid sessions of a user, and as many tokens for scripts
inline constexpr std::size_t kMaxTokens = 100;

// A user with an account. `name` is the name for signing in, ignoring case, and the name in
// journals.
struct Person {
  PersonId id = 0;
  std::string name;
  std::string full_name;
  Role role = Role::viewer;
  bool has_password = false;
  bool disabled = false;
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> last_seen;  // to some minutes
  std::vector<std::string> groups;                                 // by name
};

// The change of a user; empty members stay unchanged.
struct PersonChange {
  std::optional<std::string> full_name;
  std::optional<Role> role;
  std::optional<bool> disabled;
};

enum class TokenKind {
  session,  // of a browser; has the rights of its user
  // the same, but limited to its own role, and, if it has a project, to this project
  script,
  owner_link,  // can be exchanged for sessions until it expires
  invitation,  // can be exchanged for a password and a session, once
};

// The description of a secret. The secret itself is not stored: the store keeps its SHA-256; a
// secret has 256 random bits.
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
  TokenId token = 0;  // its id
};

}  // namespace strata::store
