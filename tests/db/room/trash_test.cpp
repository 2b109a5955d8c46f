// Moving layers of an open room to the trash, and restoring them.
#include "store/content/trash.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "support/room_fixture.h"
#include "support/whole_picture.h"

namespace strata {
namespace {

using test::equal;
using test::RoomTest;

class LayersInTheBin : public RoomTest {
 protected:
  void put(const Layer& layer) {
    const auto done =
        room()->layers().put_in_trash(layer.id, {.key = {}, .make = {}, .user = "carl"});
    ASSERT_TRUE(done) << done.error().detail;
  }
  Result<store::TrashRestored> restore(const Layer& layer) {
    const auto entry = store_->trash().entry(model_.project_id, store::TrashEntry::Kind::layer,
                                             layer.id.number(), 0, {Role::curator, {}});
    if (!entry) return tl::unexpected(entry.error());
    return room()->layers().restore(*entry, {.key = {}, .make = {}, .user = "carl"});
  }
};

TEST_F(LayersInTheBin, come_back_with_texels_history_and_undo_while_others_go_on) {
  const Layer layer = make_layer(ValueType::u8, 2048, "cracks"),
              other = make_layer(ValueType::u8, 2048, "other");
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}, {380, 250}}, 20)));
  ASSERT_TRUE(send(stroke(layer, 8, {{300, 240}}, 20)));
  const TileMap before = room()->queries().tiles(layer.slug, {})->tiles;
  put(layer);
  EXPECT_EQ(room()->layers().find(layer.slug).error().code, ErrorCode::not_found);
  EXPECT_EQ(room()->layers().all().size(), 1u);
  EXPECT_EQ(send(stroke(layer, 1, {{320, 240}}, 20)).error().code, ErrorCode::not_found);
  EXPECT_EQ(send(request(layer, room::UndoEdit{})).error().code, ErrorCode::not_found);
  ASSERT_TRUE(send(stroke(other, 5, {{320, 240}}, 20)));
  const auto back = restore(layer);
  ASSERT_TRUE(back) << back.error().detail;
  EXPECT_TRUE(equal(room()->queries().tiles(layer.slug, {})->tiles, before));
  expect_room_equals_journal(layer);
  expect_picture_of_journal();
  ASSERT_TRUE(send(request(layer, room::UndoEdit{})));
  EXPECT_FALSE(equal(room()->queries().tiles(layer.slug, {})->tiles, before));
  ASSERT_TRUE(send(stroke(layer, 7, {{310, 240}}, 20)));
  expect_room_equals_journal(layer);
  expect_room_equals_journal(other);
  expect_picture_of_journal();
  EXPECT_EQ(restore(layer).error().code, ErrorCode::not_found);
}

TEST_F(LayersInTheBin, stay_there_over_a_restart_and_a_lost_context) {
  const Layer layer = make_layer(ValueType::u16, 2048, "cracks"),
              other = make_layer(ValueType::u8, 2048, "other");
  ASSERT_TRUE(send(stroke(layer, 900, {{320, 240}, {380, 250}}, 20)));
  const TileMap before = room()->queries().tiles(layer.slug, {})->tiles;
  put(layer);
  renderer_->lose_context_for_test();
  ASSERT_TRUE(send_until_taken(stroke(other, 5, {{320, 240}}, 20)));
  EXPECT_EQ(room()->layers().all().size(), 1u);
  restart();
  EXPECT_EQ(room()->layers().all().size(), 1u);
  ASSERT_TRUE(restore(layer));
  renderer_->lose_context_for_test();
  ASSERT_TRUE(send_until_taken(stroke(other, 6, {{300, 240}}, 20)));
  EXPECT_TRUE(equal(room()->queries().tiles(layer.slug, {})->tiles, before));
  restart();
  EXPECT_TRUE(equal(room()->queries().tiles(layer.slug, {})->tiles, before));
  expect_picture_of_journal();
}

TEST_F(LayersInTheBin, are_not_deleted_with_a_room_that_takes_them_back) {
  const Layer layer = make_layer(ValueType::u8, 2048, "cracks");
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}}, 20)));
  const auto held = room();
  put(layer);
  ASSERT_TRUE(store_->trash().put_model(model_.id, {.key = {}, .make = {}, .user = "carl"}));
  rooms_->forget(model_.id);
  EXPECT_EQ(test::whole_picture(held->pictures(), {}, camera()).error().code, ErrorCode::gone)
      << "who holds the room is told why";
  EXPECT_EQ(rooms_->open(to_string(model_.id), Role::owner).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->trash()
                .entry(model_.project_id, store::TrashEntry::Kind::layer, layer.id.number(), 0,
                       {Role::owner, {}})
                .error()
                .code,
            ErrorCode::not_found);
  const auto model = store_->trash().entry(model_.project_id, store::TrashEntry::Kind::model,
                                           model_.id.number(), 0, {Role::owner, {}});
  ASSERT_TRUE(model);
  ASSERT_TRUE(store_->trash().restore(*model, {}));
  EXPECT_TRUE(room()->layers().all().empty());
  ASSERT_TRUE(restore(layer));
  expect_room_equals_journal(layer);
}

}  // namespace
}  // namespace strata
