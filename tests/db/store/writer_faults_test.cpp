#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <future>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/layers.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"
#include "strata_dirs.h"

namespace strata::store {
namespace {

using test::Painter;

// Each test has a separate cluster, because the test kills it.
class WriterFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    auto cluster = Cluster::start(folder_.path());
    ASSERT_TRUE(cluster) << cluster.error().detail;
    cluster_ = std::move(*cluster);
    store_ = test::open_store(cluster_->dsn());
    model_ = test::make_model(*store_);
    layer_ = test::make_layer(*store_, model_.id);
  }
  void kill_postmaster() { test::kill_postmaster(*cluster_); }
  // Kills a backend process of the database. The postmaster then ends all sessions and recovers.
  void kill_backend() {
    auto connection = PgConnection::connect(cluster_->dsn());
    if (!connection) return;
    auto pids = connection->query(
        "SELECT pid FROM pg_stat_activity WHERE backend_type = 'client backend' "
        "AND pid <> pg_backend_pid() AND state <> 'idle' OR query = 'COMMIT' ORDER BY query_start DESC");
    if (pids && pids->rows() > 0) kill(static_cast<pid_t>(pids->integer(0, 0)), SIGKILL);
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<Cluster> cluster_;
  std::unique_ptr<Store> store_;
  Model model_;
  Layer layer_;
};

// Returns the content after the first `count` edits of a painter with this seed.
Painter::Content replay(const Layer& layer, std::uint32_t seed, std::int64_t count) {
  Painter painter(layer, seed, 8);
  for (std::int64_t i = 1; i <= count; ++i) painter.paint(i, 2, 3);
  return painter.content();
}

TEST_F(WriterFaults, killing_the_database_in_mid_load_loses_and_doubles_nothing) {
  constexpr std::uint32_t kSeed = 77;
  std::atomic<std::int64_t> saved{0};
  std::atomic<bool> stop{false};
  std::atomic<int> refused{0};
  std::int64_t submitted = 0;
  JournalWriter writer(*store_, {});
  std::thread painter_thread([&] {
    Painter painter(layer_, kSeed, 8);
    while (!stop) {
      const auto entry = painter.paint(++submitted, 2, 3);
      const auto done = [&, sequence = entry.sequence](Result<void> result) {
        EXPECT_TRUE(result) << result.error().detail;
        EXPECT_EQ(saved.exchange(sequence), sequence - 1);  // in order, each one once
      };
      while (!writer.submit(entry, done)) {
        ++refused;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
  });
  for (int round = 0; round < 6; ++round) {
    const std::int64_t before = saved;
    while (saved < before + 40) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (round % 2 == 0)
      kill_postmaster();
    else
      kill_backend();
    const std::int64_t promised = saved;
    EXPECT_TRUE(cluster_->ensure_running());
    while (saved <= promised) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const auto snapshot = store_->journal().load_tiles(layer_, promised);
    EXPECT_TRUE(snapshot) << snapshot.error().detail;
    if (snapshot) {
      EXPECT_TRUE(test::content_of(*snapshot) == replay(layer_, kSeed, promised))
          << "round " << round;
    }
  }
  stop = true;
  painter_thread.join();
  writer.drain();
  EXPECT_EQ(saved, submitted);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), submitted);
  EXPECT_EQ(store_->journal().history(layer_.id, 1, 0)->total, submitted);
  EXPECT_TRUE(test::content_of(store_->journal().load_tiles(layer_).value()) ==
              replay(layer_, kSeed, submitted));
  // Edits are stored completely or not at all, so every edit has its tiles.
  auto connection = PgConnection::connect(cluster_->dsn());
  EXPECT_EQ(
      connection
          ->query(
              "SELECT count(*) FROM edits e WHERE NOT EXISTS (SELECT 1 FROM tile_revisions r WHERE "
              "r.layer_id = e.layer_id AND r.sequence = e.sequence)")
          ->integer(0, 0),
      0);
  std::printf("[ figure   ] %lld edits over 6 kills, %d submissions refused meanwhile\n",
              static_cast<long long>(submitted), refused.load());
}

TEST_F(WriterFaults, commits_that_keep_failing_answer_everyone_and_then_it_starts_anew) {
  Painter painter(layer_, 5);
  JournalWriter writer(*store_, {.retry_for = std::chrono::milliseconds(1500)});
  ASSERT_TRUE(test::save(writer, painter.paint(1, 2, 4)));
  const auto stored = painter.content();
  {
    // During a hang later edits wait. No session that ends late can commit them.
    test::Hang hang(*cluster_);
    std::vector<std::int64_t> answered;
    for (int i = 2; i <= 30; ++i)
      ASSERT_TRUE(writer.submit(painter.paint(i, 2, 4), [&answered, i](Result<void> result) {
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::unavailable) << result.error().detail;
        answered.push_back(i);
      }));
    hang.kill();
    writer.drain();
    ASSERT_EQ(answered.size(), 29u);
    EXPECT_TRUE(std::is_sorted(answered.begin(), answered.end()));
  }
  EXPECT_TRUE(writer.accepting());
  EXPECT_EQ(store_->projects().find("default").error().code, ErrorCode::unavailable);
  EXPECT_FALSE(store_->ready());
  ASSERT_TRUE(cluster_->ensure_running());
  EXPECT_TRUE(store_->ready());
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 1);
  EXPECT_TRUE(test::content_of(store_->journal().load_tiles(layer_).value()) == stored);
  ASSERT_TRUE(test::save(writer, painter.entry(2)));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);
}

TEST_F(WriterFaults, a_database_that_hangs_fails_commits_and_reads_in_time_and_then_all_is_well) {
  using std::chrono::milliseconds;
  const PgLimits quick{milliseconds(300), milliseconds(0), milliseconds(0)};
  Painter painter(layer_, 6);
  const auto quick_store = Store::open({cluster_->dsn(), 2, quick}, STRATA_MIGRATIONS_DIR).value();
  ASSERT_TRUE(quick_store->projects().find("default"));
  JournalWriter writer(*store_, {.retry_for = milliseconds(2000), .limits = quick});
  ASSERT_TRUE(test::save(writer, painter.paint(1, 2, 4)));
  const auto stored = painter.content();
  {
    const test::Hang hang(*cluster_);
    std::atomic<int> unsaved{0};
    int submitted = 0;  // a machine that is slow may submit only some before the writer gives up
    const auto submit = [&](int i) {
      return writer.submit(painter.paint(i, 2, 4), [&unsaved](Result<void> result) {
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::unavailable) << result.error().detail;
        ++unsaved;
      });
    };
    while (submitted < 29 && submit(2 + submitted)) ++submitted;
    ASSERT_GT(submitted, 0);
    while (writer.accepting()) std::this_thread::sleep_for(milliseconds(1));
    EXPECT_FALSE(writer.submit(painter.entry(31), {}));
    EXPECT_FALSE(store_->ready());
    const auto read = quick_store->projects().find("default");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::unavailable);
    writer.drain();
    EXPECT_EQ(unsaved, submitted);
    EXPECT_TRUE(writer.accepting());
  }
  while (!store_->ready()) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(quick_store->projects().find("default"));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 1);
  EXPECT_TRUE(test::content_of(store_->journal().load_tiles(layer_).value()) == stored);
  ASSERT_TRUE(test::save(writer, painter.entry(2)));
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 2);
}

TEST_F(WriterFaults, a_caller_waits_for_a_busy_pool_only_so_long) {
  const auto narrow =
      Store::open(
          {.dsn = cluster_->dsn(), .connections = 1, .slot_for = std::chrono::milliseconds(50)},
          STRATA_MIGRATIONS_DIR)
          .value();
  auto holder = PgConnection::connect(cluster_->dsn());
  ASSERT_TRUE(holder->script("BEGIN; SELECT 1 FROM layers FOR UPDATE"));
  auto waiting = std::async(std::launch::async, [&] { return narrow->layers().update(layer_); });
  auto watcher = PgConnection::connect(cluster_->dsn());
  while (watcher->query("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'")
             ->integer(0, 0) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // until the update waits
  const auto refused = narrow->projects().find("default");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::busy);
  EXPECT_EQ(refused.error().title, "Database busy");
  EXPECT_TRUE(narrow->ready()) << "busy is not away";
  ASSERT_TRUE(holder->script("COMMIT"));
  EXPECT_TRUE(waiting.get());
  EXPECT_TRUE(narrow->projects().find("default"));
}

TEST_F(WriterFaults, a_commit_without_an_answer_is_said_to_be_of_unknown_outcome) {
  auto connection =
      PgConnection::connect(cluster_->dsn(), {std::chrono::milliseconds(300), {}, {}});
  auto transaction = Transaction::begin(*connection);
  ASSERT_TRUE(connection->query("UPDATE projects SET description = 'changed'"));
  const test::Hang hang(*cluster_);
  const auto committed = transaction->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::unavailable);
  EXPECT_EQ(committed.error().title, "Result unknown");
  EXPECT_FALSE(connection->alive());
}

TEST_F(WriterFaults, readers_get_through_a_restart_of_the_database) {
  ASSERT_TRUE(store_->projects().find("default"));
  kill_postmaster();
  ASSERT_TRUE(cluster_->ensure_running());
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(store_->projects().find("default"));
}

}  // namespace
}  // namespace strata::store
