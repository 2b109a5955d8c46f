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

// Accounts of people and their passwords. Part of Store: its rules for threads and errors hold.
class Accounts {
 public:
  explicit Accounts(Pool& pool) : pool_(pool) {}

  Result<std::vector<Person>> all();          // by name
  Result<bool> administrator_has_password();  // so that somebody can sign in who may let in others
  Result<Person> find(const std::string& name);
  // Those of these names, exactly as written, whether they may sign in or not, and who is deleted.
  // In no order.
  Result<std::vector<Person>> called(const std::vector<std::string>& names);
  // invalid: no name for signing in: 1 to 64 of letters, digits and `._@-`, a letter or digit
  // first. conflict: it is taken, in whatever case, or of the form that is kept for who is deleted
  // (`former-7`). They are in these groups at once (invalid: there is no such group; conflict: it
  // is full), by whom the projects' activity tells; empty: it does not.
  Result<Person> create(const std::string& name, const std::string& full_name, Role role,
                        const std::vector<GroupId>& groups = {}, const std::string& by = {});
  // Who is disabled is signed out everywhere, and their invitations are worthless.
  Result<Person> update(PersonId id, const PersonChange& change);
  // Their account ends, and what they did stays under a name that tells nothing, here and in all
  // journals. Disable them first.
  Result<void> remove(const std::string& name);
  // The hash (store/people/password.h); empty where there is none, or nobody of the name who may
  // sign in. In whatever case.
  Result<std::string> password_of(const std::string& name);
  // Ends all sessions but `kept`, and makes all links worthless.
  Result<void> set_password(const std::string& name, const std::string& hash,
                            std::optional<TokenId> kept);
  // Sets the password, uses the invitation up, and opens a session, whose secret is told. Nothing:
  // it is none.
  Result<std::optional<std::string>> accept_invitation(const std::string& invitation,
                                                       const std::string& hash,
                                                       const std::optional<std::string>& full_name,
                                                       std::chrono::seconds lifetime,
                                                       const std::string& label);

 private:
  Pool& pool_;
};

}  // namespace strata::store
