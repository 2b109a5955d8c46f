#include "store/journal/thin_plan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <utility>

namespace strata::store {
namespace {

constexpr std::array<std::string_view, 4> kPeriods{"day", "week", "month", "year"};

// The number of the period that contains the time.
std::int64_t number_of(std::chrono::system_clock::time_point time, Period period) {
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date{day};
  switch (period) {
    case Period::day: break;
    // The first day of 1970 was a Thursday.
    case Period::week:
      return std::chrono::floor<std::chrono::weeks>(day + std::chrono::days(3))
          .time_since_epoch()
          .count();
    case Period::month: return int{date.year()} * 12 + static_cast<int>(unsigned{date.month()}) - 1;
    case Period::year: return int{date.year()};
  }
  return day.time_since_epoch().count();
}

class ThinPlanner {
 public:
  ThinPlanner(std::span<const OldEdit> edits, const ThinRules& rules)
      : edits_(edits), rules_(rules) {
    for (std::size_t i = 0; i < edits.size(); ++i) {
      Stroke& stroke = strokes_[{edits[i].layer, edits[i].stroke}];
      ++stroke.edits;
      stroke.last = i;
    }
  }

  void add(std::size_t index) {
    const OldEdit& edit = edits_[index];
    const std::int64_t period = number_of(edit.time, rules_.keep);
    if (period != period_ || is_named_before(edit.sequence) || edit.stays) end_all();
    period_ = period;
    last_ = edit.sequence;
    if (edit.stays) return;
    Group& group = open_[edit.layer];
    while (!group.edits.empty() && !fits(group, edit)) cut(group);
    put(group, index);
  }
  ThinPlan finish() && {
    end_all();
    std::ranges::sort(plan_.groups);
    return std::move(plan_);
  }

 private:
  struct Stroke {
    int edits = 0;
    std::size_t last = 0;
  };
  struct Group {
    std::vector<std::size_t> edits;
    std::size_t revisions = 0, answers = 0;
    std::size_t stroke_ends = 0;  // the last edit of all strokes of the group
    std::size_t complete = 0;     // its first edits, which no stroke continues
  };

  bool fits(const Group& group, const OldEdit& edit) const {
    return group.edits.size() < rules_.max_edits &&
           group.revisions + edit.revisions <= rules_.max_revisions &&
           group.answers + edit.answers <= rules_.max_answers;
  }
  void put(Group& group, std::size_t index) {
    const OldEdit& edit = edits_[index];
    group.edits.push_back(index);
    group.revisions += edit.revisions;
    group.answers += edit.answers;
    group.stroke_ends = std::max(group.stroke_ends, strokes_.at({edit.layer, edit.stroke}).last);
    if (group.stroke_ends == index) group.complete = group.edits.size();
  }
  // Ends the group at its last place between strokes. A stroke that exceeds the limits is divided.
  void cut(Group& group) {
    const std::size_t size = group.complete > 0 ? group.complete : group.edits.size();
    Group ended, rest;
    for (std::size_t i = 0; i < group.edits.size(); ++i)
      put(i < size ? ended : rest, group.edits[i]);
    end(ended);
    group = std::move(rest);
    plan_.is_cut = true;
  }

  // Returns whether a named state contains the previous edit, but not the one with this sequence.
  bool is_named_before(std::int64_t sequence) const {
    const auto named = std::ranges::lower_bound(rules_.named_states, last_);
    return named != rules_.named_states.end() && *named < sequence;
  }

  void end(Group& group) {
    if (group.edits.empty()) return;
    const auto effective =
        std::ranges::count_if(group.edits, [&](std::size_t i) { return edits_[i].is_effective; });
    const auto size = static_cast<std::ptrdiff_t>(group.edits.size());
    const std::ptrdiff_t left = effective == 0 || effective == size ? 1 : 2;
    if (size <= left) {
      // The last part of a stroke must not stay without the others, because undo would find only
      // this part.
      const auto is_part = [&](std::size_t i) {
        return strokes_.at({edits_[i].layer, edits_[i].stroke}).edits > 1;
      };
      if (!std::ranges::any_of(group.edits, is_part)) return;
    }
    plan_.removed += size - left;
    // The checkpoint has one revision for each tile, and most edits of a group write the same
    // tiles.
    std::size_t largest = 0;
    for (const std::size_t i : group.edits) largest = std::max(largest, edits_[i].revisions);
    plan_.removed_revisions += static_cast<std::int64_t>(group.revisions - largest);
    plan_.groups.push_back(std::move(group.edits));
  }
  void end_all() {
    for (auto& [layer, group] : open_) end(group);
    open_.clear();
  }

  const std::span<const OldEdit> edits_;
  const ThinRules& rules_;
  std::map<std::pair<LayerId, Uuid>, Stroke> strokes_;
  std::map<LayerId, Group> open_;
  std::int64_t period_ = 0, last_ = 0;  // of the previous edit
  ThinPlan plan_;
};

}  // namespace

std::string_view name(Period period) { return kPeriods[static_cast<std::size_t>(period)]; }

std::optional<Period> parse_period(std::string_view text) {
  const auto found = std::ranges::find(kPeriods, text);
  if (found == kPeriods.end()) return std::nullopt;
  return static_cast<Period>(found - kPeriods.begin());
}

std::optional<std::chrono::days> parse_age(std::string_view text) {
  using std::chrono::days;
  constexpr days kMax = std::chrono::ceil<days>(std::chrono::years(100));
  long count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  // A day is the shortest unit, so a larger number is too long with each unit. None overflows.
  if (error != std::errc() || end + 1 != text.data() + text.size() || count < 1 ||
      count > kMax.count())
    return std::nullopt;
  days age{};
  switch (*end) {
    case 'd': age = days(count); break;
    case 'w': age = std::chrono::weeks(count); break;
    case 'm': age = std::chrono::ceil<days>(std::chrono::months(count)); break;
    case 'y': age = std::chrono::ceil<days>(std::chrono::years(count)); break;
    default: return std::nullopt;
  }
  return age <= kMax ? std::optional(age) : std::nullopt;
}

std::size_t place_between_strokes(std::span<const OldEdit> edits) {
  // Strokes at the end may continue after it.
  const std::size_t most = edits.size() - edits.size() / 10;
  std::map<std::pair<LayerId, Uuid>, std::size_t> ends;
  for (std::size_t i = 0; i < edits.size(); ++i) ends[{edits[i].layer, edits[i].stroke}] = i + 1;
  std::size_t place = 0, end = 0;
  for (std::size_t i = 0; i < most; ++i) {
    end = std::max(end, ends.at({edits[i].layer, edits[i].stroke}));
    if (end == i + 1) place = end;
  }
  return place > 0 ? place : edits.size();
}

ThinPlan plan_thinning(std::span<const OldEdit> edits, const ThinRules& rules) {
  ThinPlanner planner(edits, rules);
  for (std::size_t i = 0; i < edits.size(); ++i) planner.add(i);
  return std::move(planner).finish();
}

}  // namespace strata::store
