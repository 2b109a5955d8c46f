#include "domain/tables/relation_cycles.h"

#include <algorithm>
#include <deque>
#include <unordered_map>

namespace strata {
namespace {

const std::vector<std::int64_t>& named_by(const Relation& relation, std::int64_t key) {
  static const std::vector<std::int64_t> none;
  const auto found = relation.find(key);
  return found == relation.end() ? none : found->second;
}

// Tarjan's search with an explicit stack, because a chain of relations can be as long as a table.
class Knots {
 public:
  explicit Knots(const Relation& relation) : relation_(relation) {}

  std::vector<std::vector<std::int64_t>> find() {
    for (const auto& [key, named] : relation_)
      if (!seen_.contains(key)) search(key);
    return std::move(knots_);
  }

 private:
  struct Node {
    std::size_t index = 0, lowest = 0;
    bool on_stack = true;
  };
  struct Step {
    std::int64_t key = 0;
    std::size_t next = 0;  // index of the next related key to visit
  };

  void enter(std::int64_t key) {
    const std::size_t index = seen_.size();
    seen_[key] = {index, index, true};
    stack_.push_back(key);
    path_.push_back({key, 0});
  }

  void search(std::int64_t root) {
    enter(root);
    while (!path_.empty()) {
      const std::int64_t key = path_.back().key;
      const auto& named = named_by(relation_, key);
      if (path_.back().next < named.size()) {
        const std::int64_t other = named[path_.back().next++];
        const auto known = seen_.find(other);
        if (known == seen_.end())
          enter(other);
        else if (known->second.on_stack)
          seen_[key].lowest = std::min(seen_[key].lowest, known->second.index);
        continue;
      }
      path_.pop_back();
      if (!path_.empty()) {
        Node& parent = seen_[path_.back().key];
        parent.lowest = std::min(parent.lowest, seen_[key].lowest);
      }
      if (seen_[key].lowest == seen_[key].index) close(key);
    }
  }

  void close(std::int64_t first) {
    std::vector<std::int64_t> knot;
    do {
      knot.push_back(stack_.back());
      seen_[stack_.back()].on_stack = false;
      stack_.pop_back();
    } while (knot.back() != first);
    const auto& named = named_by(relation_, first);
    if (knot.size() > 1 || std::find(named.begin(), named.end(), first) != named.end()) {
      std::sort(knot.begin(), knot.end());
      knots_.push_back(std::move(knot));
    }
  }

  const Relation& relation_;
  std::unordered_map<std::int64_t, Node> seen_;
  std::vector<std::int64_t> stack_;
  std::vector<Step> path_;
  std::vector<std::vector<std::int64_t>> knots_;
};

// Searches breadth-first from the component's lowest key for a key that refers back to this key.
std::vector<std::int64_t> shortest_cycle(const Relation& relation,
                                         const std::vector<std::int64_t>& knot) {
  const std::int64_t first = knot.front();
  std::unordered_map<std::int64_t, std::int64_t> from{{first, first}};
  std::deque<std::int64_t> waiting{first};
  for (; !waiting.empty(); waiting.pop_front()) {
    const std::int64_t key = waiting.front();
    for (const std::int64_t other : named_by(relation, key)) {
      if (other == first) {
        std::vector<std::int64_t> cycle;
        for (std::int64_t at = key; at != first; at = from.at(at)) cycle.push_back(at);
        cycle.push_back(first);
        std::reverse(cycle.begin(), cycle.end());
        return cycle;
      }
      if (std::binary_search(knot.begin(), knot.end(), other) && from.emplace(other, key).second)
        waiting.push_back(other);
    }
  }
  return {};
}

}  // namespace

std::vector<std::vector<std::int64_t>> relation_cycles(const Relation& relation) {
  std::vector<std::vector<std::int64_t>> cycles;
  for (const auto& knot : Knots(relation).find()) cycles.push_back(shortest_cycle(relation, knot));
  std::sort(cycles.begin(), cycles.end());
  return cycles;
}

}  // namespace strata
