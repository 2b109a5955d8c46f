// Synchronous standbys: a change is reported as saved only when a standby has confirmed it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <mutex>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/answers.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"

namespace strata::store {
namespace {

using namespace std::chrono_literals;

// The database waits for a standby that does not exist, so no commit ends until a test lets it.
class Standby : public ::testing::Test {
 protected:
  void SetUp() override {
    set_standby("nobody");
    // A session waits only after the checkpointer has read the setting, so commits follow each
    // other until one waits.
    auto early = std::async(std::launch::async, [this] {
      auto connection = PgConnection::connect(dsn_).value();
      while (connection.confirm_visible()) {
      }
    });
    cancel_next_wait();
    early.get();
  }
  void TearDown() override { set_standby(""); }

  void set_standby(const std::string& name) {
    EXPECT_TRUE(observer_.script("ALTER SYSTEM SET synchronous_standby_names = '" + name + "'"));
    EXPECT_TRUE(observer_.script("SELECT pg_reload_conf()"));
  }
  // Waits until a session waits for the standby.
  void expect_wait() {
    for (int i = 0; i < 6000; ++i) {
      if (waiting() > 0) return;
      std::this_thread::sleep_for(10ms);
    }
    ADD_FAILURE() << "no session waits for the standby";
  }
  void cancel_next_wait() {
    expect_wait();
    EXPECT_TRUE(observer_.query(
        "SELECT pg_cancel_backend(pid) FROM pg_stat_activity WHERE wait_event = 'SyncRep'"));
  }
  std::int64_t waiting() {
    return observer_.query("SELECT count(*) FROM pg_stat_activity WHERE wait_event = 'SyncRep'")
        ->integer(0, 0);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Model model_ = test::make_model(*store_);
  Layer layer_ = test::make_layer(*store_, model_.id);
  test::Painter painter_{layer_, 5};
  PgConnection observer_ = PgConnection::connect(dsn_).value();
};

TEST_F(Standby, a_commit_whose_wait_is_canceled_is_not_reported_as_saved) {
  auto commit = std::async(std::launch::async, [this]() -> Result<void> {
    auto connection = PgConnection::connect(dsn_).value();
    auto transaction = Transaction::begin(connection).value();
    EXPECT_TRUE(connection.confirm_visible());
    auto committed = transaction.commit();
    EXPECT_EQ(connection.sqlstate(), "08006");
    EXPECT_TRUE(connection.query("SELECT 1")) << "the connection stays usable";
    return committed;
  });
  cancel_next_wait();
  const auto committed = commit.get();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::unavailable);
  EXPECT_EQ(committed.error().title, "Result unknown");
}

TEST_F(Standby, the_journal_answers_only_when_a_standby_has_the_edit) {
  JournalWriter::Options options;
  options.retry_for = 1h;
  JournalWriter writer(*store_, options);
  std::promise<Result<void>> promise;
  auto answer = promise.get_future();
  ASSERT_TRUE(writer.submit(painter_.paint(1, 1, 4),
                            [&](Result<void> result) { promise.set_value(std::move(result)); }));
  cancel_next_wait();
  // The edit is in the database of the primary now, and the next attempt finds it there. This
  // attempt must also wait for the standby, even if the test cancels this wait as well.
  cancel_next_wait();
  expect_wait();
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 1);
  EXPECT_EQ(answer.wait_for(0s), std::future_status::timeout);
  set_standby("");
  EXPECT_TRUE(answer.get());
  EXPECT_EQ(store_->journal().last_sequence(model_.id).value(), 1);
}

TEST_F(Standby, a_stored_answer_is_repeated_only_when_a_standby_has_it) {
  ASSERT_TRUE(observer_.script(
      "SET synchronous_commit = local; INSERT INTO answers (key, answer) VALUES ('a key', '{}')"));
  auto found = std::async(std::launch::async, [this] { return store_->answers().find("a key"); });
  expect_wait();
  set_standby("");
  EXPECT_TRUE(found.get().value());
}

}  // namespace
}  // namespace strata::store
