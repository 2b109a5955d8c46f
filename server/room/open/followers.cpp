#include "room/open/followers.h"

#include <algorithm>
#include <utility>

namespace strata::room {

Result<bool> Followers::follow(const Uuid& follower, const Uuid& leader) {
  for (std::optional<Uuid> ahead = leader; ahead; ahead = leader_of(*ahead))
    if (*ahead == follower)
      return fail(ErrorCode::conflict, "Cannot follow this session",
                  "A session cannot follow itself, or a session that already follows it directly "
                  "or indirectly.",
                  "follow");
  auto [known, added] = leaders_.try_emplace(follower, leader);
  if (added) return true;
  return std::exchange(known->second, leader) != leader;
}

bool Followers::stop(const Uuid& follower) { return leaders_.erase(follower) > 0; }

void Followers::leave(const Uuid& session) {
  leaders_.erase(session);
  std::erase_if(leaders_, [&](const auto& each) { return each.second == session; });
}

std::optional<Uuid> Followers::leader_of(const Uuid& follower) const {
  const auto found = leaders_.find(follower);
  return found == leaders_.end() ? std::nullopt : std::optional(found->second);
}

bool Followers::has_followers(const Uuid& session) const {
  return std::any_of(leaders_.begin(), leaders_.end(),
                     [&](const auto& each) { return each.second == session; });
}

}  // namespace strata::room
