#pragma once

#include <map>
#include <optional>

#include "core/error.h"
#include "core/uuid.h"

namespace strata::room {

// The relation of followers to leaders, by session. It contains no cycle: in a cycle, cameras would
// not move, or, because each window must contain the view of its leader, would move farther and
// farther away. Not thread-safe.
class Followers {
 public:
  // Replaces the former leader. Refused (conflict), without a change, if `leader` is the follower
  // or follows the follower, directly or through others. Returns whether the leader changed.
  Result<bool> follow(const Uuid& follower, const Uuid& leader);
  bool stop(const Uuid& follower);  // returns whether the session followed another
  void leave(const Uuid& session);  // its followers follow nobody
  std::optional<Uuid> leader_of(const Uuid& follower) const;
  bool has_followers(const Uuid& session) const;

 private:
  std::map<Uuid, Uuid> leaders_;  // by follower
};

}  // namespace strata::room
