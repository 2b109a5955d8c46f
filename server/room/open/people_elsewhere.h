#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "core/uuid.h"
#include "room/participants.h"

namespace strata::room {

// The people who look at the model of a room at other nodes of the site. Each of these nodes sends
// its list at least once in kSilentAfter (room/presence_exchange.h). Not thread-safe.
class PeopleElsewhere {
 public:
  using Clock = std::chrono::steady_clock;
  // A node that has ended, or that has no lease, sends nothing, so its people disappear after this
  // time.
  static constexpr std::chrono::seconds kSilentAfter{5};
  static constexpr std::size_t kMaxNodes = 32;
  // At all nodes together. With the people at this node, they fit into one message to a page.
  static constexpr std::size_t kMaxPeople = 5000;

  struct Change {
    bool any = false;           // the lists differ in something other than cameras
    std::vector<Uuid> left;     // sessions that are no longer in a list
    std::vector<Uuid> cameras;  // sessions whose cameras have changed
  };
  // Replaces the list of this node. An empty list removes the node. Ignores people whose session is
  // in the list of another node, and people beyond kMaxPeople. If there are already kMaxNodes,
  // ignores the lists of other nodes.
  Change replace(const Uuid& node, std::vector<Presence> people, Clock::time_point now);
  // Removes the nodes whose last list is older than kSilentAfter.
  Change forget_silent(Clock::time_point now);

  bool empty() const { return nodes_.empty(); }
  bool has(const Uuid& session) const { return find(session) != nodes_.end(); }
  void each(const std::function<void(const Presence&)>& see) const;
  void each_at(const Uuid& node, const std::function<void(const Presence&)>& see) const;

 private:
  struct Node {
    std::map<Uuid, Presence> people;  // by session
    Clock::time_point received;       // time of the last list
  };
  using Nodes = std::map<Uuid, Node>;
  Nodes::const_iterator find(const Uuid& session) const;

  Nodes nodes_;
};

}  // namespace strata::room
