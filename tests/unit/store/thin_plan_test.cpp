#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "store/journal/thin_plan.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::chrono::sys_days kMonday = std::chrono::year{2024} / 1 / 1;

// Edits with consecutive sequences. Each is a separate stroke.
class OldJournal {
 public:
  OldEdit& edit(std::chrono::system_clock::time_point time, LayerId layer = 1) {
    OldEdit edit;
    edit.sequence = static_cast<std::int64_t>(edits_.size()) + 1;
    edit.layer = layer;
    edit.stroke.bytes[0] = static_cast<std::uint8_t>(edit.sequence);
    edit.time = time;
    edit.revisions = 1;
    edits_.push_back(edit);
    return edits_.back();
  }
  // The groups, as sequences.
  std::vector<std::vector<std::int64_t>> groups(const ThinRules& rules = {}) const {
    std::vector<std::vector<std::int64_t>> found;
    for (const auto& group : plan_thinning(edits_, rules).groups) {
      found.emplace_back();
      for (const std::size_t i : group) found.back().push_back(edits_[i].sequence);
    }
    return found;
  }
  ThinPlan plan(const ThinRules& rules = {}) const { return plan_thinning(edits_, rules); }

 private:
  std::vector<OldEdit> edits_;
};

TEST(ThinPlan, the_edits_of_a_day_become_one) {
  OldJournal journal;
  for (const auto time : {1h, 2h, 23h, 24h, 25h, 49h}) journal.edit(kMonday + time);
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5)));
  EXPECT_EQ(journal.plan().removed, 3);
  EXPECT_FALSE(journal.plan().is_cut);
  EXPECT_THAT(plan_thinning({}, {}).groups, IsEmpty());
}

TEST(ThinPlan, weeks_begin_on_monday_and_months_and_years_follow_the_calendar) {
  const auto groups = [](Period keep, std::chrono::hours last_of,
                         std::chrono::hours first_of_next) {
    OldJournal journal;
    journal.edit(kMonday);
    journal.edit(kMonday + last_of);
    journal.edit(kMonday + first_of_next);
    journal.edit(kMonday + first_of_next + 1h);
    ThinRules rules;
    rules.keep = keep;
    return journal.groups(rules);
  };
  const auto expected = ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4));
  EXPECT_THAT(groups(Period::week, 7 * 24h - 1h, 7 * 24h), expected);
  EXPECT_THAT(groups(Period::month, 31 * 24h - 1h, 31 * 24h), expected);
  EXPECT_THAT(groups(Period::year, 366 * 24h - 1h, 366 * 24h), expected);
}

TEST(ThinPlan, each_layer_has_its_own_groups) {
  OldJournal journal;
  for (const LayerId layer : std::vector<LayerId>{1, 2, 1, 2, 3}) journal.edit(kMonday, layer);
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 3), ElementsAre(2, 4)));
}

TEST(ThinPlan, groups_of_all_layers_end_at_named_states_and_at_edits_that_stay) {
  OldJournal journal;
  for (const LayerId layer : std::vector<LayerId>{1, 2, 1, 2, 1, 2, 3, 1, 2, 1, 2})
    journal.edit(kMonday, layer);
  journal.edit(kMonday, 1).stays = true;
  journal.edit(kMonday, 1);
  ThinRules rules;
  rules.named_states = {4};
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 3), ElementsAre(2, 4),
                                                 ElementsAre(5, 8, 10), ElementsAre(6, 9, 11)));
}

TEST(ThinPlan, edits_that_were_undone_need_a_second_edit) {
  OldJournal journal;
  journal.edit(kMonday);
  journal.edit(kMonday).is_effective = false;
  EXPECT_THAT(journal.groups(), IsEmpty()) << "two edits would replace two";
  journal.edit(kMonday).is_effective = false;
  EXPECT_EQ(journal.plan().removed, 1);
  OldJournal undone;
  for (int i = 0; i < 3; ++i) undone.edit(kMonday).is_effective = false;
  EXPECT_EQ(undone.plan().removed, 2);
}

TEST(ThinPlan, limits_cut_a_group) {
  OldJournal journal;
  for (int i = 0; i < 6; ++i) journal.edit(kMonday).revisions = 2;
  ThinRules rules;
  rules.max_revisions = 4;
  EXPECT_THAT(journal.groups(rules),
              ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4), ElementsAre(5, 6)));
  EXPECT_TRUE(journal.plan(rules).is_cut);
  rules.max_revisions = 100;
  rules.max_edits = 3;
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5, 6)));
}

TEST(ThinPlan, limits_divide_a_stroke_only_if_it_exceeds_them) {
  OldJournal journal;
  Uuid stroke;
  stroke.bytes[15] = 1;
  journal.edit(kMonday);
  journal.edit(kMonday);
  for (int i = 0; i < 3; ++i) journal.edit(kMonday).stroke = stroke;
  journal.edit(kMonday);
  ThinRules rules;
  rules.max_edits = 4;
  EXPECT_THAT(journal.groups(rules), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4, 5, 6)));
  rules.max_edits = 2;
  EXPECT_THAT(journal.groups(rules),
              ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4), ElementsAre(5, 6)));
}

TEST(ThinPlan, no_part_of_a_stroke_stays_alone) {
  OldJournal journal;
  Uuid stroke;
  stroke.bytes[15] = 1;
  journal.edit(kMonday);
  for (const auto time : {23h, 23h, 24h}) journal.edit(kMonday + time).stroke = stroke;
  journal.edit(kMonday + 50h);
  EXPECT_THAT(journal.groups(), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4)));
}

TEST(ThinPlan, a_window_ends_between_two_strokes) {
  std::vector<OldEdit> edits(20);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    edits[i].layer = 1;
    edits[i].stroke.bytes[0] = static_cast<std::uint8_t>(i);
  }
  EXPECT_EQ(place_between_strokes(edits), 18u) << "the last strokes may continue";
  edits[15].stroke = edits[19].stroke;
  EXPECT_EQ(place_between_strokes(edits), 15u);
  edits[0].stroke = edits[19].stroke;
  EXPECT_EQ(place_between_strokes(edits), 20u);
  EXPECT_EQ(place_between_strokes(std::span(edits).first(1)), 1u);
}

TEST(ThinPlan, an_age_has_at_most_100_years) {
  using Days = std::chrono::days;
  EXPECT_EQ(parse_age("90d"), Days(90));
  EXPECT_EQ(parse_age("26w"), Days(182));
  EXPECT_EQ(parse_age("18m"), Days(548));
  EXPECT_EQ(parse_age("2y"), Days(731));
  EXPECT_EQ(parse_age("100y"), Days(36'525));
  for (const char* text : {"999y", "101y", "36500m", "5300w", "36526d", "99999999999999999999d",
                           "0d", "-1d", "1", "d", "", "1h", "1dd", " 1d"})
    EXPECT_FALSE(parse_age(text)) << text;
}

TEST(ThinPlan, periods_have_names) {
  for (const auto period : {Period::day, Period::week, Period::month, Period::year})
    EXPECT_EQ(parse_period(name(period)), period);
  EXPECT_FALSE(parse_period("hour"));
}

}  // namespace
}  // namespace strata::store
