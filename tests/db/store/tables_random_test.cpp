// Random edits by three users on two tables, with undo and redo, compared with a model in plain
// C++: a cell has the value of the newest edit in force that wrote it.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using nlohmann::json;

struct Cell {
  std::int64_t key = 0;  // 0: the cell belongs to the column
  ColumnId column;       // 0: the cell stores whether the record exists
  auto operator<=>(const Cell&) const = default;
};

// The model: every edit with the cells that it wrote.
class Oracle {
 public:
  struct Edit {
    std::string user;
    std::map<Cell, json> cells;
    bool in_force = true;
    int undone_by = 0;
  };

  void write(const std::string& user, std::map<Cell, json> cells) {
    edits_.push_back({user, std::move(cells)});
    edits_.back().undone_by = 0;
    ++sequence_;
    at_.push_back(sequence_);
  }
  Edit* undoable(const std::string& user) {
    for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit)
      if (edit->user == user && edit->in_force) return &*edit;
    return nullptr;
  }
  Edit* redoable(const std::string& user) {
    Edit* last = nullptr;
    for (Edit& edit : edits_)
      if (edit.user == user && !edit.in_force && (!last || edit.undone_by > last->undone_by))
        last = &edit;
    if (!last) return nullptr;
    for (std::size_t i = 0; i < edits_.size(); ++i)
      if (edits_[i].user == user && edits_[i].in_force && at_[i] > last->undone_by) return nullptr;
    return last;
  }
  void flip(Edit& edit, bool in_force) {
    ++sequence_;
    edit.in_force = in_force;
    edit.undone_by = in_force ? 0 : sequence_;
  }
  json value(const Cell& cell) const {
    for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit)
      if (edit->in_force)
        if (const auto found = edit->cells.find(cell); found != edit->cells.end())
          return found->second;
    return nullptr;
  }
  // Returns {key: {column: value}} for existing records and shown columns.
  json content(const std::vector<ColumnId>& columns, std::int64_t greatest_key) const {
    json all = json::object();
    for (std::int64_t key = 1; key <= greatest_key; ++key) {
      if (value({key, 0}) != true) continue;
      json& values = all[std::to_string(key)] = json::object();
      for (const auto column : columns)
        if (is_shown(column))
          if (const json held = value({key, column}); !held.is_null())
            values[to_string(column)] = held;
    }
    return all;
  }
  bool is_shown(ColumnId column) const { return value({0, column}) == true; }
  int sequence() const { return sequence_; }

 private:
  std::vector<Edit> edits_;
  std::vector<int> at_;
  int sequence_ = 0;
};

class RandomWork {
 public:
  explicit RandomWork(unsigned seed) : random_(seed) {
    Table table;
    table.project_id = 1;
    table.name = "Units";
    table_ = store_->tables().create(table)->id;
  }

  void step() {
    const std::string user(1, static_cast<char>('a' + random_() % 3));
    switch (random_() % 10) {
      case 0: return create_column(user);
      case 1: return drop_column(user);
      case 2: return delete_record(user);
      case 3:
      case 4: return flip(user, false);
      case 5: return flip(user, true);
      default: return write(user);
    }
  }

  void expect_same() {
    const json expected = oracle_.content(columns_, greatest_key_);
    ASSERT_EQ(content({}), expected);
    past_.resize(static_cast<std::size_t>(oracle_.sequence()) + 1, expected);
    const auto at = random_() % past_.size();
    ASSERT_EQ(content(static_cast<std::int64_t>(at)), past_[at]) << "at " << at;
    const Table table = store_->tables().find(to_string(table_), Role::owner).value();
    ASSERT_EQ(table.sequence, oracle_.sequence());
    ASSERT_EQ(table.records, static_cast<std::int64_t>(expected.size()));
  }

 private:
  json content(std::optional<std::int64_t> at) {
    auto page = store_->records().page(table_, Role::owner, {{}, {}, at, 1000, 0});
    EXPECT_TRUE(page) << page.error().detail;
    json all = json::object();
    if (!page) return all;
    for (const Record& record : page->records) {
      json& values = all[std::to_string(record.key)] = json::object();
      for (const Column& column : page->table.columns)
        if (const auto value = record.values.find(column.id);
            value != record.values.end() && !value->second.is_null())
          values[to_string(column.id)] = value->second;
    }
    return all;
  }

  std::vector<ColumnId> shown() const {
    std::vector<ColumnId> found;
    for (const auto column : columns_)
      if (oracle_.is_shown(column)) found.push_back(column);
    return found;
  }
  std::vector<std::int64_t> records() const {
    std::vector<std::int64_t> found;
    for (std::int64_t key = 1; key <= greatest_key_; ++key)
      if (oracle_.value({key, 0}) == true) found.push_back(key);
    return found;
  }

  void create_column(const std::string& user) {
    if (columns_.size() > 20) return;
    Column column;
    column.name = "c" + std::to_string(columns_.size());
    column.kind = ColumnKind::integer;
    if (random_() % 2) column.default_value = 7;
    const auto change = store_->tables().create_column(table_, column, user);
    ASSERT_TRUE(change) << change.error().detail;
    const auto id = change->table.columns.back().id;
    std::map<Cell, json> cells{{{0, id}, true}};
    if (!column.default_value.is_null())
      for (const auto key : records()) cells[{key, id}] = 7;
    defaults_[id] = column.default_value;
    columns_.push_back(id);
    oracle_.write(user, std::move(cells));
  }

  void drop_column(const std::string& user) {
    const auto choice = shown();
    if (choice.empty()) return;
    const auto id = choice[random_() % choice.size()];
    ASSERT_TRUE(store_->tables().drop_column(table_, id, {}, user));
    oracle_.write(user, {{{0, id}, false}});
  }

  void write(const std::string& user) {
    WriteRecords request;
    std::map<Cell, json> cells;
    const auto there = records();
    std::set<std::int64_t> named;
    for (unsigned i = 0, count = 1 + random_() % 3; i < count; ++i) {
      RecordInput input;
      std::int64_t key = greatest_key_ + 1;
      if (!there.empty() && random_() % 2) key = there[random_() % there.size()];
      if (!named.insert(key).second) continue;
      const bool is_new = key > greatest_key_;
      if (!is_new || random_() % 2) input.key = key;
      greatest_key_ = std::max(greatest_key_, key);
      if (is_new) cells[{key, 0}] = true;
      for (const auto column : shown()) {
        if (random_() % 3 == 0) continue;
        const json value = random_() % 4 ? json(random_() % 5) : json();
        input.values[column] = value;
        if (is_new || value != oracle_.value({key, column})) cells[{key, column}] = value;
      }
      if (is_new)
        for (const auto column : shown())
          if (!input.values.contains(column)) cells[{key, column}] = defaults_[column];
      request.records.push_back(std::move(input));
    }
    const auto change = store_->records().write(table_, request, user);
    ASSERT_TRUE(change && change->problems.empty());
    ASSERT_EQ(change->sequence > 0, !cells.empty());
    if (!cells.empty()) oracle_.write(user, std::move(cells));
  }

  void delete_record(const std::string& user) {
    const auto there = records();
    if (there.empty()) return;
    const auto key = there[random_() % there.size()];
    ASSERT_TRUE(store_->records().remove(table_, key, {}, user));
    std::map<Cell, json> cells{{{key, 0}, false}};
    for (const auto column : columns_) cells[{key, column}] = nullptr;
    oracle_.write(user, std::move(cells));
  }

  void flip(const std::string& user, bool redo) {
    Oracle::Edit* edit = redo ? oracle_.redoable(user) : oracle_.undoable(user);
    const auto plan = store_->tables().plan_undo(table_, user, redo);
    ASSERT_EQ(plan.has_value(), edit != nullptr) << (plan ? "" : plan.error().detail);
    if (!edit) return;
    const auto before = records();
    oracle_.flip(*edit, redo);
    const auto after = records();
    std::vector<std::int64_t> gone;
    std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                        std::back_inserter(gone));
    EXPECT_EQ(plan->vanishing, gone);
    const auto change = store_->tables().undo(table_, user, redo, plan->table_sequence);
    ASSERT_TRUE(change) << change.error().detail;
  }

  std::unique_ptr<Store> store_ = test::fresh_store();
  std::mt19937 random_;
  TableId table_;
  Oracle oracle_;
  std::vector<ColumnId> columns_;
  std::map<ColumnId, json> defaults_;
  std::int64_t greatest_key_ = 0;
  std::vector<json> past_{json::object()};
};

class TablesAtRandom : public ::testing::TestWithParam<unsigned> {};

TEST_P(TablesAtRandom, every_cell_shows_the_newest_edit_in_force) {
  RandomWork work(GetParam());
  for (int step = 0; step < 120; ++step) {
    work.step();
    if (HasFatalFailure()) return;
    work.expect_same();
    if (HasFatalFailure()) FAIL() << "step " << step;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, TablesAtRandom, ::testing::Range(1u, 6u));

}  // namespace
}  // namespace strata::store
