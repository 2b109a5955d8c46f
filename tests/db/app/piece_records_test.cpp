// Records of pieces whose keys cannot be painted: the records are deleted again, or an error names
// those that remain, with a database and a room that fail in between.
#include "app/layers/piece_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <new>
#include <numeric>
#include <thread>
#include <vector>

#include "app/change_notifier.h"
#include "app/edits.h"
#include "core/progress.h"
#include "query/statistics/key_areas.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "store/content/trash.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/room_fixture.h"

namespace strata::app {
namespace {

using Submit = std::function<void(room::EditRequest, room::Applied, room::Saved)>;

// A room that passes edits to `submit`, and everything else to another room.
class FaultyRoom final : public room::Room, private room::Edits {
 public:
  FaultyRoom(std::shared_ptr<room::Room> room, Submit submit)
      : room_(std::move(room)), submit_(std::move(submit)) {
    parts_ = {&room_->layers(),      this,
              &room_->queries(),     &room_->surface(),
              &room_->pictures(),    &room_->surface_images(),
              &room_->participants()};
  }
  Model model() const override { return room_->model(); }
  Result<Model> update_model(Model model, const store::IdempotentResponse<Model>& answer) override {
    return room_->update_model(std::move(model), answer);
  }

 private:
  void submit(room::EditRequest request, room::Applied applied, room::Saved saved) override {
    submit_(std::move(request), std::move(applied), std::move(saved));
  }
  std::int64_t sequence() const override { return room_->edits().sequence(); }
  std::int64_t durable_sequence() const override { return room_->edits().durable_sequence(); }
  room::DurableState durable_state() const override { return room_->edits().durable_state(); }
  Result<void> keep_sums(LayerId layer_id) override { return room_->edits().keep_sums(layer_id); }

  std::shared_ptr<room::Room> room_;
  Submit submit_;
};

class Notices final : public ChangeNotifier {
 public:
  void records_changed(const store::TableChange& change, const std::string&) const override {
    changes.push_back(change);
  }
  mutable std::vector<store::TableChange> changes;
};

class RecordsOfPieces : public test::RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    classes_ = make_layer(ValueType::u8, 2048, "classes");
    ASSERT_TRUE(send(stroke(classes_, 3, {{300, 240}}, 50)));
    ASSERT_TRUE(send(stroke(classes_, 3, {{420, 240}}, 30)));
    losses_ = make_losses(ValueType::u16);
    const auto preview = run({}, false);
    ASSERT_TRUE(preview) << preview.error().detail;
    ASSERT_GE(preview->regions, 2u);
    keys_.resize(preview->regions);
    std::iota(keys_.begin(), keys_.end(), 1);
  }

  Layer make_losses(ValueType type) {
    Layer layer;
    layer.name = "Losses " + std::to_string(static_cast<int>(type));
    layer.kind = LayerKind::database;
    layer.type = type;
    layer.resolution = 2048;
    layer.palette = default_palette(type, true);
    std::vector<Column> columns(1);
    columns[0].name = "Number";
    columns[0].kind = ColumnKind::numeric;
    const auto made = room()->layers().create(layer, {}, columns);
    EXPECT_TRUE(made) << made.error().detail;
    return *made;
  }

  Services services() { return {*store_, *rooms_, counters_, notices_}; }

  // Without `submit`, edits are not disturbed.
  Result<CleanupResult> run(Submit submit, bool apply = true) {
    edit_.apply = apply;
    edit_.id = random_uuid();
    if (!submit)
      submit = [this](room::EditRequest request, room::Applied applied, room::Saved saved) {
        room()->edits().submit(std::move(request), std::move(applied), std::move(saved));
      };
    FaultyRoom faulty(room(), std::move(submit));
    PieceRecords pieces;
    pieces.into = losses_.id;
    pieces.of_bits = 3;
    Progress progress;
    const Services all = services();
    return make_piece_records(all, faulty, classes_, pieces, edit_, progress);
  }

  // Returns the keys that have no record.
  std::vector<std::int64_t> missing() {
    const auto missing = store_->records().missing(*losses_.table, keys_);
    EXPECT_TRUE(missing) << missing.error().detail;
    return missing.value_or(std::vector<std::int64_t>{});
  }

  std::map<std::int64_t, query::KeyArea> areas() {
    return room()->queries().key_areas(losses_.slug).value();
  }

  // Expects that the records were created and deleted, each in one entry of the table's journal,
  // and that nobody can paint their keys.
  void expect_taken_back() {
    EXPECT_EQ(missing(), keys_);
    const auto history = store_->tables().history(*losses_.table, Role::owner, {}, 10, 0);
    ASSERT_TRUE(history) << history.error().detail;
    ASSERT_EQ(history->total, 2);
    EXPECT_EQ(history->rows[0].op, "undo");
    ASSERT_EQ(notices_.changes.size(), 1u) << "others were notified of the new records";
    EXPECT_EQ(notices_.changes[0].deleted, keys_);
    EXPECT_EQ(store_->trash()
                  .of_project(model_.project_id, {Role::owner, std::chrono::days(30)}, 10, 0)
                  ->total,
              0);
    const auto refused = send(stroke(losses_, 1, {{320, 240}}, 20));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().title, "Record was deleted");
    for (const std::int64_t key : keys_) EXPECT_FALSE(areas().contains(key)) << key;
  }

  // Expects that the error names these records.
  static void expect_remain(const Result<CleanupResult>& done,
                            const std::vector<std::int64_t>& left) {
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::conflict);
    const std::string named = "Records " + std::to_string(left.front()) + " to " +
                              std::to_string(left.back()) + " remain. ";
    EXPECT_NE(done.error().detail.find(named), std::string::npos) << done.error().detail;
  }

  void expect_kept() {
    EXPECT_TRUE(missing().empty());
    ASSERT_EQ(notices_.changes.size(), 1u);
    EXPECT_EQ(notices_.changes[0].created, keys_);
    EXPECT_TRUE(send_until_taken(stroke(losses_, 1, {{320, 240}}, 20)));
  }

  Layer classes_, losses_;
  std::vector<std::int64_t> keys_;  // the keys that the records get
  CleanupEdit edit_{true, {}, {"anna", Role::annotator}, nlohmann::json{{"op", "cleanup"}}};
  EditCounters counters_;
  Notices notices_;
};

TEST_F(RecordsOfPieces, are_created_and_painted_in_one_edit) {
  const auto done = run({});
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_TRUE(done->applied);
  EXPECT_EQ(done->keys, keys_);
  EXPECT_TRUE(done->unpainted_keys.empty());
  for (const std::int64_t key : keys_) EXPECT_TRUE(areas().contains(key)) << key;
  expect_kept();
}

TEST_F(RecordsOfPieces, are_taken_back_if_the_edit_is_refused) {
  const auto refused =
      run([](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        saved(fail(ErrorCode::forbidden, "Layer is locked", "Ask a curator."));
      });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().title, "Layer is locked");
  EXPECT_EQ(refused.error().detail, "Ask a curator.");
  expect_taken_back();
}

TEST_F(RecordsOfPieces, are_taken_back_after_an_exception) {
  const auto failed = run([](const room::EditRequest&, const room::Applied&, const room::Saved&) {
    throw std::bad_alloc();
  });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, ErrorCode::internal);
  expect_taken_back();
}

TEST_F(RecordsOfPieces, are_taken_back_if_the_job_is_canceled) {
  const auto canceled = run([](const room::EditRequest&, const room::Applied&,
                               const room::Saved& saved) { saved(cancelled_problem()); });
  ASSERT_FALSE(canceled);
  EXPECT_EQ(canceled.error().code, ErrorCode::cancelled);
  expect_taken_back();
}

TEST_F(RecordsOfPieces, are_taken_back_although_their_author_has_changed_the_table_since) {
  const auto refused =
      run([this](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        store::WriteRecords other;
        other.records = {{1000, {}}};
        EXPECT_TRUE(store_->records().write(*losses_.table, other, "anna"));
        saved(fail(ErrorCode::forbidden, "Layer is locked", "Ask a curator."));
      });
  ASSERT_FALSE(refused);
  EXPECT_EQ(missing(), keys_);
  EXPECT_TRUE(store_->records().missing(*losses_.table, std::vector<std::int64_t>{1000})->empty());
}

TEST_F(RecordsOfPieces, are_kept_if_only_the_confirmation_of_the_edit_was_lost) {
  const auto done = run([this](room::EditRequest request, const room::Applied&, room::Saved saved) {
    room()->edits().submit(std::move(request), {},
                           [saved = std::move(saved)](const Result<room::EditAnswer>& answer) {
                             EXPECT_TRUE(answer);
                             saved(fail(ErrorCode::unavailable, "Not saved", "Lost."));
                           });
  });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_TRUE(done->applied);
  EXPECT_EQ(done->keys, keys_);
  EXPECT_EQ(done->sequence, room()->edits().durable_sequence());
  for (const std::int64_t key : keys_) EXPECT_TRUE(areas().contains(key)) << key;
  expect_kept();
}

TEST_F(RecordsOfPieces, are_kept_if_others_have_painted_their_keys) {
  const auto refused =
      run([this](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        EXPECT_TRUE(send(stroke(losses_, 1, {{320, 240}}, 20, "ben")));
        saved(fail(ErrorCode::forbidden, "Layer is locked", "Ask a curator."));
      });
  expect_remain(refused, keys_);
  EXPECT_TRUE(refused.error().detail.starts_with("Ask a curator. "));
  EXPECT_TRUE(areas().contains(1)) << "the paint of the other user";
  expect_kept();
}

TEST_F(RecordsOfPieces, are_kept_with_the_values_that_others_have_entered) {
  const auto table = store_->tables().find(to_string(*losses_.table), Role::owner);
  ASSERT_TRUE(table) << table.error().detail;
  const ColumnId number = table->columns.front().id;
  const auto refused =
      run([&](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        store::WriteRecords change;
        change.records.push_back({1, {{number, 17}}});
        EXPECT_TRUE(store_->records().write(*losses_.table, change, "ben"));
        saved(cancelled_problem());
      });
  expect_remain(refused, keys_);
  expect_kept();
  EXPECT_EQ(notices_.changes[0].records.front().values.at(number), 17);
}

TEST_F(RecordsOfPieces, are_announced_without_those_that_others_have_deleted) {
  const auto refused =
      run([this](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        EXPECT_TRUE(store_->records().remove(*losses_.table, 1, std::nullopt, "ben"));
        saved(fail(ErrorCode::forbidden, "Layer is locked", "Ask a curator."));
      });
  const std::vector<std::int64_t> left(keys_.begin() + 1, keys_.end());
  expect_remain(refused, left);
  EXPECT_EQ(missing(), std::vector<std::int64_t>{1});
  ASSERT_EQ(notices_.changes.size(), 1u);
  EXPECT_EQ(notices_.changes[0].created, left);
  EXPECT_FALSE(send(stroke(losses_, 1, {{320, 240}}, 20))) << "the key of a deleted record";
  EXPECT_TRUE(send(stroke(losses_, 2, {{320, 240}}, 20)));
}

TEST_F(RecordsOfPieces, are_taken_back_if_the_id_belongs_to_the_edit_of_another_job) {
  const auto done =
      run([this](room::EditRequest request, room::Applied applied, room::Saved saved) {
        room::EditRequest first = this->request(losses_, room::FillEdit{false, 500});
        first.id = request.id;
        first.record = edit_.record;
        first.record["result"] = {{"regions", 1}, {"first_key", 500}};
        EXPECT_TRUE(send(first));
        room()->edits().submit(std::move(request), std::move(applied), std::move(saved));
      });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_TRUE(done->applied);
  EXPECT_EQ(done->keys, std::vector<std::int64_t>{500});
  EXPECT_EQ(done->regions, 1u);
  expect_taken_back();
}

TEST_F(RecordsOfPieces, may_remain_if_the_database_does_not_answer) {
  const auto refused =
      run([](const room::EditRequest&, const room::Applied&, const room::Saved& saved) {
        test::Hang(test::shared_cluster()).kill();
        saved(fail(ErrorCode::unavailable, "Not saved", "The database cannot be reached."));
      });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
  EXPECT_TRUE(refused.error().detail.starts_with("The database cannot be reached. "));
  EXPECT_NE(refused.error().detail.find(" may remain. "), std::string::npos)
      << refused.error().detail;
  ASSERT_TRUE(test::shared_cluster().ensure_running());
  for (int i = 0; i < 6000 && !store_->ready(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(missing().empty());
  EXPECT_TRUE(notices_.changes.empty());
  restart();
  EXPECT_TRUE(send_until_taken(stroke(losses_, 1, {{320, 240}}, 20)));
}

TEST_F(RecordsOfPieces, can_be_deleted_although_a_model_of_their_table_was_deleted) {
  std::future<Result<room::EditAnswer>> painted;
  std::future<Result<void>> retired;
  std::future<void> forgotten;
  {
    const test::Hang hang(test::shared_cluster());
    painted = start(stroke(losses_, 500, {{320, 240}}, 20));
    retired =
        std::async(std::launch::async, [&] { return rooms_->retire_keys(*losses_.table, keys_); });
    EXPECT_EQ(retired.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
    forgotten = std::async(std::launch::async, [&] { rooms_->forget(model_.id); });
  }
  painted.wait();
  forgotten.get();
  const auto done = retired.get();
  EXPECT_TRUE(done) << done.error().detail;
}

TEST_F(RecordsOfPieces, are_not_created_if_the_layer_cannot_store_their_keys) {
  losses_ = make_losses(ValueType::u8);
  store::WriteRecords last;
  last.records = {{255, {}}};
  ASSERT_TRUE(store_->records().write(*losses_.table, last, "anna"));
  const auto refused = run({});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "into");
  EXPECT_EQ(store_->tables().history(*losses_.table, Role::owner, {}, 10, 0)->total, 1);
  EXPECT_TRUE(areas().empty());
  EXPECT_TRUE(notices_.changes.empty());
}

TEST_F(RecordsOfPieces, are_taken_back_if_all_pieces_were_painted_in_the_meantime) {
  const auto done =
      run([this](room::EditRequest request, room::Applied applied, room::Saved saved) {
        EXPECT_TRUE(send(this->request(losses_, room::FillEdit{false, 500}, "ben")));
        room()->edits().submit(std::move(request), std::move(applied), std::move(saved));
      });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_FALSE(done->applied);
  EXPECT_EQ(done->regions, 0u);
  EXPECT_EQ(done->texels, 0u);
  EXPECT_GT(done->skipped_texels, 0u);
  EXPECT_TRUE(done->keys.empty());
  expect_taken_back();
}

TEST_F(RecordsOfPieces, of_a_piece_that_was_painted_in_the_meantime_are_named) {
  const auto done =
      run([this](room::EditRequest request, room::Applied applied, room::Saved saved) {
        EXPECT_TRUE(send(stroke(losses_, 500, {{420, 240}}, 60, "ben")));
        room()->edits().submit(std::move(request), std::move(applied), std::move(saved));
      });
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_TRUE(done->applied);
  EXPECT_EQ(done->keys, keys_);
  EXPECT_GT(done->skipped_texels, 0u);
  ASSERT_FALSE(done->unpainted_keys.empty());
  EXPECT_LT(done->unpainted_keys.size(), keys_.size());
  for (const std::int64_t key : keys_)
    EXPECT_NE(areas().contains(key), std::ranges::count(done->unpainted_keys, key) > 0) << key;
  expect_kept();
}

TEST_F(RecordsOfPieces, can_be_counted_on_a_locked_layer) {
  auto layer = room()->layers().find(losses_.slug);
  ASSERT_TRUE(layer);
  layer->locked = true;
  const auto locked = room()->layers().update(*layer);
  ASSERT_TRUE(locked) << locked.error().detail;
  const auto preview = run({}, false);
  ASSERT_TRUE(preview) << preview.error().detail;
  EXPECT_EQ(preview->regions, keys_.size());
  const auto refused = run({});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::forbidden);
  EXPECT_EQ(missing(), keys_);
}

TEST_F(RecordsOfPieces, have_a_result_in_the_journal_that_a_restart_does_not_change) {
  const auto done = run({});
  ASSERT_TRUE(done) << done.error().detail;
  for (const bool restarted : {false, true}) {
    if (restarted) restart();
    const Services all = services();
    const auto found = find_saved(all, model_.id, edit_);
    ASSERT_TRUE(found) << found.error().detail;
    ASSERT_TRUE(*found);
    EXPECT_TRUE((*found)->applied);
    EXPECT_EQ((*found)->keys, keys_);
    EXPECT_EQ((*found)->regions, keys_.size());
    EXPECT_EQ((*found)->texels, done->texels);
    EXPECT_EQ((*found)->sequence, done->sequence);
    CleanupEdit other = edit_;
    other.record["of"] = 4;
    const auto refused = find_saved(all, model_.id, other);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().field, "Idempotency-Key");
    other.id = random_uuid();
    EXPECT_FALSE(find_saved(all, model_.id, other)->has_value());
  }
}

}  // namespace
}  // namespace strata::app
