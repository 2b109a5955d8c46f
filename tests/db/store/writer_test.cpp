#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <future>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/layers.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using test::Painter;
using test::save;
using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

using Answer = std::optional<ErrorCode>;
constexpr Answer kSaved = std::nullopt;

class Writer : public ::testing::Test {
 protected:
  // Submits an entry and records the result: no value, or the code of its error.
  void submit(JournalWriter& writer, JournalEntry entry) {
    ASSERT_TRUE(writer.submit(std::move(entry), [this](Result<void> result) {
      std::lock_guard lock(mutex_);
      answers_.push_back(result ? kSaved : Answer(result.error().code));
      last_problem_ = result ? Error{} : result.error();
    }));
  }
  std::int64_t count(const char* sql) {
    return PgConnection::connect(dsn_)->query(sql)->integer(0, 0);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
  Layer layer_ = test::make_layer(*store_, model_.id);
  Painter painter_{layer_, 5};
  std::mutex mutex_;
  std::vector<Answer> answers_;
  Error last_problem_;
};

// Makes the writer wait at its next transaction on a model, so later submissions form one group.
class HeldModel {
 public:
  HeldModel(const std::string& dsn, ModelId id)
      : connection_(std::move(PgConnection::connect(dsn).value())) {
    EXPECT_TRUE(connection_.script("BEGIN; SELECT 1 FROM models WHERE id = " + to_string(id) +
                                   " FOR UPDATE"));
  }
  void wait_until_someone_waits() {
    for (int i = 0; i < 6000; ++i) {
      if (connection_.query("SELECT count(*) FROM pg_locks WHERE NOT granted")->integer(0, 0) > 0)
        return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "nobody waits";
  }
  void release() { EXPECT_TRUE(connection_.script("COMMIT")); }

 private:
  PgConnection connection_;
};

TEST_F(Writer, answers_come_in_the_order_of_submission_after_the_commit) {
  JournalWriter writer(*store_, {});
  std::vector<int> order;
  auto reader = test::open_store(dsn_, 1);
  for (int i = 1; i <= 50; ++i)
    ASSERT_TRUE(writer.submit(painter_.paint(i, 1, 4), [&, i](const Result<void>& result) {
      EXPECT_TRUE(result);
      EXPECT_GE(reader->journal().last_sequence(model_.id).value(), i);
      order.push_back(i);
    }));
  writer.drain();
  ASSERT_EQ(order.size(), 50u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST_F(Writer, readers_can_wait_for_a_commit_whose_writer_has_given_up) {
  HeldModel held(dsn_, model_.id);
  auto waiting =
      std::async(std::launch::async, [&] { return store_->journal().wait_for_commits(model_.id); });
  held.wait_until_someone_waits();
  EXPECT_EQ(waiting.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  held.release();
  EXPECT_TRUE(waiting.get());
  EXPECT_TRUE(store_->journal().wait_for_commits(model_.id));
}

TEST_F(Writer, destruction_writes_what_waits) {
  {
    JournalWriter writer(*store_, {});
    for (int i = 1; i <= 100; ++i) submit(writer, painter_.paint(i, 1, 4));
  }
  EXPECT_EQ(answers_, std::vector<Answer>(100, kSaved));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 100);
}

TEST_F(Writer, an_entry_that_an_earlier_try_committed_counts_as_saved) {
  const auto entry = painter_.paint(1, 2, 4);
  const auto next = painter_.paint(2, 2, 4);
  {
    JournalWriter first(*store_, {});
    submit(first, entry);
  }
  JournalWriter second(*store_, {});
  submit(second, entry);  // like a repeat after a commit whose result was lost
  submit(second, next);
  second.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved, kSaved, kSaved));
  EXPECT_EQ(count("SELECT count(*) FROM edits"), 2);
  EXPECT_TRUE(test::content_of(store_->journal().load_tiles(layer_).value()) == painter_.content());
}

TEST_F(Writer, an_edit_made_on_top_of_one_that_was_not_saved_is_refused_while_others_are_saved) {
  const Model other_model = test::make_model(*store_, "other");
  Painter other(test::make_layer(*store_, other_model.id), 9);
  JournalWriter writer(*store_, {});
  HeldModel held(dsn_, model_.id);
  submit(writer, painter_.paint(1, 1, 4));
  held.wait_until_someone_waits();
  auto bad = painter_.paint(2, 1, 4);
  bad.record["text"] = "\xff";  // not valid UTF-8, so it can never be stored
  submit(writer, bad);
  submit(writer, other.paint(1, 1, 4));
  submit(writer, painter_.paint(3, 1, 4));
  submit(writer, other.paint(2, 1, 4));
  held.release();
  writer.drain();
  submit(writer, painter_.paint(4, 1, 4));  // based on the state that was not saved
  submit(writer, painter_.entry(2));        // the room has returned to the saved state
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved, ErrorCode::malformed, kSaved, ErrorCode::malformed,
                                    kSaved, ErrorCode::conflict, kSaved));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);
  EXPECT_EQ(store_->journal().last_sequence(other_model.id).value(), 2);
  EXPECT_TRUE(test::content_of(store_->journal().load_tiles(other.layer()).value()) ==
              other.content());
  EXPECT_TRUE(writer.accepting());
}

TEST_F(Writer, a_transaction_sums_each_tile_once_after_its_newest_edit) {
  JournalWriter writer(*store_, {});
  HeldModel held(dsn_, model_.id);
  std::vector<std::pair<std::uint16_t, std::uint64_t>> summed;  // tile, edit
  const auto paint = [&](std::uint64_t sequence, std::uint16_t tile) {
    JournalEntry entry = painter_.paint(static_cast<std::int64_t>(sequence), 1, 1);
    entry.revisions.front().tile = {tile, 0};
    entry.sum_tile = [&summed, sequence](TileAddress address) {
      summed.emplace_back(address.x, sequence);
      return std::vector<KeySum>{{.key = 1, .texels = sequence}};
    };
    submit(writer, std::move(entry));
  };
  paint(1, 0);
  held.wait_until_someone_waits();
  summed.clear();  // the first edit is a transaction of its own
  paint(2, 0);
  paint(3, 1);
  paint(4, 0);
  paint(5, 0);
  held.release();
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved, kSaved, kSaved, kSaved, kSaved));
  EXPECT_THAT(summed, UnorderedElementsAre(Pair(0, 5), Pair(1, 3)));
  EXPECT_EQ(count("SELECT texels[1] FROM tile_sums WHERE tile_x = 0"), 5);
  EXPECT_EQ(count("SELECT texels[1] FROM tile_sums WHERE tile_x = 1"), 3);
}

TEST_F(Writer, entries_that_can_never_be_written_fail_at_once) {
  JournalWriter writer(*store_, {});
  submit(writer, painter_.entry(2));  // a gap
  auto unknown_layer = painter_.entry(1);
  unknown_layer.layer_id = 99;
  submit(writer, unknown_layer);
  auto unknown_model = painter_.entry(1);
  unknown_model.model_id = 99;
  submit(writer, unknown_model);
  auto nul = painter_.entry(1);
  nul.answer["text"] = std::string("a\0b", 3);
  submit(writer, nul);
  auto user = painter_.entry(1);
  user.user = "\xc0";
  submit(writer, user);
  auto outside = painter_.paint(1, 1, 1);
  outside.revisions[0].tile = {200, 0};
  submit(writer, outside);
  auto twice = painter_.paint(1, 1, 1);
  twice.revisions.push_back(twice.revisions[0]);
  submit(writer, twice);
  const auto good = painter_.entry(1);
  submit(writer, good);
  auto same_id = painter_.entry(2);
  same_id.id = good.id;
  submit(writer, same_id);
  submit(writer, painter_.entry(2));
  writer.drain();
  EXPECT_THAT(answers_,
              ElementsAre(ErrorCode::conflict, ErrorCode::conflict, ErrorCode::conflict,
                          ErrorCode::malformed, ErrorCode::malformed, ErrorCode::malformed,
                          ErrorCode::conflict, kSaved, ErrorCode::conflict, kSaved));
  EXPECT_EQ(count("SELECT count(*) FROM edits"), 2);
  EXPECT_EQ(count("SELECT count(*) FROM tile_revisions"), 0);
}

TEST_F(Writer, a_layer_deleted_under_a_waiting_edit_fails_that_edit_only) {
  const Layer second = test::make_layer(*store_, model_.id, ValueType::u8, "second");
  Painter doomed(second, 4);
  JournalWriter writer(*store_, {});
  submit(writer, doomed.paint(1, 1, 2));
  writer.drain();
  ASSERT_TRUE(store_->layers().remove(second.id));
  submit(writer, doomed.paint(2, 1, 2));
  writer.drain();
  submit(writer, painter_.paint(2, 1, 2));
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved, ErrorCode::conflict, kSaved));
}

TEST_F(Writer, a_full_disk_is_waited_for_and_then_told) {
  ASSERT_TRUE(PgConnection::connect(dsn_)->script(
      "CREATE FUNCTION full_disk() RETURNS trigger LANGUAGE plpgsql AS "
      "'BEGIN RAISE EXCEPTION ''could not extend file'' USING ERRCODE = ''53100''; END'; "
      "CREATE TRIGGER full_disk BEFORE INSERT ON edits FOR EACH STATEMENT EXECUTE FUNCTION full_disk()"));
  JournalWriter writer(*store_, {.retry_for = std::chrono::milliseconds(400)});
  submit(writer, painter_.paint(1, 1, 2));
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(ErrorCode::storage_full));
  EXPECT_NE(last_problem_.detail.find("disk is full"), std::string::npos) << last_problem_.detail;

  JournalWriter patient(*store_, {});
  const auto entry = painter_.entry(1);
  submit(patient, entry);
  while (patient.accepting()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_FALSE(patient.submit(painter_.entry(2), [](auto) { ADD_FAILURE(); }));
  ASSERT_TRUE(PgConnection::connect(dsn_)->script("DROP TRIGGER full_disk ON edits"));
  patient.drain();
  EXPECT_TRUE(patient.accepting());
  EXPECT_THAT(answers_, ElementsAre(ErrorCode::storage_full, kSaved));
}

TEST_F(Writer, a_full_queue_refuses_but_one_large_entry_passes) {
  JournalWriter writer(*store_, {.max_waiting_bytes = 100'000});
  HeldModel held(dsn_, model_.id);
  auto large = painter_.entry(1);
  large.revisions.push_back({{0, 0}, std::vector<std::uint8_t>(500'000, 7), {}});
  submit(writer, large);
  held.wait_until_someone_waits();
  EXPECT_FALSE(writer.accepting());
  EXPECT_FALSE(writer.submit(painter_.entry(2), [](auto) { ADD_FAILURE(); }));
  held.release();
  writer.drain();
  EXPECT_TRUE(writer.accepting());
  submit(writer, painter_.entry(2));
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved, kSaved));
}

TEST_F(Writer, a_very_large_edit_is_one_transaction) {
  auto import = painter_.entry(1, "import");
  for (std::uint16_t y = 0; y < 64; ++y)
    for (std::uint16_t x = 0; x < 64; ++x)
      import.revisions.push_back(
          {{x, y}, std::vector<std::uint8_t>(10'000, static_cast<std::uint8_t>(x ^ y)), {}});
  JournalWriter writer(*store_, {});
  submit(writer, import);
  writer.drain();
  EXPECT_THAT(answers_, ElementsAre(kSaved));
  EXPECT_EQ(store_->journal().revision_bytes(model_.id).value(), 40'960'000u);
}

TEST_F(Writer, durable_edits_per_second) {
  JournalWriter writer(*store_, {});
  const auto seconds_of = [](auto start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::vector<JournalEntry> entries;
  for (int i = 1; i <= 3300; ++i) entries.push_back(painter_.paint(i, 1, 8));
  auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(save(writer, entries[i]));
  const double one_ms = seconds_of(start) / 300 * 1000;
  start = std::chrono::steady_clock::now();
  for (int i = 300; i < 3300; ++i) submit(writer, std::move(entries[i]));
  writer.drain();
  const double grouped = 3000 / seconds_of(start);
  EXPECT_EQ(answers_, std::vector<Answer>(3000, kSaved));
  std::printf(
      "[ figure   ] single-tile edits: %.2f ms each, one after the other (%.0f/s); %.0f/s grouped; %.0f bytes each\n",
      one_ms, 1000 / one_ms, grouped,
      static_cast<double>(store_->journal().revision_bytes(model_.id).value()) / 3300);
}

}  // namespace
}  // namespace strata::store
