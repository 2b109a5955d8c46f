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

// User accounts and their passwords. Part of Store: its rules for threads and errors hold.
class Accounts {
 public:
  explicit Accounts(Pool& pool) : pool_(pool) {}

  Result<std::vector<Person>> all();          // by name
  Result<bool> administrator_has_password();  // so that somebody can sign in and give access to
                                              // others
  Result<Person> find(const std::string& name);
  // Returns the users with exactly these names, also disabled and deleted ones, in no particular
  // order.
  Result<std::vector<Person>> called(const std::vector<std::string>& names);
  // invalid: not a valid user name (1 to 64 letters, digits and `._@-`, a letter or digit first).
  // conflict: the name is taken, ignoring case, or has the form reserved for deleted users
  // (`former-7`). The user joins `groups` in the same transaction (invalid: no such group;
  // conflict: the group is full). `by`: the user named in the projects' activity; empty: no entry.
  Result<Person> create(const std::string& name, const std::string& full_name, Role role,
                        const std::vector<GroupId>& groups = {}, const std::string& by = {});
  // Disabling a user ends all sessions and invalidates invitations.
  Result<Person> update(PersonId id, const PersonChange& change);
  // Ends the account. In all tables and journals, an anonymous name replaces the name of the user.
  // Disable the user first.
  Result<void> remove(const std::string& name);
  // Returns the hash (store/people/password.h); empty if the user has no password, does not exist
  // or may not sign in. Ignores case.
  Result<std::string> password_of(const std::string& name);
  // Ends all sessions except `kept_token`, and invalidates all links.
  Result<void> set_password(const std::string& name, const std::string& hash,
                            std::optional<TokenId> kept_token);
  // Sets the password, uses up the invitation, opens a session and returns its secret. Returns
  // nothing if the invitation is not valid.
  Result<std::optional<std::string>> accept_invitation(const std::string& invitation,
                                                       const std::string& hash,
                                                       const std::optional<std::string>& full_name,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label);

 private:
  Pool& pool_;
};

}  // namespace strata::store
