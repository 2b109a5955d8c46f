#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/people/role.h"

namespace strata::store {

class Pool;

// A sign-in that waits for the response of the provider.
struct PendingSignIn {
  std::string provider;  // id of the provider
  std::string nonce, code_verifier;
  std::string return_to;  // path of the page that opens after the sign-in
};

// A person at a provider, with the rights that the claims give.
struct SignOn {
  std::string issuer, subject;
  std::string name;       // the user name at the provider, which may be any text
  std::string full_name;  // for a new account
  bool may_create = false;
  Role new_role = Role::guest;  // for a new account, if `role` is empty
  // The role that the claims give. Replaces the role of the account, but never the role of the
  // owner.
  std::optional<Role> role;
  // Names of groups. The person joins them, and leaves the groups that only earlier claims gave.
  std::vector<std::string> groups;
};

struct SignedOn {
  enum class Outcome { signed_in, no_account, disabled };
  Outcome outcome = Outcome::no_account;
  std::string user;                         // empty without an account
  std::string session;                      // the secret of the session, after a sign-in
  bool changed = false;                     // the role or the groups of an account changed
  std::vector<std::string> skipped_groups;  // they do not exist, or are full
};

// Sign-in with OpenID Connect. Part of Store, whose rules for threads and errors apply.
class SignOns {
 public:
  static constexpr std::int64_t kMaxPending = 10'000;
  static constexpr std::size_t kMaxReturnTo = 1024;  // bytes

  explicit SignOns(Pool& pool) : pool_(pool) {}

  // Stores the sign-in. `state` and `browser` are secrets, of which the store keeps the SHA-256.
  // Returns a `busy` error if too many sign-ins are waiting.
  Result<void> begin(const std::string& state, const std::string& browser,
                     const PendingSignIn& pending, std::chrono::seconds lifetime);
  // Removes the sign-in and returns it. Returns nothing if the state is unknown or expired, was
  // used before, or belongs to another browser. Another browser does not remove the sign-in.
  Result<std::optional<PendingSignIn>> take(const std::string& state, const std::string& browser);

  // Opens a session for the account of the issuer and subject. If no account is bound to them,
  // creates and binds one if `may_create` allows it. A new account never has the name of an
  // existing one.
  Result<SignedOn> sign_in(const SignOn& sign_on, std::chrono::seconds lifetime,
                           const std::string& label);
  // Binds the issuer and subject to an existing account before the first sign-in. Returns a
  // `conflict` error if they are bound to another account.
  Result<void> bind(const std::string& user, const std::string& issuer, const std::string& subject);

 private:
  Pool& pool_;
};

// Makes a valid user name from the user name at a provider (Accounts::create). Replaces other
// characters by hyphens. Returns "user" if nothing remains.
std::string user_name_from(const std::string& name);

}  // namespace strata::store
