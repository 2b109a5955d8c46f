// The order of edits, the journal and undo, with a real database and a real renderer.
#include <libpq-fe.h>
#include <cmath>
#include <future>
#include <thread>

#include "domain/layers/mask_texels.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/queries.h"
#include "support/room_fixture.h"
#include "support/whole_picture.h"

namespace strata {
namespace {

using test::RoomTest;

TEST_F(RoomTest, a_stroke_is_there_after_a_restart) {
  const Layer layer = make_layer(ValueType::u8);
  auto answer = send(stroke(layer, 7, {{320, 240}, {380, 250}}, 20));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->sequence, 1);
  EXPECT_GT(answer->texels_changed, 100u);
  const auto before = room()->queries().tiles("layer", {});
  ASSERT_TRUE(before);
  restart();
  const auto after = room()->queries().tiles("layer", {});
  ASSERT_TRUE(after);
  EXPECT_TRUE(test::equal(before->tiles, after->tiles));
  EXPECT_EQ(after->sequence, 1);
}

TEST_F(RoomTest, a_repeated_id_gets_the_first_answer_and_paints_nothing) {
  const Layer layer = make_layer(ValueType::u8);
  auto edit = stroke(layer, 7, {{320, 240}}, 30);
  const auto first = send(edit);
  ASSERT_TRUE(first);
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}}, 30)));
  for (bool restarted : {false, true}) {
    if (restarted) restart();
    const auto again = send(edit);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->repeated);
    EXPECT_EQ(again->sequence, first->sequence);
    EXPECT_EQ(again->texels_changed, first->texels_changed);
    EXPECT_EQ(room()->edits().sequence(), 2);
  }
}

TEST_F(RoomTest, annas_undo_leaves_what_ben_painted_over_it) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 1, {{300, 240}}, 30, "anna")));
  ASSERT_TRUE(send(stroke(layer, 2, {{340, 240}}, 30, "ben")));
  const auto both = room()->queries().statistics("layer");
  ASSERT_TRUE(both);
  auto undone = send(request(layer, room::UndoEdit{}, "anna"));
  ASSERT_TRUE(undone) << undone.error().detail;
  auto left = room()->queries().statistics("layer");
  EXPECT_FALSE(left->keys.contains(1));
  EXPECT_EQ(left->keys.at(2).texels, both->keys.at(2).texels);
  // After Ben's undo the layer is empty. After both users redo, the layer has all texels again.
  ASSERT_TRUE(send(request(layer, room::UndoEdit{}, "ben")));
  EXPECT_EQ(room()->queries().statistics("layer")->texels, 0u);
  ASSERT_TRUE(send(request(layer, room::RedoEdit{}, "anna")));
  ASSERT_TRUE(send(request(layer, room::RedoEdit{}, "ben")));
  left = room()->queries().statistics("layer");
  EXPECT_EQ(left->keys.at(1).texels, both->keys.at(1).texels);
  EXPECT_EQ(left->keys.at(2).texels, both->keys.at(2).texels);
  EXPECT_FALSE(send(request(layer, room::RedoEdit{}, "anna")));
}

TEST_F(RoomTest, undo_takes_back_a_whole_stroke_and_survives_a_restart) {
  const Layer layer = make_layer(ValueType::u16);
  auto first = stroke(layer, 500, {{300, 240}, {320, 240}}, 15);
  const Uuid id = std::get<room::StrokeEdit>(first.edit).stroke;
  ASSERT_TRUE(send(first));
  for (int n = 1; n < 4; ++n) {
    auto next = stroke(layer, 500, {{300 + 20.0 * n, 240}, {320 + 20.0 * n, 245}}, 15);
    std::get<room::StrokeEdit>(next.edit).stroke = id;
    std::get<room::StrokeEdit>(next.edit).n = n;
    ASSERT_TRUE(send(next));
  }
  const auto painted = room()->queries().tiles("layer", {});
  restart();
  ASSERT_TRUE(send(request(layer, room::UndoEdit{})));
  EXPECT_TRUE(room()->queries().tiles("layer", {})->tiles.empty());
  restart();
  ASSERT_TRUE(send(request(layer, room::RedoEdit{})));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles, painted->tiles));
}

TEST_F(RoomTest, filled_everywhere_the_area_is_that_of_the_mesh) {
  for (int resolution : {2048, 4096}) {
    const Layer layer = make_layer(ValueType::u8, resolution, "L" + std::to_string(resolution));
    auto answer = send(request(layer, room::FillEdit{false, 3}));
    ASSERT_TRUE(answer) << answer.error().detail;
    const double area_m2 = room()->model().area_m2();
    EXPECT_NEAR(answer->area_m2, area_m2, area_m2 * 1e-3);
    auto statistics = room()->queries().statistics(layer.slug);
    EXPECT_NEAR(statistics->area_m2, area_m2, area_m2 * 1e-3);
    ASSERT_TRUE(send(request(layer, room::FillEdit{true, 0})));
    EXPECT_EQ(room()->queries().statistics(layer.slug)->texels, 0u);
  }
}

TEST_F(RoomTest, a_layer_is_restored_to_a_sequence_and_that_can_be_undone) {
  const Layer layer = make_layer(ValueType::f32);
  ASSERT_TRUE(send(stroke(layer, 0.25, {{320, 240}}, 25)));
  const auto first = room()->queries().tiles("layer", {});
  ASSERT_TRUE(send(stroke(layer, 0.5, {{330, 250}}, 25)));
  const auto second = room()->queries().tiles("layer", {});
  ASSERT_TRUE(send(request(layer, room::RestoreEdit{1})));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles, first->tiles));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", 2)->tiles, second->tiles));
  ASSERT_TRUE(send(request(layer, room::UndoEdit{})));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles, second->tiles));
}

// Sets all painted texels of a state to another value.
room::PatchEdit repaint(const TileMap& tiles, std::uint32_t value) {
  room::PatchEdit edit{{}, ValueType::u8, 2048};
  for (const auto& [address, tile] : tiles) {
    auto after = std::make_shared<TileData>(*tile);
    for_each_texel(tile->valid, [&](int texel) { after->write(texel, value); });
    edit.patch.tiles[address] = {tile->valid, tile, std::move(after)};
  }
  return edit;
}

TEST_F(RoomTest, a_patch_leaves_what_was_painted_since_and_can_be_undone) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 1, {{300, 240}}, 30, "anna")));
  const auto then = room()->queries().statistics("layer")->texels;
  const room::PatchEdit patch = repaint(room()->queries().tiles("layer", {})->tiles, 5);
  EXPECT_EQ(room::keys_in(patch.patch), std::vector<std::int64_t>{5});
  // Ben paints over a part, and erases another part.
  ASSERT_TRUE(send(stroke(layer, 2, {{320, 240}}, 15, "ben")));
  auto erase = stroke(layer, 0, {{280, 240}}, 10, "ben");
  std::get<room::StrokeEdit>(erase.edit).batch.erase = true;
  ASSERT_TRUE(send(erase));
  const auto before = room()->queries().tiles("layer", {});
  const auto ben = room()->queries().statistics("layer");
  const auto done = send(request(layer, patch, "anna"));
  ASSERT_TRUE(done) << done.error().detail;
  const auto after = room()->queries().statistics("layer");
  EXPECT_EQ(done->texels_changed, ben->keys.at(1).texels);
  EXPECT_LT(done->texels_changed, then);
  EXPECT_EQ(after->keys.at(5).texels, ben->keys.at(1).texels);
  EXPECT_EQ(after->keys.at(2).texels, ben->keys.at(2).texels);
  EXPECT_FALSE(after->keys.contains(1));
  EXPECT_EQ(after->texels, ben->texels);
  restart();
  ASSERT_TRUE(send(request(layer, room::UndoEdit{}, "anna")));
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles, before->tiles));
}

TEST_F(RoomTest, a_patch_of_another_type_is_refused) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 1, {{300, 240}}, 30)));
  room::PatchEdit patch = repaint(room()->queries().tiles("layer", {})->tiles, 5);
  patch.type = ValueType::u16;
  const auto refused = send(request(layer, patch));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::conflict);
  EXPECT_EQ(room()->edits().sequence(), 1);
}

TEST_F(RoomTest, many_strokes_at_once_keep_their_order) {
  const Layer layer = make_layer(ValueType::u8);
  auto r = room();
  std::vector<std::future<Result<room::EditAnswer>>> answers;
  for (int i = 1; i <= 60; ++i) {
    auto promise = std::make_shared<std::promise<Result<room::EditAnswer>>>();
    answers.push_back(promise->get_future());
    r->edits().submit(
        stroke(layer, i, {{300.0 + i % 7, 240}}, 12), {},
        [promise](Result<room::EditAnswer> answer) { promise->set_value(std::move(answer)); });
  }
  for (int i = 0; i < 60; ++i) {
    auto answer = answers[i].get();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->sequence, i + 1);
  }
  const auto live = r->queries().tiles("layer", {});
  const auto stored = r->queries().tiles("layer", 60);
  ASSERT_TRUE(stored);
  EXPECT_TRUE(test::equal(live->tiles, stored->tiles));
}

TEST_F(RoomTest, a_lost_context_comes_back_with_every_layer) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 90, {{320, 240}, {360, 260}}, 25)));
  const auto before = test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}));
  ASSERT_TRUE(before);
  renderer_->lose_context_for_test();
  // The room refuses frames while the GPU is rebuilt. Afterwards the frame is the same as before.
  Result<Picture> after = fail(ErrorCode::unavailable, "", "");
  for (int i = 0; i < 3000 && !after; ++i) {
    after = test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}));
    if (!after) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE(after) << after.error().detail;
  EXPECT_EQ(before->rgba, after->rgba);
  auto answer = send(stroke(layer, 91, {{300, 200}}, 10));
  for (int i = 0; i < 3000 && !answer; ++i) answer = send(stroke(layer, 91, {{300, 200}}, 10));
  ASSERT_TRUE(answer);
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles,
                          room()->queries().tiles("layer", answer->sequence)->tiles));
}

// A listener that records the notifications of failed saves.
struct UnsavedEars : room::Listener {
  std::mutex mutex;
  std::vector<Uuid> unsaved;
  void edit_applied(const Edit&) override {}
  void edits_unsaved(const std::vector<Edit>& edits, const Error&) override {
    std::lock_guard lock(mutex);
    for (const auto& edit : edits) unsaved.push_back(edit.id);
  }
  void layer_changed(LayerChange, const Layer&) override {}
  void model_changed(const Model&) override {}
  void surface_image_changed(LayerChange, const SurfaceImage&) override {}
  void model_deleted() override {}
  void moved(const std::string&) override {}
  void database_reachable(bool) override {}
  void presence_changed() override {}
  void view_refused(std::uint32_t, const Error&) override {}
};

void execute(const std::string& dsn, const char* sql) {
  std::unique_ptr<PGconn, decltype(&PQfinish)> connection(PQconnectdb(dsn.c_str()), &PQfinish);
  std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection.get(), sql), &PQclear);
  ASSERT_EQ(PQresultStatus(result.get()), PGRES_COMMAND_OK) << PQerrorMessage(connection.get());
}

TEST_F(RoomTest, edits_whose_commit_fails_are_taken_back_everywhere) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto saved = room()->queries().tiles("layer", {});
  const auto picture = test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}));
  UnsavedEars ears;
  auto member = room()->participants().join({"anna", Role::owner}, {}, &ears,
                                            [](const stream::FrameMessages&) {});

  // Reading continues to work, but writing fails.
  execute(dsn_, "alter table edits add constraint no_more check (sequence < 2) not valid");
  std::vector<std::future<Result<room::EditAnswer>>> answers;
  std::vector<room::EditRequest> lost;
  for (int i = 0; i < 5; ++i) {
    auto promise = std::make_shared<std::promise<Result<room::EditAnswer>>>();
    answers.push_back(promise->get_future());
    lost.push_back(stroke(layer, 10 + i, {{320.0 + 10 * i, 240}}, 20));
    room()->edits().submit(lost.back(), {}, [promise](Result<room::EditAnswer> answer) {
      promise->set_value(std::move(answer));
    });
  }
  for (auto& answer : answers) EXPECT_FALSE(answer.get());
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles, saved->tiles));
  EXPECT_EQ(test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}))->rgba,
            picture->rgba);
  EXPECT_EQ(room()->edits().sequence(), 1);
  {
    std::lock_guard lock(ears.mutex);
    EXPECT_FALSE(ears.unsaved.empty());
  }

  execute(dsn_, "alter table edits drop constraint no_more");
  for (const auto& edit : lost) ASSERT_TRUE(send(edit));
  EXPECT_EQ(room()->edits().durable_sequence(), 6);
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles,
                          room()->queries().tiles("layer", 6)->tiles));
}

TEST_F(RoomTest, with_the_database_gone_edits_are_refused_and_viewing_goes_on) {
  const Layer layer = make_layer(ValueType::u8);
  ASSERT_TRUE(send(stroke(layer, 5, {{300, 240}}, 20)));
  const auto picture = test::whole_picture(room()->pictures(), {}, camera());
  auto& cluster = test::shared_cluster();
  // Also kill the sessions, which may write for a moment after the postmaster has ended.
  test::Hang(cluster).kill();
  auto edit = stroke(layer, 6, {{340, 240}}, 20);
  EXPECT_FALSE(send(edit));
  EXPECT_EQ(test::whole_picture(room()->pictures(), {}, camera())->rgba, picture->rgba);
  EXPECT_EQ(room()->edits().durable_sequence(), 1);

  ASSERT_TRUE(cluster.ensure_running());
  Result<room::EditAnswer> resent = fail(ErrorCode::unavailable, "", "");
  for (int i = 0; i < 600 && !resent; ++i) {
    resent = send(edit);
    if (!resent) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(resent) << resent.error().detail;
  EXPECT_TRUE(test::equal(room()->queries().tiles("layer", {})->tiles,
                          room()->queries().tiles("layer", resent->sequence)->tiles));
}

TEST_F(RoomTest, every_type_is_painted_and_read_back) {
  const std::pair<ValueType, double> cases[] = {
      {ValueType::u8, 200},     {ValueType::u16, 60000},  {ValueType::u32, 4000000000.0},
      {ValueType::i8, -100},    {ValueType::i16, -30000}, {ValueType::i32, -2000000000.0},
      {ValueType::f16, -0.375}, {ValueType::f32, 1e-3f}};
  for (const auto& [type, value] : cases) {
    const Layer layer = make_layer(type, 2048, std::string(name(type)));
    ASSERT_TRUE(send(stroke(layer, value, {{320, 240}}, 20)));
    auto picked = room()->queries().pick(camera({0.3, -1, 0.4}), 320.5, 240.5, {layer.slug});
    ASSERT_TRUE(picked);
    ASSERT_TRUE(picked->hit);
    ASSERT_EQ(picked->values.size(), 1u);
    EXPECT_TRUE(picked->values[0].valid);
    EXPECT_EQ(picked->values[0].value, value) << name(type);
  }
}

TEST_F(RoomTest, the_painted_area_is_that_of_a_disc_on_a_flat_spot) {
  // The view is orthographic along the surface normal under the cursor, so the brush is a disc of
  // known size there.
  const Layer layer = make_layer(ValueType::u8, 4096);
  auto edit = stroke(layer, 1, {{320, 240}}, 0);
  auto& batch = std::get<room::StrokeEdit>(edit.edit).batch;
  auto spot = room()->queries().pick(batch.camera, 320.5, 240.5, {});
  ASSERT_TRUE(spot && spot->hit);
  batch.camera = camera(glm::dvec3(spot->normal), true);
  // The position of the spot in the new window.
  const glm::dvec4 clip =
      batch.camera.projection * batch.camera.view * glm::dvec4(spot->position, 1);
  batch.path = {{(clip.x * 0.5 + 0.5) * 640, (0.5 - clip.y * 0.5) * 480}};
  batch.radius_px = 0;
  batch.radius_world = 2.0;  // in mm, small compared with the curvature of the pot
  auto answer = send(edit);
  ASSERT_TRUE(answer) << answer.error().detail;
  const double disc_m2 = 3.14159265 * 2.0 * 2.0 * 1e-6;
  EXPECT_NEAR(answer->area_m2, disc_m2, disc_m2 * 0.15);  // relief tilts the surface by up to 25°
}

}  // namespace
}  // namespace strata
