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

// User accounts and their passwords. Part of Store, whose rules for threads and errors apply.
class Accounts {
 public:
  explicit Accounts(Pool& pool) : pool_(pool) {}

  Result<std::vector<Person>> all();  // sorted by name
  // Returns whether an administrator has a password that `local_accounts` allows to use, or has
  // signed in with OpenID Connect. If so, a user can give access to others.
  Result<bool> administrator_can_sign_in(bool local_accounts);
  Result<Person> find(const std::string& name);
  // Returns the users with exactly these names, also disabled and deleted ones, in no particular
  // order.
  Result<std::vector<Person>> called(const std::vector<std::string>& names);
  // Creates a user, who joins `groups` in the same transaction. A valid user name has 1 to 64
  // letters, digits and `._@-`, and begins with a letter or digit. Returns an `invalid` error for
  // another name or an unknown group. Returns a `conflict` error if a group is full, or if the name
  // is taken, ignoring case, or reserved for deleted users (`former-7`). `by` is the user named in
  // the activity of the projects; if it is empty, the activity gets no entry.
  Result<Person> create(const std::string& name, const std::string& full_name, Role role,
                        const std::vector<GroupId>& groups = {}, const std::string& by = {});
  // Disabling a user ends all sessions of the user and invalidates the invitations of the user.
  Result<Person> update(PersonId id, const PersonChange& change);
  // Deletes the account. An anonymous name replaces the name of the user in all tables and
  // journals. Disable the user first.
  Result<void> remove(const std::string& name);
  // Returns the hash of the password (store/people/password.h). Returns an empty text if the user
  // has no password, does not exist or may not sign in. The case of the name is ignored.
  Result<std::string> password_of(const std::string& name);
  // Sets the password, ends all sessions except `kept_token`, and invalidates all links.
  Result<void> set_password(const std::string& name, const std::string& hash,
                            std::optional<TokenId> kept_token);
  // Sets the password, invalidates the invitation, opens a session and returns the secret of the
  // session. Returns nothing if the invitation is not valid.
  Result<std::optional<std::string>> accept_invitation(const std::string& invitation,
                                                       const std::string& hash,
                                                       const std::optional<std::string>& full_name,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label);

 private:
  Pool& pool_;
};

}  // namespace strata::store
