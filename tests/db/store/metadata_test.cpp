#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/objects.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

NewModel small_model(const std::string& name, ProjectId project = 1) {
  NewModel fresh;
  fresh.model.project_id = project;
  fresh.model.name = name;
  fresh.geometry = {1, 2, 3};
  return fresh;
}

Model create(Store& store, const std::string& name) {
  return store.models().create(small_model(name), {}).value();
}

Layer new_layer(ModelId model_id, const std::string& name) {
  Layer layer;
  layer.model_id = model_id;
  layer.name = name;
  layer.palette = default_palette(ValueType::u8, false);
  return layer;
}

TEST(Projects, the_default_project_exists_and_stays) {
  auto store = test::fresh_store();
  const auto project = store->projects().find("default").value();
  EXPECT_EQ(store->projects().find(to_string(project.id))->slug, "default");
  EXPECT_EQ(store->projects().remove(project.id).error().code, ErrorCode::conflict);
  EXPECT_EQ(store->projects().all()->size(), 1u);
}

TEST(Projects, equal_names_get_slugs_of_their_own) {
  auto store = test::fresh_store();
  Project villa;
  villa.name = "Villa Adriana";
  villa.description = "Tívoli — площадь";
  EXPECT_EQ(store->projects().create(villa)->slug, "villa-adriana");
  EXPECT_EQ(store->projects().create(villa)->slug, "villa-adriana-2");
  const auto third = store->projects().create(villa).value();
  EXPECT_EQ(third.slug, "villa-adriana-3");
  EXPECT_EQ(store->projects().find("villa-adriana-3")->description, villa.description);
  Project number;
  number.name = "1937";
  EXPECT_EQ(store->projects().create(number)->slug, "n-1937");
}

TEST(Projects, changes_need_the_current_version_and_a_free_slug) {
  auto store = test::fresh_store();
  Project made;
  made.name = "Site";
  made = store->projects().create(made).value();
  made.description = "new";
  const auto changed = store->projects().update(made).value();
  EXPECT_EQ(changed.version, made.version + 1);
  EXPECT_EQ(changed.description, "new");
  EXPECT_EQ(store->projects().update(made).error().code, ErrorCode::stale);
  Project taken = changed;
  taken.slug = "default";
  EXPECT_EQ(store->projects().update(taken).error().code, ErrorCode::conflict);
  taken.slug = "12";
  EXPECT_EQ(store->projects().update(taken).error().code, ErrorCode::conflict);
  taken.id = 12345;
  taken.slug = "free";
  EXPECT_EQ(store->projects().update(taken).error().code, ErrorCode::not_found);
}

TEST(Projects, one_with_models_is_not_deleted) {
  auto store = test::fresh_store();
  Project made;
  made.name = "Site";
  made = store->projects().create(made).value();
  const auto model = store->models().create(small_model("pot", made.id), {}).value();
  EXPECT_EQ(store->projects().remove(made.id).error().code, ErrorCode::conflict);
  ASSERT_TRUE(store->models().remove(model.id));
  EXPECT_TRUE(store->projects().remove(made.id));
  EXPECT_EQ(store->projects().remove(made.id).error().code, ErrorCode::not_found);
}

TEST(Projects, unknown_and_unstorable_references_are_not_found) {
  auto store = test::fresh_store();
  for (const std::string ref :
       {"nothing", "99", "99999999999999999999999999", "", "a\xff", "'; DROP TABLE projects --"})
    EXPECT_EQ(store->projects().find(ref).error().code, ErrorCode::not_found) << ref;
  EXPECT_EQ(store->projects().find(std::string("a\0b", 3)).error().code, ErrorCode::not_found);
}

TEST(Projects, text_that_cannot_be_stored_is_the_callers_mistake) {
  auto store = test::fresh_store();
  for (const std::string& bad : {std::string("a\0b", 3), std::string("\xff\xfe"),
                                 std::string("\xc0\xaf"), std::string("\xed\xa0\x80"),
                                 std::string("\xf4\x90\x80\x80"), std::string("cut \xe2\x82")}) {
    Project project;
    project.name = bad;
    EXPECT_EQ(store->projects().create(project).error().code, ErrorCode::malformed);
    EXPECT_EQ(store->projects().create(project).error().field, "name");
    project.name = "good";
    project.description = bad;
    EXPECT_EQ(store->projects().create(project).error().field, "description");
  }
  Project nameless;
  EXPECT_EQ(store->projects().create(nameless).error().code, ErrorCode::malformed);
  nameless.name = std::string(256, 'x');
  EXPECT_EQ(store->projects().create(nameless).error().code, ErrorCode::malformed);
  nameless.name = "𝕊𝕚𝕥𝕖 ☃ é";
  EXPECT_EQ(store->projects().create(nameless)->name, nameless.name);
}

TEST(Models, every_field_comes_back) {
  auto store = test::fresh_store();
  auto fresh = small_model("Vase à figures");
  Model& m = fresh.model;
  m.unit = Unit::mm;
  m.unit_assumed = false;
  m.scale_verified = true;
  m.up = "y";
  m.north = "12.5";
  m.crs = "EPSG:32633";
  m.origin = {4'000'000.125, -1.0 / 3, 1e-300};
  m.bounds_min = {-std::numeric_limits<double>::max(), 0.1, -0.0};
  m.bounds_max = {1, 2, 3};
  m.triangles = 10'000'000'000ULL;
  m.vertices = 5;
  m.area = 0.1 + 0.2;
  m.atlas = {"made", 4096,   246,
             0.61,   0.0006, 1.25,
             3.5,    1e-9,   {{4096, 0.1, 1.0 / 3}, {8192, 1e-300, 0.2}}};
  m.repairs = {{"dropped degenerate faces", 12}, {"welded", 7}};
  m.open_edges = OpenEdges{3, 0.1 + 0.2, {0.2, 1.0 / 15}};
  m.default_resolution = 8192;
  m.inventory_number = "ÄM 21300";
  m.owner = "o";
  m.creator = "c";
  m.captured = "2020";
  m.method = "m";
  m.accuracy = "0.1 mm";
  m.processing = "p";
  m.rights_uri = "https://example.org/r";
  m.credit = "cr";
  m.object = store->objects().create(1, "Vase").value().id;
  m.survey_date = "2019-05";
  const auto made = store->models().create(fresh, {}).value();
  const auto read = store->models().find("vase-figures").value();
  EXPECT_EQ(made.id, read.id);
  m.id = read.id;
  m.slug = "vase-figures";
  EXPECT_EQ(to_json(read, "default"), to_json(m, "default"));
  EXPECT_EQ(read.origin, m.origin);
  EXPECT_EQ(read.bounds_min, m.bounds_min);
  EXPECT_EQ(read.area, m.area);
  EXPECT_EQ(read.version, 1);
  EXPECT_EQ(store->models().geometry(read.id).value(), fresh.geometry);
  EXPECT_EQ(store->journal().last_sequence(read.id).value(), 0);
}

TEST(Models, slugs_are_unique_among_all_models_and_changes_need_the_version) {
  auto store = test::fresh_store();
  const auto first = create(*store, "Pot");
  auto second = create(*store, "pot!");
  EXPECT_EQ(first.slug, "pot");
  EXPECT_EQ(second.slug, "pot-2");
  second.credit = "someone";
  second.unit = Unit::cm;
  const auto changed = store->models().update(second).value();
  EXPECT_EQ(changed.version, 2);
  EXPECT_EQ(changed.credit, "someone");
  EXPECT_EQ(changed.unit, Unit::cm);
  EXPECT_EQ(store->models().update(second).error().code, ErrorCode::stale);
  second.version = 2;
  second.slug = "pot";
  EXPECT_EQ(store->models().update(second).error().code, ErrorCode::conflict);
  second.slug = "pot-2";
  second.project_id = 77;
  EXPECT_EQ(store->models().update(second).error().code, ErrorCode::conflict);
  second.project_id = 1;
  second.id = 77;
  EXPECT_EQ(store->models().update(second).error().code, ErrorCode::not_found);
  EXPECT_EQ(store->models().all()->size(), 2u);
  EXPECT_EQ(store->models().all(ProjectId(1))->size(), 2u);
  EXPECT_EQ(store->models().all(ProjectId(2))->size(), 0u);
  EXPECT_EQ(store->models().create(small_model("x", 99), {}).error().code, ErrorCode::conflict);
}

TEST(Layers, they_come_in_drawing_order_with_every_field) {
  auto store = test::fresh_store();
  const auto model = create(*store, "pot");
  auto top = new_layer(model.id, "Top");
  top.order = 5;
  top.kind = LayerKind::database;
  top.type = ValueType::u32;
  top.resolution = 16384;
  top.unit = "%";
  top.description = "δ";
  top.opacity = 0.3;
  top.visible = false;
  top.palette.mode = PaletteMode::categorical;
  top.palette.points = {{0.1, {1, 2, 3, 4}, "crack"}, {2, {5, 6, 7, 255}, "sält"}};
  top = store->layers().create(top).value();
  const auto bottom = store->layers().create(new_layer(model.id, "Bottom")).value();
  const auto list = store->layers().of_model(model.id, Role::owner).value();
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].id, bottom.id);
  EXPECT_EQ(to_json(list[1]), to_json(top));
  EXPECT_EQ(store->tables().find(to_string(list[1].table.value()), Role::owner)->name, "Top");
  EXPECT_EQ(list[1].palette.points[0].label, "crack");
  EXPECT_EQ(list[1].opacity, 0.3);
  EXPECT_EQ(store->layers().find(model.id, "top", Role::owner)->id, top.id);
  EXPECT_EQ(store->layers().find(model.id, to_string(top.id), Role::owner)->slug, "top");
  EXPECT_EQ(store->layers().find(ModelId(model.id.number() + 1), "top", Role::owner).error().code,
            ErrorCode::not_found);
}

TEST(Layers, slugs_are_unique_in_their_model_only) {
  auto store = test::fresh_store();
  const auto one = create(*store, "one");
  const auto two = create(*store, "two");
  EXPECT_EQ(store->layers().create(new_layer(one.id, "Cracks"))->slug, "cracks");
  EXPECT_EQ(store->layers().create(new_layer(one.id, "Cracks"))->slug, "cracks-2");
  EXPECT_EQ(store->layers().create(new_layer(two.id, "Cracks"))->slug, "cracks");
  EXPECT_EQ(store->layers().create(new_layer(99, "Cracks")).error().code, ErrorCode::not_found);
  EXPECT_EQ(store->layers().of_model(99, Role::owner).error().code, ErrorCode::not_found);
}

TEST(Layers, changes_need_the_version_and_keep_to_the_rules) {
  auto store = test::fresh_store();
  const auto model = create(*store, "pot");
  store->layers().create(new_layer(model.id, "other")).value();
  auto layer = store->layers().create(new_layer(model.id, "salt")).value();
  layer.name = "Salts";
  layer.order = 3;
  const auto changed = store->layers().update(layer).value();
  EXPECT_EQ(changed.name, "Salts");
  EXPECT_EQ(changed.version, 2);
  EXPECT_EQ(store->layers().update(layer).error().code, ErrorCode::stale);
  auto named = changed;
  named.labels = {{"de", "Salze"}};
  named.descriptions = {{"pt-BR", "Brancos"}};
  named = store->layers().update(named).value();
  EXPECT_EQ(store->layers().find(model.id, "salt", Role::viewer)->labels,
            (Labels{{"de", "Salze"}}));
  EXPECT_EQ(store->layers().find(model.id, "salt", Role::viewer)->descriptions,
            (Labels{{"pt-BR", "Brancos"}}));
  named.group = "Salts of the north side";
  named = store->layers().update(named).value();
  EXPECT_EQ(store->layers().find(model.id, "salt", Role::viewer)->group, "Salts of the north side");
  EXPECT_FALSE(store->layers().find(model.id, "other", Role::viewer)->group);
  auto bad = named;
  for (const std::string& group : {std::string(), std::string(241, 'a'), std::string("\xff")}) {
    bad.group = group;
    EXPECT_EQ(store->layers().update(bad).error().field, "group");
  }
  bad = named;
  bad.group.reset();
  named = store->layers().update(bad).value();
  EXPECT_FALSE(named.group);
  bad = named;
  bad.slug = "other";
  EXPECT_EQ(store->layers().update(bad).error().code, ErrorCode::conflict);
  bad = named;
  bad.labels = {{"es_MX", "Sales"}};
  EXPECT_EQ(store->layers().update(bad).error().field, "labels");
  bad = named;
  bad.opacity = 1.5;
  EXPECT_EQ(store->layers().update(bad).error().field, "opacity");
  bad.opacity = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(store->layers().update(bad).error().field, "opacity");
  auto odd = new_layer(model.id, "odd");
  odd.resolution = 1000;
  EXPECT_EQ(store->layers().create(odd).error().code, ErrorCode::conflict);
  EXPECT_TRUE(store->layers().remove(changed.id));
  EXPECT_EQ(store->layers().remove(changed.id).error().code, ErrorCode::not_found);
  EXPECT_EQ(store->layers().update(changed).error().code, ErrorCode::not_found);
}

TEST(Layers, a_lock_is_kept_until_it_is_taken_away) {
  auto store = test::fresh_store();
  const auto model = create(*store, "pot");
  auto layer = store->layers().create(new_layer(model.id, "salt")).value();
  EXPECT_FALSE(layer.locked);
  layer.locked = true;
  layer = store->layers().update(layer).value();
  EXPECT_TRUE(layer.locked);
  EXPECT_TRUE(store->layers().widen(layer, ValueType::u16)->locked);
  layer = store->layers().of_model(model.id, Role::owner)->front();
  EXPECT_TRUE(layer.locked);
  layer.locked = false;
  EXPECT_FALSE(store->layers().update(layer)->locked);
  auto made_so = new_layer(model.id, "finished");
  made_so.locked = true;
  EXPECT_TRUE(store->layers().create(made_so)->locked);
}

}  // namespace
}  // namespace strata::store
