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
// good sessions of a person, and as many for scripts
inline constexpr std::size_t kMaxTokens = 100;

// Someone with an account. `name` is what they sign in with, in any case, and what journals say of
// them.
struct Person {
  PersonId id = 0;
  std::string name;
  std::string full_name;
  Role role = Role::viewer;
  bool has_password = false;
  bool disabled = false;
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> last_seen;  // to some minutes
  std::vector<std::string> groups;                                 // that they are in, by name
};

// What is to be changed of somebody; the rest stays as it is.
struct PersonChange {
  std::optional<std::string> full_name;
  std::optional<Role> role;
  std::optional<bool> disabled;
};

enum class TokenKind {
  session,  // of a browser; does what its person may do
  // the same, but no more than its own role, and, where it has a project, nothing elsewhere
  script,
  owner_link,  // is traded for sessions until it expires
  invitation,  // is traded for a password and a session, once
};

// What a secret stands for. The secret itself is nowhere: its SHA-256 is kept, of 256 random bits.
struct Token {
  TokenId id = 0;
  TokenKind kind = TokenKind::session;
  std::string label;  // what the browser calls itself, or what the token is for
  Role role = Role::viewer;
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> expires, last_used;
  std::optional<std::string> project;  // slug of the only one that it is good in
};

struct NewToken {
  std::string secret;  // told this once
  Token token;
};

// Somebody's role in one project: viewer, annotator or curator.
struct Membership {
  Person person;
  Role role = Role::viewer;
};

// Who a secret speaks for, and as what.
struct Principal {
  std::string user;
  Roles roles;
  TokenKind kind = TokenKind::session;
  TokenId token = 0;  // its id
};

}  // namespace strata::store
