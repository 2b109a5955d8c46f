// The lease of a node: the rooms of the node save nothing when the lease is lost, also while the
// database hangs. They save again when the node has joined again.
#include "app/nodes/node_lease.h"

#include <chrono>
#include <thread>

#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "support/room_fixture.h"

namespace strata::app {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = std::chrono::minutes(5);

template <class Condition>
bool wait_until(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

class LeaseOfNode : public test::RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    options_.node = node_.id;
    restart();
  }
  std::unique_ptr<NodeLease> start_lease(std::chrono::milliseconds trusted_for) {
    auto lease = NodeLease::start(store_->nodes(), *rooms_, {node_, 50ms, trusted_for});
    EXPECT_TRUE(lease) << (lease ? "" : lease.error().detail);
    return lease ? std::move(*lease) : nullptr;
  }
  // On a slow machine, the node may lose its lease at any time.
  bool opens() { return rooms_->open("pot", Role::owner).has_value(); }

  const store::NewNode node_{random_uuid(), "http://a.example", "1.0", "llvmpipe"};
};

TEST_F(LeaseOfNode, rooms_save_nothing_while_a_renewal_hangs_and_save_again_after_it) {
  const auto lease = start_lease(500ms);
  ASSERT_TRUE(lease);
  Result<std::shared_ptr<room::Room>> open = tl::unexpected(Error{});
  ASSERT_TRUE(wait_until([&] { return (open = rooms_->open("pot", Role::owner)).has_value(); }));
  {
    const test::Hang hang(test::shared_cluster());
    // The database does not respond, so only the node's own clock shows the end of the lease.
    ASSERT_TRUE(wait_until([&] { return !lease->holds() && !opens(); }));
    EXPECT_EQ(rooms_->open("pot", Role::owner).error().code, ErrorCode::unavailable);
    EXPECT_EQ(rooms_->open_rooms(), 1u);
    EXPECT_TRUE((*open)->queries().pick(camera(), 320, 240, {}))
        << "reading the open model needs no database";
    EXPECT_FALSE(lease->holds());
    ASSERT_TRUE(wait_until([&] { return lease->left() == 0ms; }));
  }
  ASSERT_TRUE(wait_until([&] { return lease->holds(); }));
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  EXPECT_EQ(rooms_->models_moved(), 0u);
  lease->leave();
}

TEST_F(LeaseOfNode, rooms_are_compared_with_the_journal_after_a_node_has_joined_again) {
  const auto lease = start_lease(kLong);
  ASSERT_TRUE(lease);
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  const auto moved_before = rooms_->models_moved();
  auto connection = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(connection);
  // Another node has claimed the model since the lease ended.
  ASSERT_TRUE(connection->script(
      "BEGIN; UPDATE models SET owner_node = NULL, owner_epoch = owner_epoch + 1; "
      "UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second'; COMMIT"));
  ASSERT_TRUE(wait_until([&] { return rooms_->models_moved() > moved_before; }));
  ASSERT_TRUE(wait_until([&] { return lease->holds() && opens(); }));
  EXPECT_TRUE(store_->nodes().all().value().at(0).lives);
  lease->leave();
}

TEST_F(LeaseOfNode, a_node_reports_its_load_drains_and_leaves) {
  const auto lease = start_lease(kLong);
  ASSERT_TRUE(lease);
  EXPECT_TRUE(lease->holds());
  EXPECT_FALSE(lease->draining());
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  ASSERT_TRUE(wait_until([&] {
    const auto nodes = store_->nodes().all();
    return nodes && nodes->size() == 1 && nodes->front().load.open_models == 1;
  }));
  lease->begin_drain();
  EXPECT_TRUE(lease->draining());
  EXPECT_TRUE(store_->nodes().all().value().at(0).draining);
  rooms_->drain();
  lease->leave();
  EXPECT_TRUE(store_->nodes().all().value().empty());
}

}  // namespace
}  // namespace strata::app
