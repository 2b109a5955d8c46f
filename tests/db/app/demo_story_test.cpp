// The demo with its story: its content for a visitor, the times of the story, and the reset.
#include "app/demo/demo_story.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "app/template_registry.h"
#include "core/progress.h"
#include "store/content/comments.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/people/kiosks.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "strata_dirs.h"
#include "support/test_cluster.h"

namespace strata::app {
namespace {

using namespace std::chrono_literals;

class Demo : public ::testing::Test {
 protected:
  std::int64_t count(const std::string& from) {
    return store::PgConnection::connect(dsn_)
        ->query(("SELECT count(*) FROM " + from).c_str())
        ->integer(0, 0);
  }
  DemoStory make() {
    auto made = make_demo_story(*store_, *templates_, progress_, 0.1);
    EXPECT_TRUE(made) << made.error().detail;
    return made ? *made : DemoStory{};
  }
  Layer layer(const Model& model, const std::string& slug) {
    auto found = store_->layers().find(model.id, slug, Role::owner);
    EXPECT_TRUE(found) << slug;
    return found ? *found : Layer{};
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<store::Store> store_ = test::open_store(dsn_);
  Result<TemplateRegistry> templates_ =
      TemplateRegistry::load(std::filesystem::path(STRATA_SOURCE_DIR) / "templates");
  Progress progress_;
};

TEST_F(Demo, a_visitor_finds_a_history_a_review_records_comments_and_a_tour) {
  ASSERT_TRUE(templates_) << templates_.error().detail;
  const auto start = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const DemoStory story = make();
  EXPECT_TRUE(story.kiosk.starts_with("/kiosk/"));

  const Layer condition = layer(story.model, "condition");
  EXPECT_TRUE(condition.review);
  const auto history = store_->journal().history(condition.id, 100, 0);
  ASSERT_TRUE(history);
  const auto now = std::chrono::system_clock::now();
  std::set<std::string> people;
  int pending = 0;
  for (const auto& row : history->rows) {
    EXPECT_LT(row.time, now) << "the story has happened";
    EXPECT_GT(row.answer["texels_changed"].get<std::int64_t>(), 100) << row.record.dump();
    pending += row.review == Review::pending;
    people.insert(row.user);
  }
  EXPECT_EQ(pending, 3);
  EXPECT_GT(now - history->rows.back().time, 24h * 40) << "the first of them is weeks ago";
  EXPECT_TRUE(people.contains(kDemoConservator));

  const auto observations = store_->tables().find("observations", Role::owner);
  ASSERT_TRUE(observations);
  const auto records = store_->records().page(observations->id, Role::owner, {});
  ASSERT_TRUE(records);
  ASSERT_EQ(records->records.size(), 3u);
  const ColumnId photos = find_column(records->table.columns, "photos")->id;
  for (const Record& record : records->records)
    EXPECT_EQ(record.values.at(photos).size(), 1u) << "a photo each";

  const auto comments = store_->comments().of_model(story.model.id, Role::owner, {});
  ASSERT_TRUE(comments);
  ASSERT_EQ(comments->comments.size(), 4u) << "two threads with a reply each";
  EXPECT_NE(comments->comments[0].text.find("@lena.demo"), std::string::npos);
  EXPECT_GT(now - comments->comments[0].time, 24h * 10) << "its time is that of the story";
  EXPECT_TRUE(comments->comments[1].resolved);
  EXPECT_EQ(store_->views().of_model(story.model.id, 10, 0)->total, 3);
  EXPECT_EQ(store_->tours().of_model(story.model.id, 10, 0)->total, 1);
  EXPECT_EQ(count("activities WHERE time >= to_timestamp(" +
                  std::to_string(start.time_since_epoch().count()) + ")"),
            0)
      << "nothing of the story happened while it was made";
}

TEST_F(Demo, another_call_changes_nothing) {
  ASSERT_TRUE(templates_);
  const DemoStory story = make();
  const auto edits = count("edits"), tables = count("record_tables");
  const DemoStory again = make();
  EXPECT_EQ(again.model.id, story.model.id);
  EXPECT_TRUE(again.kiosk.empty());
  EXPECT_EQ(count("edits"), edits);
  EXPECT_EQ(count("record_tables"), tables);
}

TEST_F(Demo, a_reset_restores_the_beginning_and_keeps_what_is_not_of_the_demo) {
  ASSERT_TRUE(templates_);
  const DemoStory story = make();
  const auto edits = count("edits"), comments = count("comments");
  Table own;
  own.project_id = story.model.project_id;
  own.name = "Own";
  ASSERT_TRUE(store_->tables().create(own));
  store::Comment comment;
  comment.model_id = story.model.id;
  comment.user = "ada";
  comment.text = "To be lost.";
  comment.place = store::Comment::Place{};
  ASSERT_TRUE(store_->comments().create(comment));

  ModelId closed = 0;
  const auto erased = erase_demo_story(*store_, [&](ModelId model) { closed = model; });
  ASSERT_TRUE(erased) << erased.error().detail;
  EXPECT_EQ(closed, story.model.id);
  EXPECT_EQ(count("all_models"), 0);
  EXPECT_EQ(count("record_tables"), 1) << "the table of somebody else";

  const DemoStory fresh = make();
  EXPECT_EQ(fresh.model.slug, story.model.slug);
  EXPECT_EQ(count("edits"), edits);
  EXPECT_EQ(count("comments"), comments);
  EXPECT_EQ(count("users WHERE name LIKE '%.demo'"), 2);
}

TEST_F(Demo, a_reset_without_a_demo_does_nothing) {
  EXPECT_TRUE(erase_demo_story(*store_));
  EXPECT_EQ(count("all_models"), 0);
}

}  // namespace
}  // namespace strata::app
