#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/memory_ledger.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/rooms.h"
#include "store/content/models.h"
#include "support/room_fixture.h"

namespace strata::test {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

class RoomMemory : public RoomTest {
 protected:
  void restart_with(std::uint64_t bytes) {
    options_.memory_bytes = bytes;
    restart();
  }
  // Returns the memory of the open model with the surface map of one layer.
  std::uint64_t bytes_with_map(const Layer& layer) {
    EXPECT_TRUE(send(stroke(layer, 5, {{320, 240}}, 20)));
    return rooms_->memory_bytes_used();
  }
};

TEST_F(RoomMemory, counts_what_a_model_holds_and_gives_it_back) {
  EXPECT_EQ(rooms_->memory_bytes_used(), 0u);
  const auto layer = make_layer(ValueType::u8);
  const auto empty = rooms_->memory_bytes_used();
  EXPECT_GT(empty, kMiB / 2) << "its geometry";
  const auto painted = bytes_with_map(layer);
  EXPECT_GT(painted, empty + kMiB) << "a surface map and tiles";
  ASSERT_TRUE(send(request(layer, room::FillEdit{false, 3})));
  EXPECT_GT(rooms_->memory_bytes_used(), painted + kMiB) << "more tiles";
  ASSERT_TRUE(send(request(layer, room::FillEdit{true, 0})));
  EXPECT_LT(rooms_->memory_bytes_used(), painted) << "erased tiles take none";
  rooms_->forget(model_.id);
  // Threads that saved the last edit may still hold a reference to the room.
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (rooms_->memory_bytes_used() > 0 && std::chrono::steady_clock::now() < limit)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(rooms_->memory_bytes_used(), 0u);
}

TEST_F(RoomMemory, that_a_model_does_not_fit_into_is_a_refusal_that_says_what_to_do) {
  restart_with(100'000);
  const auto room = rooms_->open("pot", Role::owner);
  ASSERT_FALSE(room);
  EXPECT_EQ(room.error().code, ErrorCode::out_of_memory);
  EXPECT_NE(room.error().detail.find("--memory"), std::string::npos) << room.error().detail;
  EXPECT_EQ(rooms_->memory_bytes_used(), 0u) << "nothing of it is left";
}

TEST_F(RoomMemory, is_made_for_a_surface_map_by_one_that_is_not_used) {
  const auto small = make_layer(ValueType::u8, 2048, "small");
  const auto large = make_layer(ValueType::u8, 4096, "large");
  const auto both = [&] {
    bytes_with_map(small);
    return bytes_with_map(large);
  }();
  restart_with(both - kMiB);  // too little for both maps
  ASSERT_TRUE(send_until_taken(stroke(large, 1, {{320, 240}}, 20)));
  for (const auto& layer : {small, large, small})
    ASSERT_TRUE(send_until_taken(stroke(layer, 7, {{330, 240}}, 15))) << layer.slug;
  expect_room_equals_journal(small);
  expect_room_equals_journal(large);
  EXPECT_LE(rooms_->memory_bytes_used(), both - kMiB);
}

TEST_F(RoomMemory, that_is_used_up_refuses_edits_until_something_is_given_back) {
  const auto first = make_layer(ValueType::u32, 2048, "first");
  const auto second = make_layer(ValueType::u32, 2048, "second");
  restart_with(bytes_with_map(first) + 4 * kMiB);
  ASSERT_TRUE(
      // The content of an edit is kept even if it exceeds the budget.
      send_until_taken(request(first, room::FillEdit{false, 9})));
  const auto refused = send(request(second, room::FillEdit{false, 9}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  expect_room_equals_journal(first);
  ASSERT_TRUE(room()->layers().erase(first.id, {}));
  EXPECT_TRUE(send_until_taken(stroke(second, 1, {{320, 240}}, 20)));
}

TEST_F(RoomMemory, of_a_model_that_nobody_is_in_serves_another) {
  store::NewModel copy;
  copy.model = model_;
  copy.model.id = 0;
  copy.model.slug = "copy";
  copy.geometry = store_->models().geometry(model_.id).value();
  ASSERT_TRUE(store_->models().create(copy, {}));
  room();
  const auto one = rooms_->memory_bytes_used();
  restart_with(one + one / 2);
  ASSERT_TRUE(rooms_->open("pot", Role::owner));
  ASSERT_TRUE(rooms_->open("copy", Role::owner));
  EXPECT_EQ(rooms_->open_rooms(), 1u);
  const auto held = rooms_->open("copy", Role::owner);
  const auto refused = rooms_->open("pot", Role::owner);
  ASSERT_FALSE(refused) << "the other is in use";
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
}

}  // namespace
}  // namespace strata::test
