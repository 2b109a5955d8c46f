// Locked layers, tested with each way in which an edit can arrive.
#include <future>
#include <vector>

#include "expression/expression_parser.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using test::RoomTest;

class LockedLayers : public RoomTest {
 protected:
  void lock(const Layer& layer, bool locked = true) {
    auto now = room()->layers().find(layer.slug);
    ASSERT_TRUE(now);
    now->locked = locked;
    const auto changed = room()->layers().update(*now);
    ASSERT_TRUE(changed) << changed.error().detail;
    EXPECT_EQ(changed->locked, locked);
  }
  TileMap tiles(const Layer& layer) { return room()->queries().tiles(layer.slug, {})->tiles; }
  room::EditRequest by_curator(room::EditRequest edit) const {
    edit.author.role = Role::curator;
    return edit;
  }
};

// Returns a patch of a layer with these tiles.
query::TexelPatch erase_one_texel(const TileMap& tiles) {
  const auto& [address, tile] = *tiles.begin();
  int texel = 0;
  while (!tile->valid.test(texel)) ++texel;
  auto erased = std::make_shared<TileData>(*tile);
  erased->clear(texel);
  query::TexelPatch patch;
  patch.tiles[address] = {{}, tile, std::move(erased)};
  patch.tiles[address].texels.set(texel);
  return patch;
}

// Returns one edit of each kind. Each edit can change a layer on which Anna made two strokes and
// undid one of them.
std::vector<std::pair<std::string, decltype(room::EditRequest::edit)>> edits_of(
    const Camera& camera, const TileMap& other) {
  room::StrokeEdit stroke;
  stroke.batch.camera = camera;
  stroke.batch.path = {{300, 200}};
  stroke.batch.radius_px = 10;
  stroke.batch.value_bits = 3;
  stroke.stroke = random_uuid();
  room::FillEdit fill;
  fill.value_bits = 4;
  room::PolygonEdit polygon;
  polygon.value_bits = 5;
  polygon.outline = {camera, {{250, 200}, {390, 200}, {320, 300}}, false};
  return {{"redo", room::RedoEdit{}},
          {"undo", room::UndoEdit{}},
          {"stroke", stroke},
          {"polygon", polygon},
          {"fill", fill},
          {"import", room::ImportEdit{other}},
          {"patch", room::PatchEdit{erase_one_texel(other), ValueType::u8, 2048}},
          {"restore", room::RestoreEdit{0}}};
}

TEST_F(LockedLayers, no_edit_below_curator_touches_a_locked_layer) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}, {380, 250}}, 20)));
  const TileMap other = tiles(layer);
  ASSERT_TRUE(send(stroke(layer, 8, {{300, 240}}, 20)));
  ASSERT_TRUE(send(request(layer, room::UndoEdit{})));
  lock(layer);
  const TileMap before = tiles(layer);
  const auto sequence = room()->edits().sequence();
  const auto edits = edits_of(camera({0.3, -1, 0.4}), other);
  for (const auto& [what, edit] : edits) {
    const auto refused = send(request(layer, edit));
    ASSERT_FALSE(refused) << what;
    EXPECT_EQ(refused.error().code, ErrorCode::forbidden) << what;
    EXPECT_EQ(refused.error().detail, "The layer Layer is locked. Ask a curator to unlock it.")
        << what;
    EXPECT_EQ(refused.error().field, "layer") << what;
  }
  EXPECT_TRUE(test::equal(tiles(layer), before));
  EXPECT_EQ(room()->edits().sequence(), sequence);
  restart();
  EXPECT_EQ(send(stroke(layer, 1, {{320, 240}}, 20)).error().code, ErrorCode::forbidden)
      << "the lock was forgotten";
  for (const auto& [what, edit] : edits) {
    const TileMap then = tiles(layer);
    const auto done = send(by_curator(request(layer, edit)));
    ASSERT_TRUE(done) << what << ": " << done.error().detail;
    EXPECT_FALSE(test::equal(tiles(layer), then)) << what;
  }
  lock(layer, false);
  EXPECT_TRUE(send(stroke(layer, 1, {{320, 240}}, 20)));
  expect_room_equals_journal(layer);
}

TEST_F(LockedLayers, other_layers_are_painted_as_before) {
  lock(make_layer(ValueType::u8, 2048, "finished"));
  EXPECT_TRUE(send(stroke(make_layer(ValueType::u8, 2048, "open"), 9, {{320, 240}}, 20)));
}

TEST_F(LockedLayers, what_was_saved_before_the_lock_keeps_its_answer) {
  const Layer layer = make_layer(ValueType::u8);
  const auto edit = stroke(layer, 9, {{320, 240}}, 20);
  const auto first = send(edit);
  ASSERT_TRUE(first);
  lock(layer);
  for (const bool restarted : {false, true}) {
    if (restarted) restart();
    const auto again = send(edit);
    ASSERT_TRUE(again) << again.error().detail;
    EXPECT_TRUE(again->repeated);
    EXPECT_EQ(again->sequence, first->sequence);
  }
}

// Each of these strokes paints different texels, so a late stroke would be visible.
TEST_F(LockedLayers, once_a_lock_is_answered_nothing_is_painted_any_more) {
  const Layer layer = make_layer(ValueType::u8);
  // The first stroke makes the surface map, so later edits do not wait for it.
  ASSERT_TRUE(send(stroke(layer, 1, {{320, 240}}, 20)));
  std::vector<std::future<Result<room::EditAnswer>>> answers;
  for (int i = 0; i < 60; ++i)
    answers.push_back(start(stroke(layer, 2 + i, {{200.0 + 4 * i, 180.0 + 2 * i}}, 10)));
  lock(layer);
  const TileMap then = tiles(layer);
  const auto sequence = room()->edits().sequence();
  EXPECT_EQ(room()->edits().durable_sequence(), sequence);
  for (auto& answer : answers) {
    const auto reply = answer.get();
    if (reply)
      EXPECT_LE(reply->sequence, sequence);
    else
      EXPECT_EQ(reply.error().code, ErrorCode::forbidden) << reply.error().detail;
  }
  EXPECT_TRUE(test::equal(tiles(layer), then));
  EXPECT_EQ(room()->edits().sequence(), sequence);
  expect_room_equals_journal(layer);
}

TEST_F(LockedLayers, a_locked_computed_layer_is_computed_by_the_server_itself_only) {
  const Layer source = make_layer(ValueType::u8, 2048, "source");
  ASSERT_TRUE(send(stroke(source, 9, {{320, 240}}, 20)));
  Layer requested;
  requested.name = requested.slug = "twice";
  requested.type = ValueType::f32;
  requested.palette = default_palette(ValueType::f32, false);
  requested.formula.emplace();
  requested.formula->expression = "source * 2";
  requested.formula->inputs = {{"source", source.id, {}}};
  requested.locked = true;
  const auto made = room()->layers().create(requested);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_TRUE(made->locked);
  room::ComputeEdit compute;
  compute.expression = query::parse_number("source * 2", "expression").value();
  auto edit = request(*made, std::move(compute));
  EXPECT_EQ(send(edit).error().code, ErrorCode::forbidden);
  edit.id = random_uuid();
  edit.author = {"Strata", Role::owner};
  const auto done = send(edit);
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_GT(done->texels_changed, 0u);
}

}  // namespace
}  // namespace strata
