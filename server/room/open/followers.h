#pragma once

#include <map>
#include <optional>

#include "core/error.h"
#include "core/uuid.h"

namespace strata::room {

// The relation of followers to leaders, by session. It has no cycles. In a cycle, cameras would not
// move, or would move farther and farther away, because each window must contain the view of its
// leader. Not thread-safe.
class Followers {
 public:
  // Replaces the former leader. Returns the error `conflict`, and changes nothing, if `leader` is
  // the follower or follows the follower, directly or through others. Returns whether the leader
  // changed.
  Result<bool> follow(const Uuid& follower, const Uuid& leader);
  bool stop(const Uuid& follower);  // returns whether the session had a leader
  void leave(const Uuid& session);  // afterwards, its followers have no leader
  std::optional<Uuid> leader_of(const Uuid& follower) const;
  bool has_followers(const Uuid& session) const;

 private:
  std::map<Uuid, Uuid> leaders_;  // by follower
};

}  // namespace strata::room
