// The lease of a node: the rooms of the node close when the lease is lost, also while the database
// hangs. They open again when the node has joined again.
#include "app/nodes/node_lease.h"

#include <chrono>
#include <thread>

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

TEST_F(LeaseOfNode, rooms_close_while_a_renewal_hangs_and_open_again_after_it) {
  const auto lease = start_lease(500ms);
  ASSERT_TRUE(lease);
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  {
    const test::Hang hang(test::shared_cluster());
    // Nothing can answer, so only the clock can have closed the rooms.
    ASSERT_TRUE(wait_until([&] { return !lease->holds() && rooms_->open_rooms() == 0; }));
    EXPECT_EQ(rooms_->open("pot", Role::owner).error().code, ErrorCode::unavailable);
    EXPECT_FALSE(lease->holds());
    ASSERT_TRUE(wait_until([&] { return lease->left() == 0ms; }));
  }
  ASSERT_TRUE(wait_until([&] { return lease->holds(); }));
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  lease->leave();
}

TEST_F(LeaseOfNode, rooms_close_before_a_node_whose_lease_is_over_joins_again) {
  const auto lease = start_lease(kLong);
  ASSERT_TRUE(lease);
  ASSERT_TRUE(wait_until([&] { return opens(); }));
  const auto moved_before = rooms_->models_moved();
  auto connection = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(connection);
  ASSERT_TRUE(
      connection->script("UPDATE nodes SET lease_until = clock_timestamp() - interval '1 second'"));
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
