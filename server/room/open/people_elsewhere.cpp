#include "room/open/people_elsewhere.h"

#include <algorithm>
#include <utility>

namespace strata::room {
namespace {

// Ignores cameras.
bool is_same(const Presence& a, const Presence& b) {
  const bool same_pointer = a.pointer.has_value() == b.pointer.has_value() &&
                            (!a.pointer || (a.pointer->position == b.pointer->position &&
                                            a.pointer->radius == b.pointer->radius));
  return same_pointer && a.user == b.user && a.full_name == b.full_name && a.color == b.color &&
         a.leading == b.leading && a.following == b.following;
}

}  // namespace

PeopleElsewhere::Change PeopleElsewhere::replace(const Uuid& node, std::vector<Presence> people,
                                                 Clock::time_point now) {
  Change change;
  if (!nodes_.contains(node) && (people.empty() || nodes_.size() >= kMaxNodes)) return change;
  const auto before = std::exchange(nodes_[node].people, {});
  Node& current = nodes_[node];
  current.received = now;
  std::size_t count = 0;
  for (const auto& [id, other] : nodes_) count += other.people.size();
  for (Presence& person : people) {
    if (count == kMaxPeople) break;
    if (has(person.session)) continue;
    current.people.emplace(person.session, std::move(person));
    ++count;
  }
  for (const auto& [session, person] : before)
    if (!current.people.contains(session)) change.left.push_back(session);
  change.any = !change.left.empty() || current.people.size() != before.size();
  for (const auto& [session, person] : current.people) {
    const auto earlier = before.find(session);
    if (earlier == before.end()) continue;
    change.any = change.any || !is_same(earlier->second, person);
    if (person.camera != earlier->second.camera) change.cameras.push_back(session);
  }
  if (current.people.empty()) nodes_.erase(node);
  return change;
}

PeopleElsewhere::Change PeopleElsewhere::forget_silent(Clock::time_point now) {
  Change change;
  std::erase_if(nodes_, [&](const auto& entry) {
    const Node& node = entry.second;
    if (now - node.received <= kSilentAfter) return false;
    for (const auto& [session, person] : node.people) change.left.push_back(session);
    return true;
  });
  change.any = !change.left.empty();
  return change;
}

void PeopleElsewhere::each(const std::function<void(const Presence&)>& see) const {
  for (const auto& [id, node] : nodes_)
    for (const auto& [session, person] : node.people) see(person);
}

void PeopleElsewhere::each_at(const Uuid& node,
                              const std::function<void(const Presence&)>& see) const {
  const auto found = nodes_.find(node);
  if (found == nodes_.end()) return;
  for (const auto& [session, person] : found->second.people) see(person);
}

PeopleElsewhere::Nodes::const_iterator PeopleElsewhere::find(const Uuid& session) const {
  return std::ranges::find_if(
      nodes_, [&](const auto& entry) { return entry.second.people.contains(session); });
}

}  // namespace strata::room
