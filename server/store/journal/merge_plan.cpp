#include "store/journal/merge_plan.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

namespace strata::store {
namespace {

constexpr std::chrono::seconds kLongestPause{60};  // within a stroke, if the list is cut

// The client of the author chooses the id of a stroke, so the same id from two users means two
// strokes.
using StrokeKey = std::tuple<LayerId, Uuid, std::string>;
StrokeKey key_of(const PlannedEdit& edit) { return {edit.layer, edit.stroke, edit.user}; }

struct Extent {
  std::int64_t first = 0, last = 0;
  std::chrono::system_clock::time_point time;  // of the last batch
};
using Extents = std::map<StrokeKey, Extent>;

Extents extents_of(std::span<const PlannedEdit> edits) {
  Extents extents;
  for (const PlannedEdit& edit : edits) {
    const auto [known, is_new] =
        extents.try_emplace(key_of(edit), Extent{edit.sequence, edit.sequence, edit.time});
    if (is_new) continue;
    known->second.last = edit.sequence;
    known->second.time = std::max(known->second.time, edit.time);
  }
  return extents;
}

// Returns the highest sequence for which all strokes that begin up to it have ended.
std::int64_t covered(std::span<const PlannedEdit> edits, const Extents& extents,
                     const MergeRules& rules) {
  const std::int64_t last = edits.back().sequence;
  auto ended_before = rules.ended_before;
  if (rules.is_cut) ended_before = std::min(ended_before, edits.back().time - kLongestPause);
  std::int64_t through = last;
  for (const auto& [key, extent] : extents)
    if (extent.time > ended_before) through = std::min(through, extent.first - 1);
  if (through < edits.front().sequence)
    // A stroke that is longer than the list is merged in parts.
    return rules.is_cut ? last : 0;
  // Avoids cutting ended strokes that overlap the next one. If strokes always overlap, some are
  // merged in two parts.
  std::int64_t before_strokes = through;
  for (bool is_stable = false; !is_stable;) {
    is_stable = true;
    for (const auto& [key, extent] : extents)
      if (extent.first <= before_strokes && extent.last > before_strokes) {
        before_strokes = extent.first - 1;
        is_stable = false;
      }
  }
  return before_strokes < edits.front().sequence ? through : before_strokes;
}

class Planner {
 public:
  Planner(const MergeRules& rules, const Extents& extents) : rules_(rules), extents_(extents) {}

  void add(std::size_t index, const PlannedEdit& edit) {
    end_all_before_named_state(edit.sequence);
    end_those_that_wrote(edit);
    extend(index, edit);
    // The state at the end of a stroke or edit stays exact, also on other layers.
    if (extents_.at(key_of(edit)).last == edit.sequence) end_all();
  }
  std::vector<std::vector<std::size_t>> finish() && {
    end_all();
    std::ranges::sort(groups_);
    return std::move(groups_);
  }

 private:
  struct Group {
    std::vector<std::size_t> edits;
    std::int64_t first = 0;
    std::string traits;
    std::vector<std::int16_t> tiles;  // ascending
    std::size_t revisions = 0, points = 0;
  };
  using Groups = std::map<StrokeKey, Group>;

  void extend(std::size_t index, const PlannedEdit& edit) {
    const StrokeKey key = key_of(edit);
    auto open = open_.find(key);
    if (open != open_.end() && (!edit.is_batch || open->second.traits != edit.traits ||
                                open->second.revisions + edit.tiles.size() > rules_.max_revisions ||
                                open->second.points + edit.points > rules_.max_points ||
                                edit.sequence - open->second.first > rules_.max_span)) {
      end(open);
      open = open_.end();
    }
    if (!edit.is_batch) return;
    if (open == open_.end())
      open = open_.emplace(key, Group{{}, edit.sequence, edit.traits, {}, 0, 0}).first;
    Group& group = open->second;
    group.edits.push_back(index);
    group.revisions += edit.tiles.size();
    group.points += edit.points;
    std::vector<std::int16_t> tiles;
    std::ranges::set_union(group.tiles, edit.tiles, std::back_inserter(tiles));
    group.tiles = std::move(tiles);
  }

  void end_those_that_wrote(const PlannedEdit& edit) {
    for (auto open = open_.begin(); open != open_.end();) {
      const auto next = std::next(open);
      if (open->first != key_of(edit) && std::get<LayerId>(open->first) == edit.layer) {
        const auto& tiles = open->second.tiles;
        if (std::ranges::any_of(edit.tiles, [&](std::int16_t tile) {
              return std::ranges::binary_search(tiles, tile);
            }))
          end(open);
      }
      open = next;
    }
  }

  void end_all_before_named_state(std::int64_t sequence) {
    // A named state from `last_` up to `sequence` - 1 contains the previous edit, but not this one.
    const auto named = std::ranges::lower_bound(rules_.named_states, last_);
    if (named != rules_.named_states.end() && *named < sequence) end_all();
    last_ = sequence;
  }

  Groups::iterator end(Groups::iterator open) {
    if (open->second.edits.size() > 1) groups_.push_back(std::move(open->second.edits));
    return open_.erase(open);
  }
  void end_all() {
    for (auto open = open_.begin(); open != open_.end();) open = end(open);
  }

  const MergeRules& rules_;
  const Extents& extents_;
  Groups open_;
  std::int64_t last_ = 0;  // sequence of the previous edit
  std::vector<std::vector<std::size_t>> groups_;
};

}  // namespace

MergePlan plan_merges(std::span<const PlannedEdit> edits, const MergeRules& rules) {
  MergePlan plan;
  if (edits.empty()) return plan;
  const Extents extents = extents_of(edits);
  plan.through = covered(edits, extents, rules);
  Planner planner(rules, extents);
  for (std::size_t i = 0; i < edits.size() && edits[i].sequence <= plan.through; ++i)
    planner.add(i, edits[i]);
  plan.groups = std::move(planner).finish();
  return plan;
}

}  // namespace strata::store
