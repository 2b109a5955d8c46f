#include "store/people/activity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/comments.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/members.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;
using test::Painter;

// Returns lines of the form "user kind op name ×count", newest first.
std::vector<std::string> lines_of(const ActivityPage& page) {
  std::vector<std::string> lines;
  for (const Activity& line : page.lines)
    lines.push_back((line.user.empty() ? "-" : line.user) + " " + line.kind + " " + line.op + " " +
                    line.name + " ×" + std::to_string(line.count));
  return lines;
}

template <class... Effect>
IdempotentResponse<Effect...> by(const std::string& user) {
  return {.key = {}, .make = {}, .user = user};
}

class ActivityOfAProject : public ::testing::Test {
 protected:
  ActivityOfAProject() { forget(); }
  void forget() { ASSERT_TRUE(connection_->query("DELETE FROM activities")); }
  void forget_made_layers() {
    ASSERT_TRUE(connection_->query("DELETE FROM activities WHERE kind = 'layer'"));
  }
  // Saves an edit whose time is the time of the first edit plus `after`.
  void edit(const Layer& layer, std::chrono::seconds after, const std::string& user,
            const std::string& op = "stroke", std::optional<Uuid> stroke = {}) {
    JournalEntry entry = Painter(layer, 1).entry(++sequence_, op, user);
    entry.time = begin_ + after;
    if (stroke) entry.stroke = *stroke;
    entry.answer["area_m2"] = 0.5;
    entries_.push_back(std::move(entry));
  }
  Layer new_layer(ModelId model, const std::string& name) {
    Layer layer;
    layer.model_id = model;
    layer.name = name;
    layer.palette = default_palette(layer.type, false);
    return store_->layers().create(layer, by<Layer>("ada")).value();
  }
  Table new_table() {
    Table table;
    table.project_id = 1;
    table.name = "Finds";
    return store_->tables().create(table, by<Table>("ada")).value();
  }
  void write_records(TableId table, std::size_t count, bool dry_run = false) {
    WriteRecords request;
    request.records.resize(count);
    request.dry_run = dry_run;
    ASSERT_TRUE(store_->records().write(table, request, "ada"));
  }
  void save() {
    JournalWriter writer(*store_, {});
    for (JournalEntry& entry : entries_)
      ASSERT_TRUE(
          writer.submit(std::move(entry), [](const Result<void>& saved) { EXPECT_TRUE(saved); }));
    writer.drain();
    entries_.clear();
  }
  ActivityPage page(ActivityQuery query = {}) {
    return store_->projects().activity(1, Role::curator, query).value();
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  const Model model_ = test::make_model(*store_);
  const Layer layer_ = test::make_layer(*store_, model_.id);
  const Layer other_ = test::make_layer(*store_, model_.id, ValueType::u8, "other");
  const std::chrono::system_clock::time_point begin_{1'777'896'000s};
  std::int64_t sequence_ = 0;
  std::vector<JournalEntry> entries_;
};

TEST_F(ActivityOfAProject, strokes_of_one_person_on_one_layer_within_ten_minutes_are_one_line) {
  const Uuid stroke = random_uuid();
  for (int batch = 0; batch < 5; ++batch) edit(layer_, 1s * batch, "ada", "stroke", stroke);
  edit(other_, 6s, "ada");
  edit(layer_, 7s, "bob");
  save();  // the same person continues the same stroke in another commit
  edit(layer_, 8s, "ada", "stroke", stroke);
  edit(layer_, 500s, "ada");
  save();
  edit(layer_, 1000s, "ada");
  edit(layer_, 1001s, "ada", "fill");
  save();
  edit(layer_, 1601s, "ada");
  save();
  const ActivityPage found = page();
  EXPECT_THAT(lines_of(found),
              ::testing::ElementsAre("ada edit stroke layer ×1", "ada edit fill layer ×1",
                                     "ada edit stroke layer ×3", "bob edit stroke layer ×1",
                                     "ada edit stroke other ×1"));
  const Activity& run = found.lines[2];
  EXPECT_EQ(run.begun, begin_);
  EXPECT_EQ(run.time, begin_ + 1000s);
  EXPECT_EQ(run.texels, 8 * 12);
  EXPECT_DOUBLE_EQ(run.area_m2.value(), 4);
  EXPECT_EQ(run.layer, layer_.id);
  EXPECT_EQ(run.model, model_.id);
  EXPECT_EQ(run.model_name, "pot");
  EXPECT_FALSE(found.next);
}

TEST_F(ActivityOfAProject, pages_have_every_line_once_whatever_their_size) {
  for (int i = 0; i < 40; ++i) {
    edit(i % 3 == 0 ? other_ : layer_, 700s * (i / 2), i % 2 == 0 ? "ada" : "bob",
         i % 5 == 0 ? "undo" : "stroke");
    if (i % 7 == 0) save();
  }
  save();
  std::vector<std::int64_t> all;
  for (const Activity& line : page({.limit = 1000}).lines) all.push_back(line.id);
  EXPECT_GT(all.size(), 30u);
  for (const int limit : {1, 3, 7}) {
    std::vector<std::int64_t> read;
    for (ActivityQuery query{.limit = limit};;) {
      const ActivityPage part = page(query);
      EXPECT_LE(part.lines.size(), static_cast<std::size_t>(limit));
      for (const Activity& line : part.lines) read.push_back(line.id);
      if (!part.next) break;
      query.before = part.next;
    }
    EXPECT_EQ(read, all) << limit;
  }
}

TEST_F(ActivityOfAProject, things_that_people_make_change_and_delete_are_told) {
  const Model second = test::make_model(*store_, "vase");
  Layer layer = new_layer(second.id, "cracks");
  layer.name = "Cracks";
  layer = store_->layers().update(layer, by<Layer>("ada")).value();
  layer.opacity = 0.5;
  layer.locked = true;
  layer = store_->layers().update(layer, by<Layer>("ada")).value();
  EXPECT_THAT(lines_of(page()),
              ::testing::ElementsAre("ada layer changed Cracks ×2", "ada layer created Cracks ×1",
                                     "- model created vase ×1"));
  EXPECT_THAT(page().lines[0].changed, ::testing::ElementsAre("locked", "name", "opacity"));
  layer.visible = !layer.visible;
  layer = store_->layers().update(layer).value();
  EXPECT_EQ(page().lines[0].count, 2) << "nobody asked for it";
  EXPECT_THAT(lines_of(page({.model = model_.id})), ::testing::IsEmpty());
  ASSERT_TRUE(store_->layers().remove(layer.id, by<>("bob")));
  const Activity gone = page().lines[0];
  EXPECT_EQ(lines_of(page())[0], "bob layer deleted Cracks ×1");
  EXPECT_FALSE(gone.layer);
  EXPECT_EQ(gone.model, second.id);
  ASSERT_TRUE(store_->models().remove(second.id, by<>("bob")));
  EXPECT_EQ(lines_of(page())[0], "bob model deleted vase ×1");
  EXPECT_FALSE(page().lines[0].model);
}

TEST_F(ActivityOfAProject, views_tours_and_snapshots_that_people_make_change_and_delete_are_told) {
  const auto tell = [&](NamedParts& parts, const std::string& name) {
    NamedPart part;
    part.model_id = model_.id;
    part.name = name;
    part.content = {{"light", "raking"}};
    part.user = "ada";
    part = parts.create(part, by<NamedPart>("ada")).value();
    part.text = "From the west";
    part.content = {{"light", "flat"}};
    part = parts.update(part, by<NamedPart>("bob")).value();
    part = parts.update(part, by<NamedPart>("bob")).value();  // an update without a change
    EXPECT_THAT(page().lines[0].changed, ::testing::ElementsAre("content", "text"));
    ASSERT_TRUE(parts.remove(part, by<>("bob")));
  };
  tell(store_->views(), "West wall");
  EXPECT_THAT(
      lines_of(page({.model = model_.id})),
      ::testing::ElementsAre("bob view deleted West wall ×1", "bob view changed West wall ×1",
                             "ada view created West wall ×1"));
  forget();
  tell(store_->tours(), "The pot");
  EXPECT_THAT(lines_of(page()),
              ::testing::ElementsAre("bob tour deleted The pot ×1", "bob tour changed The pot ×1",
                                     "ada tour created The pot ×1"));
  EXPECT_EQ(page().lines[0].model, model_.id);
  forget();
  tell(store_->snapshots(), "Before cleaning");
  EXPECT_THAT(lines_of(page()), ::testing::ElementsAre("bob snapshot deleted Before cleaning ×1",
                                                       "bob snapshot changed Before cleaning ×1",
                                                       "ada snapshot created Before cleaning ×1"));
}

TEST_F(ActivityOfAProject, a_layer_or_table_that_work_takes_back_never_was) {
  const Layer layer = new_layer(model_.id, "half");
  edit(layer, 0s, "ada", "import");
  save();
  EXPECT_EQ(page().lines.size(), 2u);
  ASSERT_TRUE(store_->layers().remove(layer.id));
  const Table table = new_table();
  ASSERT_TRUE(store_->tables().remove(table.id));
  EXPECT_THAT(lines_of(page()), ::testing::IsEmpty());
}

TEST_F(ActivityOfAProject, records_and_columns_are_told_and_their_record_where_it_is_one) {
  const Table table = new_table();
  Column weight;
  weight.name = "weight";
  ASSERT_TRUE(store_->tables().create_column(table.id, weight, "ada"));
  write_records(table.id, 1);
  EXPECT_THAT(lines_of(page()), ::testing::ElementsAre("ada records records Finds ×1",
                                                       "ada columns create-column Finds ×1",
                                                       "ada table created Finds ×1"));
  EXPECT_EQ(page().lines[0].record, 1);
  write_records(table.id, 2);
  EXPECT_EQ(page().lines[0].count, 3);
  EXPECT_FALSE(page().lines[0].record);
  EXPECT_EQ(page().lines[0].table, table.id);
  write_records(table.id, 1, true);
  EXPECT_EQ(page().lines[0].count, 3) << "a trial does nothing";
}

TEST_F(ActivityOfAProject, a_model_has_the_lines_of_the_tables_whose_records_lie_on_it) {
  const Table used = new_table();
  const Table unused = new_table();
  write_records(used.id, 1);
  write_records(unused.id, 1);
  edit(layer_, 0s, "ada");
  save();
  EXPECT_THAT(lines_of(page({.model = model_.id})),
              ::testing::ElementsAre("ada edit stroke layer ×1"));
  for (const char* name : {"units", "more units"}) {
    Layer layer;
    layer.model_id = model_.id;
    layer.name = name;
    layer.kind = LayerKind::database;
    layer.table = used.id;
    layer.palette = default_palette(layer.type, true);
    ASSERT_TRUE(store_->layers().create(layer));
  }
  forget_made_layers();
  EXPECT_THAT(lines_of(page({.model = model_.id})),
              ::testing::ElementsAre("ada records records Finds ×1", "ada table created Finds ×1",
                                     "ada edit stroke layer ×1"));
  std::vector<std::string> read;
  for (ActivityQuery query{.model = model_.id, .limit = 1};;) {
    const ActivityPage part = page(query);
    for (const std::string& line : lines_of(part)) read.push_back(line);
    query.before = part.next;
    if (!query.before) break;
  }
  EXPECT_EQ(read, lines_of(page({.model = model_.id})));
}

TEST_F(ActivityOfAProject, comments_are_told_while_they_stand) {
  Comment comment;
  comment.model_id = model_.id;
  comment.place = {{1, 2, 3}, {0, 0, 1}};
  comment.text = "Is this a crack? " + std::string(300, 'x');
  comment.user = "ada";
  Comment first = store_->comments().create(comment).value();
  Comment reply;
  reply.thread = first.id;
  reply.text = "Yes";
  reply.user = "bob";
  reply = store_->comments().create(reply).value();
  first.resolved = Comment::Resolution{"bob", {}};
  first = store_->comments().update(first).value();
  first.resolved.reset();
  first = store_->comments().update(first, by<Comment>("cyd")).value();
  EXPECT_THAT(lines_of(page()),
              ::testing::ElementsAre("cyd comment reopened  ×1", "bob comment resolved  ×1",
                                     "bob comment replied  ×1", "ada comment written  ×1"));
  EXPECT_EQ(page().lines[2].text, "Yes");
  EXPECT_EQ(page().lines[2].comment, reply.id);
  EXPECT_EQ(page().lines[3].text.size(), 200u);
  ASSERT_TRUE(store_->comments().remove(reply));
  EXPECT_EQ(page().lines.size(), 3u);
}

TEST_F(ActivityOfAProject, members_are_told_to_those_who_may_know_them) {
  ASSERT_TRUE(store_->accounts().create("Gus", "", Role::guest));
  ASSERT_TRUE(store_->members().put(1, "Gus", Role::viewer, "ada"));
  ASSERT_TRUE(store_->members().put(1, "Gus", Role::viewer, "ada"));  // no change
  ASSERT_TRUE(store_->members().put(1, "Gus", Role::curator, "ada"));
  ASSERT_TRUE(store_->members().remove(1, "Gus", "ada"));
  EXPECT_THAT(lines_of(page()), ::testing::IsEmpty());
  const ActivityPage known = page({.with_members = true});
  EXPECT_THAT(lines_of(known), ::testing::ElementsAre("ada member removed Default ×1",
                                                      "ada member changed Default ×1",
                                                      "ada member added Default ×1"));
  EXPECT_EQ(known.lines[1].person, "Gus");
  EXPECT_EQ(known.lines[1].role, "curator");
  EXPECT_EQ(known.lines[0].role, "");
}

TEST_F(ActivityOfAProject, lines_of_a_model_go_where_it_goes) {
  edit(layer_, 0s, "ada");
  save();
  Project villa;
  villa.name = "Villa";
  villa = store_->projects().create(villa, by<Project>("ada")).value();
  Model model = store_->models().find(to_string(model_.id)).value();
  model.project_id = villa.id;
  ASSERT_TRUE(store_->models().update(model, by<Model>("ada")));
  EXPECT_THAT(lines_of(page()), ::testing::IsEmpty());
  EXPECT_THAT(
      lines_of(store_->projects().activity(villa.id, Role::curator, {}).value()),
      ::testing::UnorderedElementsAre("ada model changed pot ×1", "ada project created Villa ×1",
                                      "ada edit stroke layer ×1"));
}

// The database finds the rows of a page in an index, and reads no other rows of a long history.
TEST_F(ActivityOfAProject, a_page_reads_no_more_of_a_long_history_than_it_tells) {
  ASSERT_TRUE(connection_->query(
      "INSERT INTO activities (project_id, model_id, subject, user_name, kind, op, begun, time) "
      "SELECT 1, 1 + n % 3, 'x', 'ada', 'edit', 'stroke', t, t FROM (SELECT n, timestamptz '2020-01-01' + n * interval "
      "'1 second' AS t FROM generate_series(1, 100000) n) r"));
  ASSERT_TRUE(connection_->query_once("VACUUM ANALYZE activities"));
  // A session reports its counts when it ends, or earlier.
  const auto rows_read = [&](std::int64_t at_least) {
    store_.reset();
    std::int64_t rows = 0;
    for (const auto until = std::chrono::steady_clock::now() + 60s;
         rows < at_least && std::chrono::steady_clock::now() < until;
         std::this_thread::sleep_for(20ms))
      rows =
          connection_
              ->query(
                  "SELECT seq_tup_read + coalesce(idx_tup_fetch, 0) FROM pg_stat_user_tables WHERE relname = "
                  "'activities'")
              ->integer(0, 0);
    store_ = test::open_store(dsn_);
    return rows;
  };
  const auto before = rows_read(0);
  const ActivityPage first = page({.limit = 50});
  ASSERT_EQ(first.lines.size(), 50u);
  ActivityPlace deep = first.next.value();
  deep.time_us -= 60'000 * std::int64_t{1'000'000};
  for (int i = 0; i < 10; ++i) {  // after some runs, PostgreSQL uses one plan for all positions
    ASSERT_EQ(page({.before = deep, .limit = 50}).lines.size(), 50u);
    ASSERT_EQ(page({.model = model_.id, .before = deep, .limit = 50}).lines.size(), 50u);
  }
  const int expected = 21 * 51;
  EXPECT_NEAR(static_cast<double>(rows_read(before + expected - 21) - before), expected, 100);
}

}  // namespace
}  // namespace strata::store
