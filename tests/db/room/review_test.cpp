// Edits that wait for review: their state, their display, and the decisions of curators.
#include <gmock/gmock.h>
#include <libpq-fe.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/pictures.h"
#include "room/pipeline/provisional.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "store/journal/journal_reads.h"
#include "support/room_fixture.h"
#include "support/whole_picture.h"

namespace strata {
namespace {

using store::JournalRow;
using test::RoomTest;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Reviews : public RoomTest {
 protected:
  Layer layer_;

  void SetUp() override {
    RoomTest::SetUp();
    layer_ = waits(make_layer(ValueType::u8));
  }
  Layer waits(Layer layer, bool review = true) {
    layer = *room()->layers().find(layer.slug);
    layer.review = review;
    const auto changed = room()->layers().update(layer);
    EXPECT_TRUE(changed && changed->review == review);
    return *changed;
  }
  static room::EditRequest as_curator(room::EditRequest edit) {
    edit.author.role = Role::curator;
    return edit;
  }
  room::EditRequest review(Decision decision, store::Reviewees which = {},
                           std::string reason = "") const {
    room::EditRequest edit = request(layer_, room::ReviewEdit{decision, which, reason}, "cleo");
    edit.record = {{"op", name(decision)}, {"reason", reason}};
    return as_curator(std::move(edit));
  }
  room::EditRequest dab(double value, double x, const std::string& user = "anna") const {
    return stroke(layer_, value, {{x, 240}}, 20, user);
  }
  std::vector<JournalRow> history() {
    auto rows = store_->journal().history(layer_.id, 1000, 0)->rows;
    std::ranges::reverse(rows);
    return rows;
  }
  JournalRow row(std::int64_t sequence) { return history().at(sequence - 1); }
  TileMap tiles() { return room()->queries().tiles(layer_.slug, {})->tiles; }
  std::size_t texels_waiting() {
    std::size_t count = 0;
    const TileMap waiting = room::read_provisional(*store_, layer_).value();
    for (const auto& [tile, data] : waiting) count += static_cast<std::size_t>(data->valid.count());
    return count;
  }
  std::vector<std::uint8_t> picture() {
    return test::whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}))->rgba;
  }
};

TEST_F(Reviews, what_an_annotator_paints_is_in_force_and_marked_until_it_is_accepted) {
  const auto painted = send(dab(9, 320));
  ASSERT_TRUE(painted) << painted.error().detail;
  EXPECT_TRUE(painted->provisional);
  EXPECT_GT(painted->texels_changed, 0u);
  EXPECT_EQ(row(1).review, Review::pending);
  EXPECT_TRUE(row(1).in_force);
  EXPECT_GT(texels_waiting(), 0u);
  expect_picture_of_journal();  // computes the marks from the journal
  const TileMap then = tiles();
  const auto marked = picture();

  const auto accepted = send(review(Decision::accept, {}, "As on the plan of 1931"));
  ASSERT_TRUE(accepted) << accepted.error().detail;
  EXPECT_EQ(accepted->texels_changed, 0u);
  EXPECT_FALSE(accepted->provisional);
  EXPECT_TRUE(test::equal(tiles(), then));
  EXPECT_NE(picture(), marked);
  expect_picture_of_journal();
  EXPECT_EQ(texels_waiting(), 0u);
  EXPECT_EQ(row(1).review, Review::accepted);
  ASSERT_TRUE(row(1).reviewer);
  EXPECT_EQ(row(1).reviewer->user, "cleo");
  EXPECT_EQ(row(1).reviewer->reason, "As on the plan of 1931");
  EXPECT_EQ(row(2).op, "accept");
  expect_room_equals_journal(layer_);
}

TEST_F(Reviews, what_a_curator_paints_waits_for_nobody_and_covers_what_does) {
  ASSERT_TRUE(send(dab(9, 320)));
  const auto over = send(as_curator(stroke(layer_, 5, {{320, 240}}, 40, "cleo")));
  ASSERT_TRUE(over);
  EXPECT_FALSE(over->provisional);
  EXPECT_EQ(row(2).review, Review::none);
  EXPECT_EQ(texels_waiting(), 0u);
  const auto plain = waits(make_layer(ValueType::u8, 2048, "plain"), false);
  EXPECT_FALSE(send(stroke(plain, 3, {{320, 240}}, 20))->provisional)
      << "this layer asks for no review";
  expect_picture_of_journal();
}

TEST_F(Reviews, rejecting_takes_the_paint_out_below_what_others_painted) {
  ASSERT_TRUE(send(as_curator(dab(1, 300, "cleo"))));
  const TileMap before = tiles();
  ASSERT_TRUE(send(dab(2, 320)));
  ASSERT_TRUE(send(dab(3, 340, "ben")));
  const TileMap both = tiles();
  const auto rejected = send(review(Decision::reject, {{}, "anna"}, "This is the old restoration"));
  ASSERT_TRUE(rejected) << rejected.error().detail;
  EXPECT_GT(rejected->texels_changed, 0u);
  EXPECT_EQ(row(2).review, Review::rejected);
  EXPECT_FALSE(row(2).in_force);
  EXPECT_EQ(row(3).review, Review::pending);
  expect_picture_of_journal();
  ASSERT_TRUE(send(review(Decision::reject)));
  EXPECT_TRUE(test::equal(tiles(), before));
  EXPECT_EQ(texels_waiting(), 0u);

  // After a decision is reopened, the edits wait for review again.
  ASSERT_TRUE(send(review(Decision::reopen, {{2}, {}})));
  ASSERT_TRUE(send(review(Decision::reopen, {{3}, {}})));
  EXPECT_TRUE(test::equal(tiles(), both));
  EXPECT_EQ(row(2).review, Review::pending);
  EXPECT_FALSE(row(2).reviewer);
  ASSERT_TRUE(send(review(Decision::accept)));
  ASSERT_TRUE(send(review(Decision::reopen, {{3}, {}})));
  EXPECT_EQ(row(2).review, Review::accepted);
  EXPECT_EQ(row(3).review, Review::pending);
  EXPECT_TRUE(test::equal(tiles(), both));
  expect_picture_of_journal();
  expect_room_equals_journal(layer_);
}

TEST_F(Reviews, annotators_undo_only_what_waits_and_redo_nothing_that_was_rejected) {
  ASSERT_TRUE(send(dab(1, 300)));
  ASSERT_TRUE(send(review(Decision::accept)));
  ASSERT_TRUE(send(dab(2, 340)));
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{})));
  EXPECT_EQ(texels_waiting(), 0u);
  ASSERT_TRUE(send(request(layer_, room::RedoEdit{})));
  EXPECT_GT(texels_waiting(), 0u);
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{})));
  const auto accepted_stays = send(request(layer_, room::UndoEdit{}));
  ASSERT_FALSE(accepted_stays);
  EXPECT_EQ(accepted_stays.error().code, ErrorCode::conflict);
  EXPECT_THAT(accepted_stays.error().detail, ::testing::HasSubstr("waits for review"));

  ASSERT_TRUE(send(request(layer_, room::RedoEdit{})));
  ASSERT_TRUE(send(review(Decision::reject)));
  EXPECT_EQ(send(request(layer_, room::RedoEdit{})).error().code, ErrorCode::conflict);
  EXPECT_EQ(send(as_curator(request(layer_, room::RedoEdit{}))).error().code, ErrorCode::conflict)
      << "anna as a curator, too";
  // Accepted edits can be undone as usual by curators, and on layers without review.
  EXPECT_TRUE(send(as_curator(request(layer_, room::UndoEdit{}))));
  expect_picture_of_journal();
}

TEST_F(Reviews, a_batch_stands_for_its_stroke_and_what_does_not_wait_is_refused) {
  auto first = dab(1, 300), second = dab(2, 340);
  std::get<room::StrokeEdit>(second.edit).stroke = std::get<room::StrokeEdit>(first.edit).stroke;
  std::get<room::StrokeEdit>(second.edit).n = 1;
  ASSERT_TRUE(send(first));
  ASSERT_TRUE(send(second));
  ASSERT_TRUE(send(dab(3, 380)));
  const auto queue = store_->journal().review_queue(layer_.id, {}, 10, 0);
  ASSERT_TRUE(queue) << queue.error().detail;
  ASSERT_EQ(queue->strokes.size(), 2u);
  EXPECT_EQ(queue->total, 2);
  EXPECT_EQ(queue->strokes[0].sequence, 1);
  EXPECT_EQ(queue->strokes[0].last, 2);
  EXPECT_EQ(queue->strokes[1].sequence, 3);
  EXPECT_EQ(store_->journal().review_queue(layer_.id, {}, 1, 1)->strokes.at(0).sequence, 3);
  EXPECT_EQ(store_->journal().review_queue(layer_.id, "ben", 10, 0)->total, 0);

  const auto decision = review(Decision::reject, {{2}, {}});
  ASSERT_TRUE(send(decision));
  EXPECT_EQ(row(1).review, Review::rejected);
  EXPECT_EQ(row(2).review, Review::rejected);
  EXPECT_EQ(row(3).review, Review::pending);
  const auto again = send(decision);
  ASSERT_TRUE(again) << "the same message again";
  EXPECT_TRUE(again->repeated);

  const TileMap then = tiles();
  const auto is_refused = [&](const room::EditRequest& request) {
    const auto answer = send(request);
    return !answer && answer.error().code == ErrorCode::conflict;
  };
  EXPECT_TRUE(is_refused(review(Decision::accept, {{1}, {}})));
  EXPECT_TRUE(is_refused(review(Decision::accept, {{3, 1}, {}}))) << "of which one is decided";
  EXPECT_TRUE(is_refused(review(Decision::accept, {{77}, {}})));
  EXPECT_TRUE(is_refused(review(Decision::accept, {{}, "ben"})));
  EXPECT_TRUE(is_refused(review(Decision::reopen, {{3}, {}})));
  EXPECT_EQ(row(3).review, Review::pending);
  EXPECT_TRUE(test::equal(tiles(), then));
}

TEST_F(Reviews, a_strokes_id_is_its_authors_and_each_decision_is_taken_back_by_itself) {
  auto annas = dab(1, 300), bens = dab(2, 340, "ben");
  std::get<room::StrokeEdit>(bens.edit).stroke = std::get<room::StrokeEdit>(annas.edit).stroke;
  ASSERT_TRUE(send(annas));
  ASSERT_TRUE(send(bens));
  const auto queue = store_->journal().review_queue(layer_.id, {}, 10, 0);
  ASSERT_EQ(queue->strokes.size(), 2u);
  EXPECT_EQ(queue->strokes[1].user, "ben");
  EXPECT_EQ(queue->strokes[1].sequence, 2);
  ASSERT_TRUE(send(review(Decision::accept, {{1}, {}})));
  EXPECT_EQ(row(2).review, Review::pending) << "ben's edit under the id of anna's stroke";
  ASSERT_TRUE(send(review(Decision::reject, {{2}, {}})));

  auto begun = dab(3, 300), ended = dab(4, 340);
  std::get<room::StrokeEdit>(ended.edit).stroke = std::get<room::StrokeEdit>(begun.edit).stroke;
  std::get<room::StrokeEdit>(ended.edit).n = 1;
  ASSERT_TRUE(send(begun));
  ASSERT_TRUE(send(review(Decision::accept, {{5}, {}})));
  ASSERT_TRUE(send(ended));
  ASSERT_TRUE(send(review(Decision::reject, {{7}, {}})));
  ASSERT_TRUE(send(review(Decision::reopen, {{7}, {}})));
  EXPECT_EQ(row(7).review, Review::pending);
  EXPECT_EQ(row(5).review, Review::accepted) << "it was decided by itself";
}

TEST_F(Reviews, what_waits_keeps_waiting_when_the_layer_asks_for_no_review_any_more) {
  ASSERT_TRUE(send(dab(1, 300)));
  layer_ = waits(layer_, false);
  ASSERT_TRUE(send(dab(2, 340)));
  EXPECT_EQ(row(1).review, Review::pending);
  EXPECT_EQ(row(2).review, Review::none);
  restart();
  EXPECT_FALSE(room()->layers().find(layer_.slug)->review);
  ASSERT_TRUE(send(review(Decision::accept)));
  EXPECT_EQ(texels_waiting(), 0u);
  EXPECT_EQ(send(review(Decision::accept)).error().code, ErrorCode::conflict);
}

TEST_F(Reviews, marks_are_taken_back_with_edits_that_cannot_be_saved_and_come_back_with_the_gpu) {
  const auto execute = [&](const char* sql) {
    std::unique_ptr<PGconn, decltype(&PQfinish)> connection(PQconnectdb(dsn_.c_str()), &PQfinish);
    std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection.get(), sql), &PQclear);
    ASSERT_EQ(PQresultStatus(result.get()), PGRES_COMMAND_OK) << PQerrorMessage(connection.get());
  };
  ASSERT_TRUE(send(dab(1, 300)));
  const auto one = picture();
  execute("alter table edits add constraint no_more check (sequence < 2) not valid");
  EXPECT_FALSE(send(dab(2, 340)));
  EXPECT_FALSE(send(review(Decision::accept)));
  EXPECT_EQ(picture(), one);
  execute("alter table edits drop constraint no_more");
  ASSERT_TRUE(send_until_taken(dab(2, 340)));
  expect_picture_of_journal();
  renderer_->lose_context_for_test();
  expect_picture_of_journal();
}

TEST_F(Reviews, a_picture_of_the_newest_durable_state_is_hatched_as_that_of_now_is) {
  const auto picture_at = [&](const room::DurableState& state, bool hatched = true) {
    room::PictureRequest picture_request;
    picture_request.at = state.sequence;
    if (hatched) picture_request.provisional = state.provisional;
    return test::whole_picture(room()->pictures(), picture_request, camera({0.3, -1, 0.4}))->rgba;
  };
  std::unique_ptr<PGconn, decltype(&PQfinish)> other(PQconnectdb(dsn_.c_str()), &PQfinish);
  const auto execute = [&](const char* sql) {
    std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(other.get(), sql), &PQclear);
    ASSERT_EQ(PQresultStatus(result.get()), PGRES_COMMAND_OK) << PQerrorMessage(other.get());
  };
  // Submits edits and waits until the last one is visible but no edit is durable. Then reads the
  // newest durable state.
  const auto while_unsaved = [&](std::vector<room::EditRequest> edits, const auto& image) {
    execute("begin");
    execute("lock table edits in share row exclusive mode");  // allows reading but not writing
    const auto seen = std::make_shared<std::promise<void>>();
    std::vector<std::future<Result<room::EditAnswer>>> answers;
    for (std::size_t i = 0; i + 1 < edits.size(); ++i) answers.push_back(start(edits[i]));
    const auto answer = std::make_shared<std::promise<Result<room::EditAnswer>>>();
    answers.push_back(answer->get_future());
    room()->edits().submit(
        edits.back(), [seen](const auto&) { seen->set_value(); },
        [answer](auto result) { answer->set_value(result); });
    const bool is_seen =
        seen->get_future().wait_for(std::chrono::minutes(2)) == std::future_status::ready;
    EXPECT_TRUE(is_seen);
    if (is_seen) image(room()->edits().durable_state());
    execute("commit");
    for (auto& saved : answers) EXPECT_TRUE(saved.get());
  };

  const auto bare = picture();
  while_unsaved({dab(1, 300)}, [&](const room::DurableState& before) {
    EXPECT_EQ(before.sequence, 0);
    EXPECT_THAT(before.provisional, IsEmpty());
    EXPECT_NE(picture(), bare);
    EXPECT_EQ(picture_at(before), bare);
  });
  const auto one = picture();
  const auto saved = room()->edits().durable_state();
  EXPECT_EQ(saved.sequence, 1);
  EXPECT_EQ(picture_at(saved), one);
  EXPECT_NE(picture_at(saved, false), one);

  while_unsaved({dab(2, 310, "ben"), dab(2, 360, "ben"), as_curator(dab(3, 300, "cleo"))},
                [&](const room::DurableState& still) {
                  EXPECT_EQ(still.sequence, 1);
                  ASSERT_EQ(still.provisional.size(), 1u);
                  EXPECT_TRUE(test::equal(still.provisional.begin()->second,
                                          saved.provisional.begin()->second));
                  EXPECT_NE(picture(), one);
                  EXPECT_EQ(picture_at(still), one);
                });
  const auto all = room()->edits().durable_state();
  EXPECT_EQ(all.sequence, 4);
  EXPECT_EQ(picture_at(all), picture());

  const auto seen_by_viewers = [&] {
    return (*rooms_->open(model_.slug, Role::viewer))->edits().durable_state().provisional;
  };
  EXPECT_TRUE(seen_by_viewers().contains(layer_.id));
  Layer hidden = *room()->layers().find(layer_.slug);
  hidden.visibility = Visibility::curators;
  ASSERT_TRUE(room()->layers().update(hidden));
  EXPECT_THAT(seen_by_viewers(), IsEmpty());
}

// Checks the layer and its pending edits by the journal's rule: each texel has the value of the
// newest edit in force. A separate model records the state of the edits.
TEST_F(Reviews, any_order_of_edits_undos_and_decisions_equals_the_oracle) {
  struct Stroke {
    std::string user;
    std::uint32_t value;
    bool in_force = true;
    Review review;
    std::map<TileAddress, TileMask> written{};
  };
  for (unsigned seed = 0; seed < 3; ++seed) {
    layer_ = waits(make_layer(ValueType::u8, 2048, "layer" + std::to_string(seed)));
    std::mt19937 random(seed);
    std::map<std::int64_t, Stroke> strokes;
    const auto pick_of = [&](auto which) {
      std::vector<std::int64_t> found;
      for (const auto& [sequence, stroke] : strokes)
        if (which(stroke)) found.push_back(sequence);
      return found.empty() ? 0 : found[random() % found.size()];
    };
    for (int step = 0; step < 24; ++step) {
      const std::string user = random() % 2 ? "anna" : "ben";
      const auto is_waiting = [](const Stroke& stroke) {
        return stroke.in_force && stroke.review == Review::pending;
      };
      if (strokes.size() < 3 || random() % 2) {
        const bool curates = random() % 4 == 0;
        const std::uint32_t value = 1 + random() % 200;
        auto edit = dab(value, 260.0 + random() % 120, curates ? "cleo" : user);
        const auto done = send(curates ? as_curator(edit) : edit);
        ASSERT_TRUE(done) << done.error().detail;
        Stroke& made = strokes[done->sequence];
        made = {curates ? "cleo" : user, value, true, curates ? Review::none : Review::pending};
        const auto written = store_->journal().written_by(layer_, std::vector{done->sequence});
        for (const auto& tile : *written) made.written[tile.tile] = tile.written;
      } else if (random() % 4 == 0) {
        std::int64_t newest = 0;
        for (const auto& [sequence, stroke] : strokes)
          if (stroke.user == user && is_waiting(stroke)) newest = sequence;
        EXPECT_EQ(send(request(layer_, room::UndoEdit{}, user)).has_value(), newest != 0);
        if (newest) strokes[newest].in_force = false;
      } else if (random() % 3 == 0) {
        const auto decided = pick_of([](const Stroke& stroke) {
          return stroke.review == Review::rejected ||
                 (stroke.review == Review::accepted && stroke.in_force);
        });
        if (!decided) continue;
        ASSERT_TRUE(send(review(Decision::reopen, {{decided}, {}})));
        strokes[decided].in_force = true;
        strokes[decided].review = Review::pending;
      } else if (const auto waiting = pick_of(is_waiting)) {
        const Decision decision = random() % 2 ? Decision::accept : Decision::reject;
        ASSERT_TRUE(send(review(decision, {{waiting}, {}})));
        strokes[waiting].review = outcome(decision);
        strokes[waiting].in_force = decision == Decision::accept;
      }
    }
    TileMap content, features;
    for (const auto& [sequence, stroke] : strokes) {
      if (!stroke.in_force) continue;
      for (const auto& [address, written] : stroke.written) {
        auto tile = std::make_shared<TileData>(content[address] ? *content[address]
                                                                : TileData(ValueType::u8));
        for (int texel = 0; texel < kTexelsPerTile; ++texel)
          if (written.test(texel)) tile->write(texel, stroke.value);
        content[address] = tile;
        auto feature = std::make_shared<TileData>(features[address] ? *features[address]
                                                                    : TileData(ValueType::u8));
        for (int texel = 0; texel < kTexelsPerTile; ++texel)
          if (written.test(texel) && stroke.review == Review::pending)
            feature->write(texel, 1);
          else if (written.test(texel))
            feature->clear(texel);
        features[address] = feature;
      }
    }
    const auto drop_empty = [](TileMap& map) {
      std::erase_if(map, [](auto& entry) { return !entry.second->valid.any(); });
    };
    drop_empty(content);
    drop_empty(features);
    EXPECT_TRUE(test::equal(tiles(), content)) << "seed " << seed;
    EXPECT_TRUE(test::equal(room::read_provisional(*store_, layer_).value(), features))
        << "seed " << seed;
    EXPECT_TRUE(test::equal(room()->edits().durable_state().provisional[layer_.id], features))
        << "seed " << seed;
    // Compares the room's own marks with the marks of the journal.
    expect_picture_of_journal();
    expect_room_equals_journal(layer_);
  }
}

}  // namespace
}  // namespace strata
