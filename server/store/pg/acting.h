#pragma once

#include <string>

#include "core/error.h"

namespace strata::store {

class PgConnection;
class Transaction;

// The person, token, kiosk or link that causes the changes of a thread. The audit log names it
// (db/migrations/000042_audit.sql).
struct Actor {
  std::string kind;     // "person", "token", "kiosk" or "link"
  std::string name;     // empty if it is unknown, such as before a sign-in
  std::string address;  // of the client
  // the way of a sign-in: "password", "token", "link", "invitation" or "oidc"
  std::string sign_in;
  std::string provider{};  // id of the provider of a sign-in with "oidc"
};

// Names the actor of all transactions that this thread begins during the lifetime of this object.
// Without one, the author of a change (IdempotentResponse::user) is the actor, or else the server.
class ActingAs {
 public:
  explicit ActingAs(Actor actor);
  ~ActingAs();
  ActingAs(const ActingAs&) = delete;
  ActingAs& operator=(const ActingAs&) = delete;

  static const Actor* current();  // of this thread; may be null

 private:
  const Actor actor_;
  const Actor* const before_;
};

// Begins a transaction and names the actor of this thread in it, in one round trip.
Result<Transaction> begin_as_actor(PgConnection& connection);

}  // namespace strata::store
