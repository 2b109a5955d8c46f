// Undo of rows, compared with an oracle that keeps the list of edits of every cell.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "domain/tables/cell_history.h"

namespace strata {
namespace {

using nlohmann::json;

// One row with many edits, which are undone and redone in any order.
class OneRow {
 public:
  void write(const Cells& written) {
    Cells before;
    for (const auto& [name, value] : written) {
      before[name] = value_of(name);
      writes_[name].push_back({next_, value});
      now_[name] = value;
    }
    push(true, std::move(before), written);
  }

  void flip(std::int64_t sequence, bool in_force) {
    std::set<std::string> names;
    for (auto& entry : newest_first_)
      if (entry.sequence == sequence) {
        entry.in_force = in_force;
        for (const auto& [name, value] : entry.after) names.insert(name);
      }
    undone_[sequence] = !in_force;
    CellResolver resolver(names);
    for (const auto& entry : newest_first_) resolver.add(entry);
    EXPECT_FALSE(resolver.is_open() && newest_first_.empty());
    Cells after = std::move(resolver).finish(), before;
    for (const auto& name : names) before[name] = value_of(name);
    for (const auto& [name, value] : after) now_[name] = value;
    push(false, std::move(before), std::move(after));
  }

  std::vector<std::int64_t> writers() const {
    std::vector<std::int64_t> found;
    for (const auto& entry : newest_first_)
      if (entry.writer) found.push_back(entry.sequence);
    return found;
  }
  bool is_undone(std::int64_t sequence) const {
    const auto found = undone_.find(sequence);
    return found != undone_.end() && found->second;
  }

  void expect_equals_oracle() const {
    for (const auto& [name, writes] : writes_) {
      json expected;
      for (const auto& [sequence, value] : writes)
        if (!is_undone(sequence)) expected = value;
      ASSERT_EQ(value_of(name), expected) << name;
    }
  }

 private:
  json value_of(const std::string& name) const {
    const auto found = now_.find(name);
    return found == now_.end() ? json() : found->second;
  }
  void push(bool writer, Cells before, Cells after) {
    newest_first_.insert(newest_first_.begin(),
                         {next_++, writer, true, std::move(before), std::move(after)});
  }

  std::int64_t next_ = 1;
  std::vector<PastCells> newest_first_;
  std::map<std::int64_t, bool> undone_;
  std::map<std::string, std::vector<std::pair<std::int64_t, json>>> writes_;
  Cells now_;
};

TEST(CellHistory, undoing_an_edit_leaves_what_others_wrote_over_it) {
  OneRow row;
  row.write({{"a", 1}, {"b", 1}});
  row.write({{"b", 2}});
  row.flip(1, false);
  row.expect_equals_oracle();  // a has no value, b is 2
  row.flip(2, false);
  row.expect_equals_oracle();  // b has no value, because both edits are undone
  row.flip(1, true);
  row.expect_equals_oracle();
}

TEST(CellHistory, random_edits_undone_and_redone_in_any_order_follow_the_rule) {
  std::mt19937 random(11);
  const std::string names[] = {"a", "b", "c", "d"};
  for (int round = 0; round < 200; ++round) {
    OneRow row;
    for (int step = 0; step < 40; ++step) {
      const auto writers = row.writers();
      if (writers.empty() || random() % 2) {
        Cells written;
        for (const auto& name : names)
          if (random() % 2) written[name] = random() % 4 ? json(random() % 3) : json();
        row.write(written);
      } else {
        const auto sequence = writers[random() % writers.size()];
        row.flip(sequence, row.is_undone(sequence));
      }
      row.expect_equals_oracle();
      if (HasFatalFailure()) return;
    }
  }
}

TEST(CellHistory, older_entries_are_not_asked_for_once_every_author_is_found) {
  CellResolver resolver({"a"});
  EXPECT_TRUE(resolver.is_open());
  resolver.add({3, false, true, {{"a", 1}}, {{"a", 9}}});
  EXPECT_TRUE(resolver.is_open());
  resolver.add({2, true, true, {{"a", 0}, {"b", 0}}, {{"a", 5}, {"b", 6}}});
  EXPECT_FALSE(resolver.is_open());
  resolver.add({1, true, true, {}, {{"a", 7}}});
  EXPECT_EQ(std::move(resolver).finish(), (Cells{{"a", 5}}));
}

}  // namespace
}  // namespace strata
