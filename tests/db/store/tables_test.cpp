#include <gtest/gtest.h>

#include <thread>

#include "store/cluster/migrations.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "strata_dirs.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using nlohmann::json;

Column column(const std::string& name, ColumnKind kind = ColumnKind::text) {
  Column made;
  made.name = name;
  made.kind = kind;
  if (kind == ColumnKind::enumeration) made.choices = {"good", "poor"};
  return made;
}

class Tables : public ::testing::Test {
 protected:
  Table make(const std::string& name, std::vector<Column> columns) {
    Table table;
    table.project_id = 1;
    table.name = name;
    table.columns = std::move(columns);
    auto made = store_->tables().create(table);
    EXPECT_TRUE(made) << made.error().detail;
    return made.value_or(Table{});
  }
  // Writes one record. With a key, replaces an existing record.
  Result<TableChange> put(const Table& table, std::optional<std::int64_t> key,
                          const std::map<std::string, json>& values,
                          const std::string& user = "ana",
                          std::optional<std::int64_t> version = {}) {
    RecordInput input{key, {}, version};
    const Table now = store_->tables().find(to_string(table.id), Role::owner).value();
    for (const auto& [slug, value] : values)
      input.values[find_column(now.columns, slug)->id] = value;
    WriteRecords request;
    request.records = {input};
    auto change = store_->records().write(table.id, request, user);
    if (change && !change->problems.empty())
      return tl::unexpected(change->problems.front().problem);
    return change;
  }
  Result<TableChange> undo(const Table& table, const std::string& user = "ana", bool redo = false) {
    auto plan = store_->tables().plan_undo(table.id, user, redo);
    if (!plan) return tl::unexpected(plan.error());
    return store_->tables().undo(table.id, user, redo, plan->table_sequence);
  }
  // Returns {key: {slug: value}} without null values.
  json content(const Table& table, std::optional<std::int64_t> at = {}) {
    auto page = store_->records().page(table.id, Role::owner, {{}, {}, at, 1000, 0});
    EXPECT_TRUE(page) << page.error().detail;
    json all = json::object();
    if (page)
      for (const Record& record : page->records) {
        json& values = all[std::to_string(record.key)] = json::object();
        const json body = to_json(record, page->table.columns);
        for (const auto& [slug, value] : body.at("values").items())
          if (!value.is_null()) values[slug] = value;
      }
    return all;
  }
  std::vector<std::int64_t> keys(const Table& table,
                                 std::vector<std::pair<std::string, bool>> order) {
    std::vector<std::int64_t> found;
    auto page = store_->records().page(table.id, Role::owner, {std::move(order), {}, {}, 1000, 0});
    EXPECT_TRUE(page) << page.error().detail;
    for (const Record& record : page->records) found.push_back(record.key);
    return found;
  }
  Table now(const Table& table) {
    return store_->tables().find(to_string(table.id), Role::owner).value();
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
};

TEST_F(Tables, values_of_every_kind_come_back_as_they_were) {
  const Table other = make("Finds", {column("Name")});
  ASSERT_TRUE(put(other, 4294967295, {{"name", "last"}}));
  std::vector<Column> columns;
  for (int i = 0; i <= static_cast<int>(ColumnKind::relation); ++i) {
    const auto kind = static_cast<ColumnKind>(i);
    columns.push_back(column(std::string(name(kind)), kind));
    if (kind == ColumnKind::term || kind == ColumnKind::relation) columns.back().target = other.id;
  }
  const Table table = make("All kinds", columns);
  EXPECT_EQ(table.slug, "all-kinds");
  const std::map<std::string, json> values = {{"text", "Größe '; DROP TABLE records.t1; --"},
                                              {"integer", -9007199254740992},
                                              {"numeric", 0.1},
                                              {"boolean", false},
                                              {"date", "0001-12-31"},
                                              {"timestamp", "1066-10-14T09:30:00.125Z"},
                                              {"period", "-0043~/.."},
                                              {"enumeration", "poor"},
                                              {"url", "https://example.org/?a=b"},
                                              {"term", 4294967295},
                                              {"relation", {4294967295}}};
  const auto change = put(table, {}, values);
  ASSERT_TRUE(change) << change.error().detail;
  EXPECT_EQ(change->created, std::vector<std::int64_t>{1});
  json expected;
  for (const auto& [slug, value] : values) expected[slug] = value;
  EXPECT_EQ(content(table).at("1"), expected);
  for (const char* numeric : {"3.0", "1e300", "-5e-324", "123456789.123456789"}) {
    ASSERT_TRUE(put(table, 1, {{"numeric", json::parse(numeric)}}));
    EXPECT_EQ(content(table)["1"]["numeric"], json::parse(numeric));
  }
}

TEST_F(Tables, a_catalogue_keeps_names_in_any_language) {
  Column name = column("Naam; DROP SCHEMA records");
  name.labels = {{"es", "Nombre"}, {"el", "Όνομα"}};
  Table requested;
  requested.project_id = 1;
  requested.name = "Ενότητες";
  requested.labels = {{"en", "Units"}};
  requested.columns = {name, column("Όνομα"), column("Όνομα")};
  auto made = store_->tables().create(requested);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->columns[0].labels, name.labels);
  EXPECT_EQ(made->columns[1].slug, "n");
  EXPECT_EQ(made->columns[2].slug, "n-2");
  made->name = "Units";
  made->labels["de"] = "Einheiten";
  auto renamed = store_->tables().update(*made);
  ASSERT_TRUE(renamed) << renamed.error().detail;
  EXPECT_EQ(renamed->version, made->version + 1);
  EXPECT_EQ(renamed->labels.at("de"), "Einheiten");
  EXPECT_EQ(store_->tables().update(*made).error().code, ErrorCode::stale);
  EXPECT_EQ(store_->tables().of_project(1, Role::owner)->size(), 1u);
  EXPECT_EQ(store_->tables().find("units", Role::owner).error().code, ErrorCode::not_found);
}

TEST_F(Tables, keys_are_never_given_again) {
  const Table table = make("Units", {column("Name")});
  EXPECT_EQ(put(table, {}, {{"name", "a"}})->created, std::vector<std::int64_t>{1});
  EXPECT_EQ(put(table, 7, {{"name", "b"}})->created, std::vector<std::int64_t>{7});
  EXPECT_EQ(put(table, {}, {{"name", "c"}})->created, std::vector<std::int64_t>{8});
  ASSERT_TRUE(store_->records().remove(table.id, 8, {}, "ana"));
  EXPECT_EQ(put(table, 8, {{"name", "d"}}).error().title, "Key already used");
  EXPECT_EQ(put(table, {}, {{"name", "d"}})->created, std::vector<std::int64_t>{9});
  EXPECT_EQ(put(table, 4294967295, {})->created, std::vector<std::int64_t>{4294967295});
  EXPECT_EQ(put(table, {}, {}).error().title, "No keys left");
  EXPECT_EQ(put(table, 4294967296, {}).error().field, "key");
}

TEST_F(Tables, of_two_who_change_a_record_the_second_is_told) {
  const Table table = make("Units", {column("Name")});
  const auto first = put(table, 1, {{"name", "a"}})->records.at(0).version;
  ASSERT_TRUE(put(table, 1, {{"name", "b"}}, "ana", first));
  EXPECT_EQ(put(table, 1, {{"name", "c"}}, "ben", first).error().code, ErrorCode::stale);
  EXPECT_EQ(store_->records().remove(table.id, 1, first, "ben").error().code, ErrorCode::stale);
  EXPECT_EQ(content(table)["1"]["name"], "b");
}

TEST_F(Tables, what_stays_the_same_is_no_entry) {
  const Table table = make("Units", {column("Name")});
  ASSERT_TRUE(put(table, 1, {{"name", "a"}}));
  EXPECT_EQ(put(table, 1, {{"name", "a"}})->sequence, 0);
  EXPECT_EQ(now(table).sequence, 1);
}

TEST_F(Tables, required_and_unique_columns_hold_for_every_way_in) {
  Column code = column("Code");
  code.required = code.unique = true;
  const Table table = make("Units", {code, column("Name")});
  EXPECT_EQ(put(table, 1, {{"name", "a"}}).error().field, "values.code");
  ASSERT_TRUE(put(table, 1, {{"code", "A"}}));
  const auto twice = put(table, 2, {{"code", "A"}});
  EXPECT_EQ(twice.error().code, ErrorCode::conflict);
  EXPECT_NE(twice.error().detail.find("Record 1"), std::string::npos);
  EXPECT_EQ(put(table, 1, {{"code", nullptr}}).error().code, ErrorCode::invalid);
  EXPECT_EQ(put(table, 2, {{"code", std::string(kMaxUniqueTextLength + 1, 'x')}}).error().field,
            "values.code");
  // Writes two records in one call. A swap of unique values is valid only if both change together.
  ASSERT_TRUE(put(table, 2, {{"code", "B"}}));
  const auto code_id = table.columns[0].id;
  WriteRecords both;
  both.records = {{1, {{code_id, "B"}}}, {2, {{code_id, "A"}}}};
  EXPECT_TRUE(store_->records().write(table.id, both, "ana")->problems.empty());
  EXPECT_EQ(content(table), (json{{"1", {{"code", "B"}}}, {"2", {{"code", "A"}}}}));
  both.records = {{3, {{code_id, "C"}}}, {4, {{code_id, "C"}}}};
  EXPECT_EQ(store_->records().write(table.id, both, "ana")->problems.size(), 1u);
  // Making a column unique checks the existing values.
  ASSERT_TRUE(put(table, 1, {{"name", "same"}}));
  ASSERT_TRUE(put(table, 2, {{"name", "same"}}));
  Column name = now(table).columns[1];
  name.unique = true;
  EXPECT_EQ(store_->tables().update_column(table.id, name, {}, "ana").error().title,
            "Value is not unique");
  name.unique = false;
  name.required = true;
  ASSERT_TRUE(store_->tables().update_column(table.id, name, {}, "ana"));
  EXPECT_EQ(put(table, 3, {{"code", "C"}}).error().field, "values.name");
}

TEST_F(Tables, terms_and_relations_name_records_that_are_there) {
  const Table terms = make("Terms", {column("Name")});
  ASSERT_TRUE(put(terms, 1, {{"name", "crack"}}));
  Column term = column("Damage", ColumnKind::term), above = column("Above", ColumnKind::relation);
  term.target = terms.id;
  const Table units = make("Units", {term});
  above.target = units.id;
  ASSERT_TRUE(store_->tables().create_column(units.id, above, "ana"));
  EXPECT_EQ(put(units, 1, {{"damage", 2}}).error().field, "values.damage");
  ASSERT_TRUE(put(units, 1, {{"damage", 1}}));
  EXPECT_EQ(put(units, 2, {{"above", {1, 3}}}).error().field, "values.above");
  ASSERT_TRUE(put(units, 2, {{"above", {1, 2}}}));  // a reference to itself, made by the same call
  EXPECT_EQ(store_->records().remove(terms.id, 1, {}, "ana").error().title, "Record in use");
  EXPECT_EQ(store_->records().remove(units.id, 1, {}, "ana").error().title, "Record in use");
  EXPECT_EQ(undo(terms).error().code, ErrorCode::conflict);
  ASSERT_TRUE(store_->records().remove(units.id, 2, {}, "ana"));
  ASSERT_TRUE(store_->records().remove(units.id, 1, {}, "ana"));
  ASSERT_TRUE(store_->records().remove(terms.id, 1, {}, "ana"));
  EXPECT_EQ(undo(units).error().title, "Cannot undo");  // its term no longer exists
  EXPECT_EQ(store_->tables().remove(terms.id).error().title, "Table in use");
  ASSERT_TRUE(store_->tables().remove(units.id));
  ASSERT_TRUE(store_->tables().remove(terms.id));
  EXPECT_EQ(store_->tables().of_project(1, Role::owner)->size(), 0u);
  Column foreign = column("x", ColumnKind::term);
  foreign.target = terms.id;
  EXPECT_EQ(store_->tables().create_column(make("New", {}).id, foreign, "ana").error().field,
            "target");
}

TEST_F(Tables, undo_takes_back_what_one_person_did_and_leaves_what_others_did) {
  const Table table = make("Units", {column("Name"), column("Depth", ColumnKind::numeric)});
  ASSERT_TRUE(put(table, 1, {{"name", "a"}, {"depth", 1.5}}, "ana"));
  ASSERT_TRUE(put(table, 1, {{"name", "b"}}, "ben"));
  ASSERT_TRUE(put(table, 1, {{"depth", 2.5}}, "ana"));
  ASSERT_TRUE(undo(table, "ana"));
  EXPECT_EQ(content(table)["1"], (json{{"name", "b"}, {"depth", 1.5}}));
  const auto plan = store_->tables().plan_undo(table.id, "ana", false).value();
  EXPECT_EQ(plan.vanishing, std::vector<std::int64_t>{1});
  ASSERT_TRUE(undo(table, "ana"));
  EXPECT_EQ(content(table), json::object());
  EXPECT_EQ(undo(table, "ana").error().code, ErrorCode::conflict);
  ASSERT_TRUE(undo(table, "ana", true));
  EXPECT_EQ(content(table)["1"], (json{{"name", "b"}, {"depth", 1.5}}));  // includes Ben's value
  ASSERT_TRUE(undo(table, "ana", true));
  EXPECT_EQ(content(table)["1"]["depth"], 2.5);
  EXPECT_EQ(undo(table, "ana", true).error().title, "Nothing to redo");
  // A plan is valid only until the next edit.
  const auto old = store_->tables().plan_undo(table.id, "ana", false).value();
  ASSERT_TRUE(put(table, 2, {}, "ben"));
  EXPECT_EQ(store_->tables().undo(table.id, "ana", false, old.table_sequence).error().code,
            ErrorCode::stale);
}

TEST_F(Tables, one_entry_is_undone_after_later_ones_and_not_redone) {
  const Table table = make("Units", {column("Name")});
  const auto name_id = table.columns[0].id;
  WriteRecords two;
  two.records = {{{}, {{name_id, "a"}}}, {{}, {{name_id, "b"}}}};
  const auto made = store_->records().write(table.id, two, "ana");
  ASSERT_TRUE(made);
  ASSERT_EQ(made->created, (std::vector<std::int64_t>{1, 2}));
  ASSERT_TRUE(put(table, 3, {{"name", "c"}}, "ana"));
  ASSERT_TRUE(put(table, 4, {{"name", "d"}}, "ben"));
  EXPECT_EQ(store_->tables().undo_entry(table.id, made->sequence, "ben").error().code,
            ErrorCode::conflict)
      << "the entry of another user";
  const auto undone = store_->tables().undo_entry(table.id, made->sequence, "ana");
  ASSERT_TRUE(undone) << undone.error().detail;
  EXPECT_EQ(undone->deleted, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(content(table), (json{{"3", {{"name", "c"}}}, {"4", {{"name", "d"}}}}));
  EXPECT_EQ(store_->tables().undo_entry(table.id, made->sequence, "ana").error().code,
            ErrorCode::conflict)
      << "an entry that is not in force";
  EXPECT_FALSE(undo(table, "ana", true)) << "nothing to redo";
  ASSERT_TRUE(undo(table, "ana", false));
  EXPECT_FALSE(content(table).contains("3"));
  ASSERT_TRUE(undo(table, "ana", true)) << "an undo of the user";
  EXPECT_EQ(content(table)["3"], (json{{"name", "c"}}));
  EXPECT_FALSE(undo(table, "ana", true));
  EXPECT_EQ(content(table).size(), 2u);
}

TEST_F(Tables, one_entry_is_not_undone_after_a_change_of_one_of_its_records) {
  const Table table = make("Units", {column("Name")});
  const auto name_id = table.columns[0].id;
  const auto create = [&] {
    WriteRecords two;
    two.records = {{{}, {{name_id, "a"}}}, {{}, {{name_id, "b"}}}};
    return store_->records().write(table.id, two, "ana").value();
  };
  const auto refused = [&](const TableChange& made) {
    const json before = content(table);
    const auto undone = store_->tables().undo_entry(table.id, made.sequence, "ana");
    ASSERT_FALSE(undone);
    EXPECT_EQ(undone.error().code, ErrorCode::conflict);
    EXPECT_EQ(content(table), before);
  };
  const TableChange changed = create();
  ASSERT_TRUE(put(table, changed.created[1], {{"name", "c"}}, "ben"));
  refused(changed);
  const TableChange deleted = create();
  ASSERT_TRUE(store_->records().remove(table.id, deleted.created[0], std::nullopt, "ben"));
  refused(deleted);
}

TEST_F(Tables, the_past_is_read_with_the_columns_of_then) {
  const Table table = make("Units", {column("Name")});
  ASSERT_TRUE(put(table, 1, {{"name", "a"}}));  // 1
  Column depth = column("Depth", ColumnKind::numeric);
  depth.default_value = 1;
  ASSERT_TRUE(store_->tables().create_column(table.id, depth, "ana"));                  // 2
  ASSERT_TRUE(put(table, 2, {{"name", "b"}, {"depth", 3}}));                            // 3
  ASSERT_TRUE(store_->tables().drop_column(table.id, table.columns[0].id, {}, "ana"));  // 4
  ASSERT_TRUE(store_->records().remove(table.id, 1, {}, "ana"));                        // 5
  ASSERT_TRUE(undo(table));                                                             // 6
  EXPECT_EQ(content(table, 0), json::object());
  EXPECT_EQ(content(table, 1), (json{{"1", {{"name", "a"}}}}));
  EXPECT_EQ(content(table, 2), (json{{"1", {{"name", "a"}, {"depth", 1.0}}}}));
  EXPECT_EQ(content(table, 3),
            (json{{"1", {{"name", "a"}, {"depth", 1.0}}}, {"2", {{"name", "b"}, {"depth", 3.0}}}}));
  EXPECT_EQ(content(table, 4), (json{{"1", {{"depth", 1.0}}}, {"2", {{"depth", 3.0}}}}));
  EXPECT_EQ(content(table, 5), (json{{"2", {{"depth", 3.0}}}}));
  EXPECT_EQ(content(table, 6), content(table, 4));
  EXPECT_EQ(content(table), content(table, 6));
  EXPECT_EQ(store_->records().page(table.id, Role::owner, {{}, {}, 7, 10, 0}).error().field, "at");
  EXPECT_EQ(store_->tables().sequence_at(table.id, "9999-12-31T23:59:59.999Z").value(), 6);
  EXPECT_EQ(store_->tables().sequence_at(table.id, "0001-01-01T00:00:00.000Z").value(), 0);
  const auto history = store_->tables().history(table.id, Role::owner, {}, 10, 0).value();
  ASSERT_EQ(history.total, 6);
  EXPECT_EQ(history.rows[0].op, "undo");
  EXPECT_FALSE(history.rows[1].in_force);
  EXPECT_EQ(history.rows[5].changes.at(0).after.at("exists"), true);
  EXPECT_EQ(store_->tables().history(table.id, Role::owner, 2, 10, 0)->total, 1);
}

TEST_F(Tables, a_dropped_column_comes_back_with_its_values) {
  Column code = column("Code");
  code.unique = true;
  const Table table = make("Units", {code});
  ASSERT_TRUE(put(table, 1, {{"code", "A"}}));
  ASSERT_TRUE(store_->tables().drop_column(table.id, table.columns[0].id, {}, "ana"));
  EXPECT_EQ(now(table).columns.size(), 0u);
  EXPECT_EQ(store_->tables().drop_column(table.id, table.columns[0].id, {}, "ana").error().code,
            ErrorCode::not_found);
  ASSERT_TRUE(put(table, 2, {}, "ben"));
  // Another column can take the slug of a deleted column. Then undo cannot restore the deleted
  // column.
  ASSERT_TRUE(store_->tables().create_column(table.id, column("Code"), "ben"));
  EXPECT_EQ(undo(table).error().title, "Slug already used");
  ASSERT_TRUE(undo(table, "ben"));
  ASSERT_TRUE(undo(table));
  EXPECT_EQ(content(table), (json{{"1", {{"code", "A"}}}, {"2", json::object()}}));
  EXPECT_EQ(put(table, 2, {{"code", "A"}}).error().title, "Value is not unique");
}

TEST_F(Tables, retyping_keeps_what_can_be_kept_and_tells_what_cannot) {
  const Table table = make("Units", {column("Depth")});
  ASSERT_TRUE(put(table, 1, {{"depth", "1.5"}}));
  ASSERT_TRUE(put(table, 2, {{"depth", "deep"}}));
  ASSERT_TRUE(put(table, 3, {}));
  Column numeric = table.columns[0];
  numeric.kind = ColumnKind::numeric;
  numeric.unit = "m";
  const auto change = store_->tables().update_column(table.id, numeric, now(table).version, "ana");
  ASSERT_TRUE(change) << change.error().detail;
  EXPECT_EQ(change->record.at("converted"), 1);
  EXPECT_EQ(change->record.at("lost_keys"), json({2}));
  EXPECT_EQ(content(table),
            (json{{"1", {{"depth", 1.5}}}, {"2", json::object()}, {"3", json::object()}}));
  EXPECT_NE(now(table).columns[0].id, table.columns[0].id);
  EXPECT_EQ(store_->tables()
                .update_column(table.id, now(table).columns[0], table.version, "ana")
                .error()
                .code,
            ErrorCode::stale);
  ASSERT_TRUE(undo(table));
  EXPECT_EQ(content(table)["2"]["depth"], "deep");
  ASSERT_TRUE(undo(table, "ana", true));
  EXPECT_EQ(content(table)["1"]["depth"], 1.5);
}

TEST_F(Tables, column_properties_are_undone_one_by_one) {
  const Table table = make("Units", {column("Depth", ColumnKind::numeric)});
  Column depth = table.columns[0];
  depth.name = "Depth below surface";
  depth.unit = "cm";
  ASSERT_TRUE(store_->tables().update_column(table.id, depth, {}, "ana"));
  depth.unit = "m";
  ASSERT_TRUE(store_->tables().update_column(table.id, depth, {}, "ben"));
  ASSERT_TRUE(undo(table, "ana"));
  EXPECT_EQ(now(table).columns[0].name, "Depth");
  EXPECT_EQ(now(table).columns[0].unit, "m");
  ASSERT_TRUE(put(table, 1, {{"depth", 5}}));
  depth = now(table).columns[0];
  depth.maximum = 4;
  EXPECT_EQ(store_->tables().update_column(table.id, depth, {}, "ana").error().title,
            "Values do not match");
  depth.maximum = 6;
  ASSERT_TRUE(store_->tables().update_column(table.id, depth, {}, "ana"));
  EXPECT_EQ(put(table, 1, {{"depth", 7}}).error().field, "values.depth");
}

TEST_F(Tables, what_was_right_once_is_not_undone_into_what_is_wrong_now) {
  const Table table = make("Units", {column("Depth", ColumnKind::numeric)});
  ASSERT_TRUE(put(table, 1, {{"depth", 50}}));
  ASSERT_TRUE(put(table, 1, {{"depth", 5}}));
  Column depth = table.columns[0];
  depth.maximum = 10;
  ASSERT_TRUE(store_->tables().update_column(table.id, depth, {}, "ben"));
  EXPECT_EQ(undo(table).error().title, "Cannot undo");
  EXPECT_EQ(content(table)["1"]["depth"], 5.0);
  ASSERT_TRUE(undo(table, "ben"));
  ASSERT_TRUE(undo(table));
  EXPECT_EQ(content(table)["1"]["depth"], 50.0);
}

TEST_F(Tables, many_records_go_in_together_or_not_at_all) {
  const Table table = make("Units", {column("Depth", ColumnKind::integer)});
  const auto depth = table.columns[0].id;
  WriteRecords many;
  for (int i = 0; i < 5000; ++i) many.records.push_back({{}, {{depth, i}}});
  many.records[4000].values[depth] = "deep";
  auto change = store_->records().write(table.id, many, "ana").value();
  ASSERT_EQ(change.problems.size(), 1u);
  EXPECT_EQ(change.problems[0].index, 4000u);
  EXPECT_EQ(now(table).records, 0);
  many.records[4000].values[depth] = 4000;
  many.dry_run = true;
  change = store_->records().write(table.id, many, "ana").value();
  EXPECT_TRUE(change.problems.empty());
  EXPECT_EQ(change.created.size(), 5000u);
  EXPECT_EQ(now(table).records, 0);
  many.dry_run = false;
  ASSERT_TRUE(store_->records().write(table.id, many, "ana"));
  EXPECT_EQ(now(table).records, 5000);
  EXPECT_EQ(
      store_->records().missing(table.id, std::vector<std::int64_t>{1, 5000, 5001, 0}).value(),
      (std::vector<std::int64_t>{0, 5001}));
  ASSERT_TRUE(undo(table));
  EXPECT_EQ(now(table).records, 0);
  many.records = {{1, {}}, {1, {}}};
  EXPECT_EQ(store_->records().write(table.id, many, "ana")->problems.at(0).problem.title,
            "Key already used");
}

TEST_F(Tables, records_are_sorted_by_what_they_mean) {
  const Table table = make("Units", {column("Name"), column("Period", ColumnKind::period),
                                     column("Depth", ColumnKind::numeric)});
  ASSERT_TRUE(put(table, 1, {{"name", "beta"}, {"period", "1560"}, {"depth", 10}}));
  ASSERT_TRUE(put(table, 2, {{"name", "Alpha"}, {"period", "-0043"}, {"depth", 9}}));
  ASSERT_TRUE(put(table, 3, {{"name", "alpha"}, {"period", "Y-17000~"}}));
  // The order is the dictionary order (CLDR): first by letter, then lowercase before uppercase.
  EXPECT_EQ(keys(table, {{"name", false}, {"key", true}}), (std::vector<std::int64_t>{3, 2, 1}));
  EXPECT_EQ(keys(table, {{"period", false}}), (std::vector<std::int64_t>{3, 2, 1}));
  EXPECT_EQ(keys(table, {{"depth", false}}), (std::vector<std::int64_t>{2, 1, 3}));
  EXPECT_EQ(keys(table, {{"depth", true}}), (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(keys(table, {{"key", true}}), (std::vector<std::int64_t>{3, 2, 1}));
  EXPECT_EQ(store_->records()
                .page(table.id, Role::owner, {{{"none", false}}, {}, {}, 10, 0})
                .error()
                .field,
            "sortby");
  const auto page =
      store_->records().page(table.id, Role::owner, {{{"depth", false}}, {}, {}, 1, 1}).value();
  EXPECT_EQ(page.total, 3);
  EXPECT_EQ(page.records.at(0).key, 1);
  // Earlier content is sorted in the same way.
  ASSERT_TRUE(store_->records().remove(table.id, 1, {}, "ana"));
  const auto past =
      store_->records().page(table.id, Role::owner, {{{"name", false}}, {}, 3, 2, 1}).value();
  EXPECT_EQ(past.total, 3);
  EXPECT_EQ(past.records.at(0).key, 2);
  EXPECT_EQ(past.records.at(1).key, 1);
}

TEST_F(Tables, many_who_write_at_once_get_keys_and_sequences_of_their_own) {
  const Table table = make("Units", {column("Name")});
  std::vector<std::thread> people;
  for (int person = 0; person < 4; ++person)
    people.emplace_back([&, person] {
      for (int i = 0; i < 25; ++i) {
        auto done = put(table, {}, {{"name", "x"}}, "person " + std::to_string(person));
        EXPECT_TRUE(done) << done.error().detail;
      }
    });
  for (auto& person : people) person.join();
  EXPECT_EQ(now(table).records, 100);
  EXPECT_EQ(now(table).sequence, 100);
  EXPECT_EQ(keys(table, {}).back(), 100);
}

TEST_F(Tables, layers_of_several_models_share_a_table) {
  NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = "trench";
  fresh.geometry = {1};
  const auto model = store_->models().create(fresh, {}).value();
  Layer layer;
  layer.model_id = model.id;
  layer.name = "Units";
  layer.kind = LayerKind::database;
  const auto own = store_->layers().create(layer, {}, {column("Name")}).value();
  const Table table = store_->tables().find("units", Role::owner).value();
  EXPECT_EQ(own.table, table.id);
  EXPECT_EQ(table.columns.at(0).name, "Name");
  layer.table = table.id;
  layer.name = "Second";
  ASSERT_TRUE(store_->layers().create(layer));
  EXPECT_EQ(store_->layers().of_table(table.id, Role::owner)->size(), 2u);
  EXPECT_EQ(store_->tables().remove(table.id).error().title, "Table in use");
  Project project;
  project.name = project.slug = "elsewhere";
  auto moved = model;
  moved.project_id = store_->projects().create(project)->id;
  EXPECT_EQ(store_->models().update(moved).error().title, "Tables belong to project");
  layer.table = TableId(99);
  EXPECT_EQ(store_->layers().create(layer).error().field, "table");
  ASSERT_TRUE(store_->models().remove(model.id));
  ASSERT_TRUE(store_->tables().remove(table.id));
  Table elsewhere = make("Other", {});
  EXPECT_EQ(store_->projects().remove(moved.project_id).has_value(), true);
}

TEST(TablesMigration, database_layers_get_tables_with_the_keys_that_they_hold) {
  const auto dsn = test::empty_database();
  auto connection = std::move(PgConnection::connect(dsn).value());
  auto all = read_migrations(STRATA_MIGRATIONS_DIR).value();
  const std::vector<Migration> old(all.begin(), all.begin() + 7);
  ASSERT_TRUE(migrate(connection, old));
  const auto run = [&](const char* sql) {
    const auto done = connection.script(sql);
    ASSERT_TRUE(done) << done.error().detail;
  };
  run("INSERT INTO blobs VALUES (decode(repeat('00', 32), 'hex'), 0)");
  run("INSERT INTO models (project_id, name, slug, unit, unit_assumed, scale_verified, up, north, crs, origin, bounds_min, "
      "bounds_max, triangles, vertices, area, atlas, repairs, default_resolution, inventory_number, owner, creator, captured, "
      "method, accuracy, processing, rights_uri, credit, geometry) SELECT 1, 'm' || n, 'm' || n, 'm', false, false, 'z', '', '', "
      "'{0,0,0}', '{0,0,0}', '{1,1,1}', 1, 3, 1, '{}', '[]', 2048, '', '', '', '', '', '', '', '', '', "
      "decode(repeat('00', 32), 'hex') FROM generate_series(1, 2) n");
  run(R"(INSERT INTO layers (model_id, name, slug, kind, type, resolution, unit, description, palette, opacity, visible,
         draw_order, records_table)
         SELECT model, name, slug, kind, 'u8', 2048, '', '', jsonb_build_object('points', points::jsonb), 1, true, 0, named
         FROM (VALUES
           (1, 'units', 'units', 'database',
            '[{"at": 5, "label": "pit"}, {"at": 6}, {"at": 0.5, "label": "no key"}]', 'SU'),
           (2, 'again', 'again', 'database', '[{"at": 6, "label": "wall"}]', 'SU'),
           (2, '12', 'n-12', 'database', '[]', NULL),
           (2, 'wet', 'wet', 'numeric', '[]', NULL)) l (model, name, slug, kind, points, named))");
  run(R"(INSERT INTO edits (model_id, sequence, id, layer_id, stroke, user_name, op, record, answer, time)
         SELECT 1, 1, gen_random_uuid(), id, gen_random_uuid(), 'ana', 'stroke', '{"op": "stroke", "value": 9}', '{}', now()
         FROM layers WHERE slug = 'units')");
  ASSERT_TRUE(migrate(connection, all));
  auto store = test::open_store(dsn);
  const auto tables = store->tables().of_project(1, Role::owner).value();
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].name, "12");
  EXPECT_EQ(tables[0].slug, "n-12");
  EXPECT_EQ(tables[1].name, "SU");
  EXPECT_EQ(tables[1].slug, "su");
  EXPECT_EQ(tables[1].records, 3);
  EXPECT_EQ(store->layers().of_table(tables[1].id, Role::owner)->size(), 2u);
  const auto page = store->records().page(tables[1].id, Role::owner, {}).value();
  ASSERT_EQ(page.records.size(), 3u);
  EXPECT_EQ(to_json(page.records[0], page.table.columns),
            json({{"key", 5}, {"version", 0}, {"values", {{"name", "pit"}}}}));
  EXPECT_EQ(to_json(page.records[1], page.table.columns).at("values"), json({{"name", "wall"}}));
  EXPECT_EQ(page.records[2].key, 9);
  WriteRecords more;
  more.records = {{}};
  EXPECT_EQ(store->records().write(tables[1].id, more, "ana")->created,
            std::vector<std::int64_t>{10});
}

}  // namespace
}  // namespace strata::store
