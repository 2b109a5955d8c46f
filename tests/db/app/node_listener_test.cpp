// The listener of a node: messages wait until their handler can read their subjects, and arrive in
// order.
#include "app/nodes/node_listener.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>

#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::app {
namespace {

using store::NodeMessage;

class ListenerOfNode : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(store_->nodes().join(node_)); }
  std::unique_ptr<store::NodeMessages> messages(store::NodeMessages::Options options = {}) {
    return std::make_unique<store::NodeMessages>(dsn_, node_.id, options);
  }
  void change(const std::string& sql) {
    const auto done = connection_.script(sql);
    ASSERT_TRUE(done) << done.error().detail;
  }
  void make_user(const std::string& name) {
    change("INSERT INTO users (name, role) VALUES ('" + name + "', 'viewer')");
  }
  template <class Condition>
  bool wait_for(const Condition& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::minutes(5), condition);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<store::Store> store_ = test::open_store(dsn_);
  store::PgConnection connection_ = std::move(store::PgConnection::connect(dsn_).value());
  const store::NewNode node_{random_uuid(), "http://a.example", "1.0", "llvmpipe"};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> received_;
  int calls_ = 0, missed_ = 0;
};

TEST_F(ListenerOfNode, a_message_waits_while_its_subject_cannot_be_read) {
  NodeListener listener(messages(),
                        {[&](const NodeMessage& message, std::chrono::nanoseconds) -> Result<void> {
                           const std::lock_guard lock(mutex_);
                           if (++calls_ <= 2) return tl::unexpected(store::unavailable("a test"));
                           received_.push_back(message.user);
                           changed_.notify_all();
                           if (message.user == "bob")
                             return fail(ErrorCode::not_found, "Not found", "It no longer exists.");
                           return {};
                         },
                         [&]() -> Result<void> {
                           ++missed_;
                           return {};
                         }});
  for (const char* name : {"ada", "bob", "cleo"}) make_user(name);
  ASSERT_TRUE(wait_for([&] { return received_.size() >= 3; }));
  listener.stop();
  EXPECT_THAT(received_, ::testing::ElementsAre("ada", "bob", "cleo"));
  EXPECT_EQ(calls_, 5);
  EXPECT_EQ(missed_, 0);
}

TEST_F(ListenerOfNode, a_listener_survives_its_connection) {
  NodeListener listener(messages(),
                        {[&](const NodeMessage& message, std::chrono::nanoseconds) -> Result<void> {
                           const std::lock_guard lock(mutex_);
                           received_.push_back(message.user);
                           changed_.notify_all();
                           return {};
                         },
                         [&]() -> Result<void> {
                           ++missed_;
                           return {};
                         }});
  make_user("ada");
  ASSERT_TRUE(wait_for([&] { return received_.size() == 1; }));
  change(
      "SELECT pg_terminate_backend(pid, 60000) FROM pg_stat_activity "
      "WHERE datname = current_database() AND pid <> pg_backend_pid()");
  make_user("bob");
  ASSERT_TRUE(wait_for([&] { return received_.size() == 2; }));
  listener.stop();
  EXPECT_EQ(missed_, 0);
}

TEST_F(ListenerOfNode, missed_messages_are_reported) {
  store::NodeMessages::Options options;
  options.missed_after = std::chrono::seconds(0);  // the reader treats every read as too late
  NodeListener listener(
      messages(options),
      {[](const NodeMessage&, std::chrono::nanoseconds) -> Result<void> { return {}; },
       [&]() -> Result<void> {
         const std::lock_guard lock(mutex_);
         ++missed_;
         changed_.notify_all();
         if (missed_ == 1) return tl::unexpected(store::unavailable("a test"));
         return {};
       }});
  ASSERT_TRUE(wait_for([&] { return missed_ > 1; })) << "it is reported again after a failure";
}

TEST_F(ListenerOfNode, a_message_that_can_never_be_passed_on_does_not_hold_back_the_others) {
  NodeListener::Options options;
  options.give_up_after = std::chrono::milliseconds(0);
  NodeListener listener(messages(),
                        {[&](const NodeMessage& message, std::chrono::nanoseconds) -> Result<void> {
                           const std::lock_guard lock(mutex_);
                           if (message.user == "ada")
                             return tl::unexpected(store::unavailable("a damaged page"));
                           received_.push_back(message.user);
                           changed_.notify_all();
                           return {};
                         },
                         [&]() -> Result<void> {
                           const std::lock_guard lock(mutex_);
                           ++missed_;
                           changed_.notify_all();
                           return {};
                         }},
                        options);
  for (const char* name : {"ada", "bob"}) make_user(name);
  ASSERT_TRUE(wait_for([&] { return received_.size() == 1 && missed_ == 1; }));
  listener.stop();
  EXPECT_THAT(received_, ::testing::ElementsAre("bob"));
}

}  // namespace
}  // namespace strata::app
