#include "app/strokes/record_edit_locks.h"

#include <gtest/gtest.h>

#include <map>

namespace strata::app {
namespace {

using Record = RecordEditLocks::Record;

struct Editors : testing::Test {
  // Stores the editors by project and record, like a listener that receives all notifications.
  const RecordEditLocks::Tell tell = [this](ProjectId project,
                                            const std::vector<RecordEditLocks::Entry>& entries) {
    ++calls;
    for (const auto& [record, editor] : entries) {
      known.erase({project, record});
      if (editor) known[{project, record}] = editor->user;
    }
  };
  bool begin(const Record& record, const RecordEditLocks::Editor& editor, bool take_over = false,
             ProjectId project = 1) {
    return book.begin(project, record, editor, take_over, tell).has_value();
  }
  std::string at(const Record& record, ProjectId project = 1) { return known[{project, record}]; }

  RecordEditLocks book;
  std::map<std::pair<ProjectId, Record>, std::string> known;
  int calls = 0;
  const RecordEditLocks::Editor ada{random_uuid(), "ada"}, bea{random_uuid(), "bea"};
};

TEST_F(Editors, the_first_one_has_the_record_until_it_is_left) {
  EXPECT_TRUE(begin({4, 7}, ada));
  EXPECT_EQ(at({4, 7}), "ada");
  EXPECT_TRUE(begin({4, 7}, bea));
  EXPECT_EQ(at({4, 7}), "ada");
  book.end({4, 7}, bea.session, tell);
  EXPECT_EQ(at({4, 7}), "ada") << "somebody else ended it";
  EXPECT_EQ(calls, 1);
  book.end({4, 7}, ada.session, tell);
  EXPECT_EQ(at({4, 7}), "");
  EXPECT_TRUE(begin({4, 7}, bea));
  EXPECT_EQ(at({4, 7}), "bea");
}

TEST_F(Editors, what_is_said_again_is_not_told_again) {
  begin({4, 7}, ada);
  begin({4, 7}, ada);
  begin({4, 7}, ada, true);
  EXPECT_EQ(calls, 1);
  book.end({4, 7}, ada.session, tell);
  book.end({4, 7}, ada.session, tell);
  EXPECT_EQ(calls, 2);
}

TEST_F(Editors, who_takes_over_has_it_and_the_end_of_the_other_changes_nothing) {
  begin({4, 7}, ada);
  EXPECT_TRUE(begin({4, 7}, bea, true));
  EXPECT_EQ(at({4, 7}), "bea");
  book.end({4, 7}, ada.session, tell);
  book.leave(ada.session, tell);
  EXPECT_EQ(at({4, 7}), "bea");
  EXPECT_EQ(calls, 2);
}

TEST_F(Editors, two_windows_of_one_person_are_two_editors) {
  begin({4, 7}, ada);
  const RecordEditLocks::Editor again{random_uuid(), "ada"};
  begin({4, 7}, again);
  book.end({4, 7}, again.session, tell);
  EXPECT_EQ(at({4, 7}), "ada");
}

TEST_F(Editors, who_leaves_leaves_all_of_them) {
  begin({4, 7}, ada);
  begin({4, 8}, ada);
  begin({9, 7}, ada, false, 2);
  begin({4, 9}, bea);
  calls = 0;
  book.leave(ada.session, tell);
  EXPECT_EQ(calls, 2) << "once a project";
  EXPECT_EQ(known.size(), 1u);
  EXPECT_EQ(at({4, 9}), "bea");
  book.leave(ada.session, tell);
  EXPECT_EQ(calls, 2);
}

TEST_F(Editors, who_comes_hears_what_there_is_in_the_project) {
  begin({4, 7}, ada);
  begin({4, 8}, bea);
  begin({9, 7}, bea, false, 2);
  known.clear();
  book.list(1, tell);
  EXPECT_EQ(known.size(), 2u);
  EXPECT_EQ(at({4, 7}), "ada");
  EXPECT_EQ(at({4, 8}), "bea");
  calls = 0;
  book.list(3, tell);
  EXPECT_EQ(calls, 0);
}

TEST_F(Editors, a_connection_has_so_many_records_and_no_more) {
  const auto most = static_cast<std::int64_t>(RecordEditLocks::kMaxOfSession);
  for (std::int64_t key = 0; key < most; ++key) EXPECT_TRUE(begin({4, key}, ada));
  EXPECT_TRUE(begin({4, 0}, ada)) << "one that it has is no more";
  const auto refused = book.begin(1, {4, most}, ada, false, tell);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "key");
  EXPECT_TRUE(begin({4, most}, bea));
  EXPECT_FALSE(begin({4, most}, ada, true)) << "nor by taking over";
  EXPECT_EQ(at({4, most}), "bea");
  book.end({4, 0}, ada.session, tell);
  EXPECT_TRUE(begin({4, most}, ada, true));
}

}  // namespace
}  // namespace strata::app
