#pragma once

#include <map>
#include <optional>

#include "core/error.h"
#include "core/uuid.h"

namespace strata::room {

// Who looks with whom, by session. It never leads back to where it began: people who follow each
// other in a circle would go nowhere, or, as each fits what the other sees into their own window,
// farther and farther away. Not thread-safe.
class Followers {
 public:
  // Instead of whom they followed before. Refused (conflict), and nothing changed, where `leader`
  // is the follower or follows them, directly or through others. Returns whether it is another than
  // before.
  Result<bool> follow(const Uuid& follower, const Uuid& leader);
  bool stop(const Uuid& follower);  // whether they followed somebody
  void leave(const Uuid& session);  // who followed them follows nobody
  std::optional<Uuid> leader_of(const Uuid& follower) const;
  bool has_followers(const Uuid& session) const;

 private:
  std::map<Uuid, Uuid> leaders_;  // by follower
};

}  // namespace strata::room
