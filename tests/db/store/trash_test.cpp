#include "store/content/trash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "db/journal_painter.h"
#include "store/content/comments.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/people/accounts.h"
#include "store/pg/pg.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

using Kind = TrashEntry::Kind;
using std::chrono::days;

template <class... Effect>
IdempotentResponse<Effect...> by(const std::string& user) {
  return {.key = {}, .make = {}, .user = user};
}

class TrashOfAProject : public ::testing::Test {
 protected:
  std::vector<std::string> listed(Role seen_by = Role::curator) {
    std::vector<std::string> names;
    const auto page = trash_.of_project(1, {seen_by, days(30)}, 100, 0).value();
    for (const TrashEntry& entry : page.entries) names.push_back(entry.name);
    EXPECT_EQ(page.total, static_cast<std::int64_t>(names.size()));
    return names;
  }
  TrashEntry entry(Kind kind, auto id) {
    return trash_.entry(1, kind, id.number(), 0, {Role::curator, days(30)}).value();
  }
  TrashRestored restore(Kind kind, auto id) {
    return trash_.restore(entry(kind, id), by<TrashRestored>("carl")).value();
  }
  std::int64_t count(const std::string& what) {
    return connection_->query_once("SELECT count(*) FROM " + what)->integer(0, 0);
  }
  void run(const std::string& sql) { ASSERT_TRUE(connection_->script(sql)) << sql; }
  // Erases all content that is due and returns the number of steps.
  int erase_all() {
    int steps = 0;
    while (trash_.erase_some().value()) ++steps;
    return steps;
  }
  Layer new_layer(const std::string& name, Visibility visibility = Visibility::everyone) {
    Layer layer;
    layer.model_id = model_.id;
    layer.name = name;
    layer.palette = default_palette(layer.type, false);
    layer.visibility = visibility;
    return store_->layers().create(layer, by<Layer>("carl")).value();
  }
  void paint(const Layer& layer, int edits) {
    test::Painter painter(layer, 7);
    JournalWriter writer(*store_, {});
    for (int i = 0; i < edits; ++i)
      ASSERT_TRUE(test::save(writer, painter.paint(++sequence_, 3, 4)));
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Trash& trash_ = store_->trash();
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  const Model model_ = test::make_model(*store_);
  std::int64_t sequence_ = 0;
};

TEST_F(TrashOfAProject, a_layer_in_the_bin_is_there_for_nobody_and_comes_back_as_it_was) {
  Layer layer = new_layer("Cracks");
  layer.locked = true;
  layer.description = "seen by eye";
  layer = store_->layers().update(layer, by<Layer>("carl")).value();
  paint(layer, 5);
  const auto tiles = store_->journal().load_tiles(layer)->tiles;
  const auto history = store_->journal().history(layer.id, 100, 0).value();
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  EXPECT_EQ(store_->layers().find(model_.id, "cracks", Role::owner).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store_->layers().find(model_.id, to_string(layer.id), Role::owner).error().code,
            ErrorCode::not_found);
  EXPECT_TRUE(store_->layers().of_model(model_.id, Role::owner)->empty());
  EXPECT_EQ(store_->journal().load_tiles(layer).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->journal().history(layer.id, 100, 0).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->layers().update(layer).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->layers().remove(layer.id).error().code, ErrorCode::not_found);
  EXPECT_EQ(trash_.put_layer(layer.id, by<>("ada")).error().code, ErrorCode::not_found);
  for (const char* view : {"layers", "analysis.layers", "analysis.areas", "analysis.edits"})
    EXPECT_EQ(count(view), 0) << view;
  const TrashEntry in_trash = entry(Kind::layer, layer.id);
  EXPECT_EQ(in_trash.name, "Cracks");
  EXPECT_EQ(in_trash.user, "ada");
  EXPECT_EQ(in_trash.model_name, "pot");
  EXPECT_GT(in_trash.bytes, 100u);

  const TrashRestored back = restore(Kind::layer, layer.id);
  EXPECT_EQ(back.slug, "cracks");
  EXPECT_EQ(back.former_slug, "");
  const Layer now = store_->layers().find(model_.id, "cracks", Role::owner).value();
  EXPECT_EQ(now.id, layer.id);
  EXPECT_TRUE(now.locked);
  EXPECT_EQ(now.description, "seen by eye");
  EXPECT_GT(now.version, layer.version) << "who changes what they read before is told";
  const auto again = store_->journal().load_tiles(now)->tiles;
  EXPECT_EQ(test::content_of({again, 0}), test::content_of({tiles, 0}));
  EXPECT_EQ(store_->journal().history(layer.id, 100, 0)->total, history.total);
  EXPECT_THAT(listed(), ::testing::IsEmpty());
  EXPECT_EQ(trash_.restore(in_trash, by<TrashRestored>("carl")).error().code, ErrorCode::not_found)
      << "it was restored already";
  paint(now, 1);  // the journal continues after its last sequence
}

TEST_F(TrashOfAProject, a_model_takes_all_along_and_brings_it_back) {
  const Layer layer = new_layer("Cracks");
  paint(layer, 3);
  NamedPart view;
  view.model_id = model_.id;
  view.name = "Front";
  view.content = {{"light", "flat"}};
  view.user = "ada";
  ASSERT_TRUE(store_->views().create(view));
  Comment comment;
  comment.model_id = model_.id;
  comment.place = {{0, 0, 0}, {0, 0, 1}};
  comment.layer_id = layer.id;
  comment.text = "Here";
  comment.user = "ada";
  const Comment written = store_->comments().create(comment).value();
  ASSERT_TRUE(trash_.put_model(model_.id, by<>("ada")));
  EXPECT_EQ(store_->models().find("pot").error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->models().find(to_string(model_.id)).error().code, ErrorCode::not_found);
  EXPECT_TRUE(store_->models().all()->empty());
  EXPECT_EQ(store_->layers().of_model(model_.id, Role::owner).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->layers().find(model_.id, "cracks", Role::owner).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store_->models().geometry(model_.id).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->comments().comment(written.id, Role::owner).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->journal().last_sequence(model_.id).error().code, ErrorCode::not_found);
  for (const char* what :
       {"models", "layers", "analysis.models", "analysis.layers", "analysis.edits"})
    EXPECT_EQ(count(what), 0) << what;
  EXPECT_EQ(store_->attachments().drop_orphans().value(), 0) << "its files are kept";
  EXPECT_THAT(listed(), ::testing::ElementsAre("pot"));
  EXPECT_EQ(restore(Kind::model, model_.id).slug, "pot");
  EXPECT_EQ(store_->models().find("pot")->sequence, 3);
  EXPECT_EQ(store_->models().geometry(model_.id)->size(), 3u);
  EXPECT_EQ(store_->views().of_model(model_.id, 10, 0)->total, 1);
  EXPECT_EQ(store_->comments().comment(written.id, Role::owner)->layer_id, layer.id);
  EXPECT_EQ(store_->journal().load_tiles(layer)->sequence, 3);
}

TEST_F(TrashOfAProject, a_short_name_that_is_taken_meanwhile_gets_a_number) {
  const Layer layer = new_layer("Cracks");
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  EXPECT_EQ(new_layer("Cracks").slug, "cracks") << "it is free";
  const TrashRestored back = restore(Kind::layer, layer.id);
  EXPECT_EQ(back.slug, "cracks-2");
  EXPECT_EQ(back.former_slug, "cracks");
  EXPECT_EQ(store_->layers().find(model_.id, "cracks-2", Role::owner)->id, layer.id);
  ASSERT_TRUE(trash_.put_model(model_.id, by<>("ada")));
  EXPECT_EQ(test::make_model(*store_).slug, "pot");
  EXPECT_EQ(restore(Kind::model, model_.id).slug, "pot-2");
}

TEST_F(TrashOfAProject, who_does_not_see_a_layer_sees_it_in_neither_bin_nor_activity) {
  const Layer open = new_layer("Cracks"), secret = new_layer("Graves", Visibility::curators);
  paint(secret, 1);
  ASSERT_TRUE(trash_.put_layer(open.id, by<>("carl")));
  ASSERT_TRUE(trash_.put_layer(secret.id, by<>("carl")));
  EXPECT_THAT(listed(), ::testing::ElementsAre("Graves", "Cracks"));
  EXPECT_THAT(listed(Role::annotator), ::testing::IsEmpty()) << "layers are for curators";
  EXPECT_EQ(
      trash_.entry(1, Kind::layer, secret.id.number(), 0, {Role::annotator, days(30)}).error().code,
      ErrorCode::not_found);
  EXPECT_EQ(
      trash_.entry(2, Kind::layer, secret.id.number(), 0, {Role::owner, days(30)}).error().code,
      ErrorCode::not_found)
      << "of another project";
  const auto tells = [&](const std::string& name) {
    const auto page = store_->projects().activity(1, Role::viewer, {}).value();
    return std::ranges::any_of(page.lines, [&](const Activity& line) { return line.name == name; });
  };
  EXPECT_TRUE(tells("Cracks"));
  EXPECT_FALSE(tells("Graves"));
  ASSERT_TRUE(trash_.put_model(model_.id, by<>("carl")));
  EXPECT_FALSE(tells("Graves"));
  EXPECT_THAT(listed(), ::testing::ElementsAre("pot")) << "its layers come back with it";
  ASSERT_TRUE(trash_.erase(entry(Kind::model, model_.id), by<>("carl")));
  EXPECT_GT(erase_all(), 0);
  EXPECT_FALSE(tells("Graves"));
}

TEST_F(TrashOfAProject, activity_tells_who_deleted_and_restored_and_no_more_when_it_is_erased) {
  const auto lines_of_project = [&] {
    std::vector<std::string> lines;
    const auto page = store_->projects().activity(1, Role::curator, {});
    for (const Activity& line : page->lines)
      lines.push_back(line.user + " " + line.kind + " " + line.op + " " + line.name);
    return lines;
  };
  const Layer layer = new_layer("Cracks");
  run("DELETE FROM activities");
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  restore(Kind::layer, layer.id);
  EXPECT_THAT(lines_of_project(),
              ::testing::ElementsAre("carl layer restored Cracks", "ada layer deleted Cracks"));
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  ASSERT_TRUE(trash_.put_model(model_.id, by<>("ada")));
  restore(Kind::model, model_.id);
  run("DELETE FROM activities WHERE kind = 'layer'");
  EXPECT_THAT(lines_of_project(),
              ::testing::ElementsAre("carl model restored pot", "ada model deleted pot"));
  ASSERT_TRUE(trash_.erase(entry(Kind::layer, layer.id), by<>("carl")));
  EXPECT_GT(erase_all(), 0);
  EXPECT_THAT(lines_of_project(),
              ::testing::ElementsAre("carl model restored pot", "ada model deleted pot"));
}

TEST_F(TrashOfAProject, what_was_in_it_long_enough_is_erased_in_steps_and_nothing_else) {
  const Layer old = new_layer("Old"), fresh = new_layer("Fresh"), remaining = new_layer("Kept");
  for (const Layer& layer : {old, fresh, remaining}) paint(layer, 2);
  ASSERT_TRUE(trash_.put_layer(old.id, by<>("ada")));
  ASSERT_TRUE(trash_.put_layer(fresh.id, by<>("ada")));
  run("UPDATE all_layers SET binned = now() - interval '31 days' WHERE id = " + to_string(old.id));
  run("UPDATE all_layers SET binned = now() - interval '29 days' WHERE id = " +
      to_string(fresh.id));
  ASSERT_TRUE(trash_.expire(days(30)));
  EXPECT_THAT(listed(), ::testing::ElementsAre("Fresh")) << "before its content is gone";
  EXPECT_GT(erase_all(), 2);
  EXPECT_EQ(count("all_layers"), 2);
  EXPECT_EQ(count("edits"), 4);
  EXPECT_EQ(count("tile_revisions WHERE layer_id = " + to_string(old.id)), 0);
  EXPECT_FALSE(store_->journal().load_tiles(remaining)->tiles.empty());
  restore(Kind::layer, fresh.id);
  EXPECT_FALSE(store_->journal().load_tiles(fresh)->tiles.empty());
  ASSERT_TRUE(trash_.put_model(model_.id, by<>("ada")));
  run("UPDATE all_models SET binned = now() - interval '31 days'");
  ASSERT_TRUE(trash_.expire(days(30)));
  EXPECT_THAT(listed(), ::testing::IsEmpty());
  EXPECT_GT(erase_all(), 0);
  for (const char* what : {"all_models", "all_layers", "edits", "tile_revisions", "blobs"})
    EXPECT_EQ(count(what), 0) << what;
}

TEST_F(TrashOfAProject, what_is_being_erased_is_not_restored) {
  const Layer layer = new_layer("Cracks");
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  const TrashEntry known = entry(Kind::layer, layer.id);
  ASSERT_TRUE(trash_.erase(known, by<>("carl")));
  EXPECT_EQ(trash_.erase(known, by<>("carl")).error().code, ErrorCode::not_found);
  EXPECT_EQ(trash_.restore(known, by<TrashRestored>("carl")).error().code, ErrorCode::not_found);
  EXPECT_THAT(listed(), ::testing::IsEmpty());
}

TEST_F(TrashOfAProject, projects_and_tables_that_something_in_it_needs_are_kept) {
  const Project villa = store_->projects().create({0, "Villa", "villa", "", 1}).value();
  NewModel made;
  made.model.project_id = villa.id;
  made.model.name = "vase";
  made.geometry = {4};
  const Model vase = store_->models().create(made, {}).value();
  Layer units;
  units.model_id = model_.id;
  units.name = "Units";
  units.kind = LayerKind::database;
  units.type = ValueType::u16;
  units.palette = default_palette(units.type, true);
  units = store_->layers().create(units).value();
  ASSERT_TRUE(trash_.put_layer(units.id, by<>("ada")));
  ASSERT_TRUE(trash_.put_model(vase.id, by<>("ada")));
  EXPECT_THAT(store_->tables().remove(*units.table).error().detail,
              ::testing::HasSubstr("is in the Trash"));
  EXPECT_THAT(store_->projects().remove(villa.id).error().detail,
              ::testing::HasSubstr("Trash of the project still contains 1"));
  ASSERT_TRUE(trash_.erase(
      trash_.entry(villa.id, Kind::model, vase.id.number(), 0, {Role::owner, days(30)}).value(),
      by<>("carl")));
  ASSERT_TRUE(trash_.erase(entry(Kind::layer, units.id), by<>("carl")));
  EXPECT_TRUE(store_->tables().remove(*units.table)) << "before all of it is erased";
  EXPECT_TRUE(store_->projects().remove(villa.id));
  EXPECT_EQ(count("all_layers") + count("all_models WHERE id <> " + to_string(model_.id)), 0);
}

TEST_F(TrashOfAProject, a_layer_that_is_computed_from_one_in_the_bin_waits_for_it) {
  const Layer input = new_layer("Cracks");
  Layer computed;
  computed.model_id = model_.id;
  computed.name = "Sum";
  computed.palette = default_palette(computed.type, false);
  computed.formula = LayerFormula{"cracks + 1", true, 0, false, {{"cracks", input.id, {}}}, false};
  computed = store_->layers().create(computed).value();
  EXPECT_EQ(store_->layers().to_recompute()->size(), 1u);
  ASSERT_TRUE(trash_.put_layer(input.id, by<>("ada")));
  EXPECT_TRUE(store_->layers().to_recompute()->empty());
  EXPECT_FALSE(store_->layers().find(model_.id, "sum", Role::owner)->formula->inputs[0].layer);
  restore(Kind::layer, input.id);
  EXPECT_EQ(store_->layers().to_recompute()->size(), 1u);
  EXPECT_EQ(store_->layers().find(model_.id, "sum", Role::owner)->formula->inputs[0].layer,
            input.id);
}

TEST_F(TrashOfAProject, a_record_comes_back_with_its_key_and_values_once_they_fit) {
  Table table;
  table.project_id = 1;
  table.name = "Finds";
  Column name, weight;
  name.name = "name";
  name.unique = true;
  weight.name = "weight";
  weight.kind = ColumnKind::integer;
  table.columns = {name, weight};
  table = store_->tables().create(table).value();
  const ColumnId name_id = table.columns[0].id, weight_id = table.columns[1].id;
  const auto write = [&](const std::string& text) {
    WriteRecords request;
    request.records.resize(1);
    request.records[0].values = {{name_id, text}, {weight_id, 7}};
    return store_->records().write(table.id, request, "ada").value();
  };
  const std::int64_t key = write("SU 1").created.at(0);
  write("SU 2");
  ASSERT_TRUE(store_->records().remove(table.id, key, {}, "bob", false));
  EXPECT_THAT(listed(Role::annotator), ::testing::ElementsAre("SU 1"));
  EXPECT_THAT(listed(Role::viewer), ::testing::IsEmpty()) << "who may not delete does not restore";
  const Trash::Sight sight{Role::annotator, days(30)};
  const TrashEntry gone = trash_.entry(1, Kind::record, key, table.id, sight).value();
  EXPECT_EQ(gone.user, "bob");
  EXPECT_EQ(gone.table_name, "Finds");
  EXPECT_EQ(trash_.erase(gone, by<>("carl")).error().code, ErrorCode::conflict);
  const std::int64_t other = write("SU 1").created.at(0);
  EXPECT_GT(other, key + 1) << "keys are not given again";
  EXPECT_EQ(trash_.restore_record(gone, "carl", {}).error().code, ErrorCode::conflict)
      << "its name is taken";
  ASSERT_TRUE(store_->records().remove(table.id, other, {}, "bob", false));
  const TableChange back = trash_.restore_record(gone, "carl", {}).value();
  EXPECT_THAT(back.created, ::testing::ElementsAre(key));
  EXPECT_EQ(back.records.at(0).values.at(weight_id), 7);
  EXPECT_EQ(trash_.restore_record(gone, "carl", {}).error().code, ErrorCode::not_found);
  EXPECT_EQ(trash_.entry(1, Kind::record, key, table.id, sight).error().code, ErrorCode::not_found);
  EXPECT_THAT(listed(), ::testing::ElementsAre("SU 1")) << "the other one";
  EXPECT_EQ(store_->projects().activity(1, Role::viewer, {})->lines[0].op, "restore");
  run("UPDATE table_edits SET time = now() - interval '31 days' WHERE op = 'delete'");
  EXPECT_THAT(listed(), ::testing::IsEmpty());
}

TEST_F(TrashOfAProject, who_is_deleted_is_told_by_no_name_there_either) {
  ASSERT_TRUE(store_->accounts().create("ada", "Ada Lovelace", Role::curator));
  const Layer layer = new_layer("Cracks");
  ASSERT_TRUE(trash_.put_layer(layer.id, by<>("ada")));
  ASSERT_TRUE(store_->accounts().remove("ada"));
  EXPECT_THAT(entry(Kind::layer, layer.id).user, ::testing::StartsWith("former-"));
}

}  // namespace
}  // namespace strata::store
