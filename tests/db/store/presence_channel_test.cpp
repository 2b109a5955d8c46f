// The channel for presence: texts of nodes with a lease arrive at all nodes, in order.
#include "store/nodes/presence_channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "store/store.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using ::testing::ElementsAre;

constexpr auto kLong = std::chrono::minutes(5);

class ChannelOfNodes : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(store_->nodes().join(a_));
    lease("clock_timestamp() + interval '1 hour'");
    ASSERT_TRUE(channel_->receive({}));  // begins to listen
    ASSERT_TRUE(other_->receive({}));
  }
  void lease(const std::string& until) {
    const auto done = connection_.script("UPDATE nodes SET lease_until = " + until);
    ASSERT_TRUE(done) << done.error().detail;
  }
  bool send(const std::vector<std::string>& texts) {
    const auto sent = channel_->send(texts);
    EXPECT_TRUE(sent) << sent.error().detail;
    return sent.value_or(false);
  }
  // Returns texts until this number has arrived.
  static std::vector<std::string> receive(PresenceChannel& channel, std::size_t count) {
    std::vector<std::string> all;
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (all.size() < count && std::chrono::steady_clock::now() < deadline) {
      const auto texts = channel.receive(std::chrono::milliseconds(100));
      EXPECT_TRUE(texts) << texts.error().detail;
      if (!texts) break;
      all.insert(all.end(), texts->begin(), texts->end());
    }
    return all;
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  PgConnection connection_ = std::move(PgConnection::connect(dsn_).value());
  const NewNode a_{random_uuid(), "http://a.example", "1.0", "llvmpipe"};
  const std::unique_ptr<PresenceChannel> channel_ = store_->nodes().presence(a_.id),
                                         other_ = store_->nodes().presence(random_uuid());
};

TEST_F(ChannelOfNodes, texts_arrive_in_their_order) {
  EXPECT_TRUE(send({"one", "two \"quoted\" 'words'"}));
  EXPECT_TRUE(send({std::string(PresenceChannel::kMaxBytes, 'x')}));
  EXPECT_TRUE(send({}));
  for (PresenceChannel* channel : {channel_.get(), other_.get()})
    EXPECT_THAT(receive(*channel, 3), ElementsAre("one", "two \"quoted\" 'words'",
                                                  std::string(PresenceChannel::kMaxBytes, 'x')));
}

TEST_F(ChannelOfNodes, a_node_without_a_lease_sends_nothing) {
  lease("clock_timestamp() - interval '1 second'");
  EXPECT_FALSE(send({"hidden"}));
  const auto sent = other_->send(std::vector<std::string>{"of a node that has not joined"});
  ASSERT_TRUE(sent);
  EXPECT_FALSE(*sent);
  lease("clock_timestamp() + interval '1 hour'");
  EXPECT_TRUE(send({"seen"}));
  EXPECT_THAT(receive(*other_, 1), ElementsAre("seen"));
}

TEST_F(ChannelOfNodes, a_channel_connects_again) {
  const auto ended = connection_.script(
      "SELECT pg_terminate_backend(pid, 60000) FROM pg_stat_activity "
      "WHERE datname = current_database() AND pid <> pg_backend_pid()");
  ASSERT_TRUE(ended) << ended.error().detail;
  channel_->disconnect();
  // The other channel notices the end of its session when it reads for the second time, and
  // receives only texts that are sent later.
  bool received = false;
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (!received && std::chrono::steady_clock::now() < deadline) {
    ASSERT_TRUE(send({"after the outage"}));
    const auto texts = other_->receive(std::chrono::milliseconds(100));
    received = texts && !texts->empty();
  }
  EXPECT_TRUE(received);
}

TEST_F(ChannelOfNodes, only_the_role_of_the_server_can_read_the_name_of_the_channel) {
  const auto read = connection_.query(
      "SELECT has_table_privilege('public', 'presence_channel', 'SELECT'), "
      "name = 'strata_presence' FROM presence_channel");
  ASSERT_TRUE(read) << read.error().detail;
  ASSERT_EQ(read->rows(), 1);
  EXPECT_FALSE(read->boolean(0, 0));
  EXPECT_FALSE(read->boolean(0, 1));
}

TEST_F(ChannelOfNodes, nothing_is_stored) {
  EXPECT_TRUE(send({"one"}));
  EXPECT_EQ(connection_.query("SELECT count(*) FROM node_messages")->integer(0, 0), 0);
}

}  // namespace
}  // namespace strata::store
