#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "domain/tables/term_list.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"
#include "vocabulary/terms_csv.h"
#include "vocabulary/terms_skos.h"

namespace strata::store {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Terms : public ::testing::Test {
 protected:
  Table make(const std::string& csv, const std::string& name = "Stone") {
    auto list = read_terms_csv(csv);
    EXPECT_TRUE(list) << list.error().detail;
    auto made = create(*list, name);
    EXPECT_TRUE(made) << made.error().detail;
    EXPECT_TRUE(!made || made->problems.empty()) << made->problems.front().problem.detail;
    return made ? made->table : Table{};
  }
  Result<TableChange> create(const TermList& list, const std::string& name = "Stone") {
    std::vector<std::string> languages;
    for (const std::string& slug : list.columns)
      if (const auto language = label_language(slug)) languages.push_back(*language);
    NewTable new_table;
    new_table.table.project_id = 1;
    new_table.table.name = name;
    new_table.table.columns = new_term_columns(languages);
    new_table.terms = list;
    auto made = store_->tables().create_several({new_table}, false, "ana", "import");
    if (!made) return tl::unexpected(made.error());
    return made->front();
  }
  Result<TableChange> import(const Table& table, const std::string& csv, bool dry_run = false) {
    auto list = read_terms_csv(csv);
    EXPECT_TRUE(list) << list.error().detail;
    EXPECT_TRUE(list->mistakes.empty());
    return store_->tables().import_terms(table.id, *list, dry_run, "ana");
  }
  // Returns {code, key, parent's code, label} in the order of the tree.
  std::vector<std::string> content(const Table& table) {
    RecordQuery all;
    all.limit = 1000;
    auto page = store_->records().page(table.id, Role::owner, all);
    EXPECT_TRUE(page);
    std::vector<std::string> out;
    for (const ListedTerm& listed : list_terms(*term_columns(page->table), page->records))
      out.push_back(std::to_string(listed.key) + " " + listed.term.parent + "/" + listed.term.code +
                    " " + label_in(listed.term, "es"));
    return out;
  }
  Result<TableChange> undo(const Table& table) {
    auto plan = store_->tables().plan_undo(table.id, "ana", false);
    if (!plan) return tl::unexpected(plan.error());
    return store_->tables().undo(table.id, "ana", false, plan->table_sequence);
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
};

TEST_F(Terms, a_list_is_a_table_with_its_terms_as_one_entry) {
  const Table table =
      make("code,parent,label,label-es\nworn,loss,Worn,Desgaste\nloss,,Loss,Pérdida\n");
  EXPECT_TRUE(term_columns(table));
  EXPECT_EQ(table.sequence, 1);
  EXPECT_THAT(content(table), ElementsAre("2 /loss Pérdida", "1 loss/worn Desgaste"));
  EXPECT_TRUE(undo(table));
  EXPECT_THAT(content(table), ElementsAre());
}

TEST_F(Terms, an_import_keeps_the_keys_and_what_the_text_does_not_have) {
  const Table table =
      make("code,parent,label,uri,color\na,,A,https://t.example/a,#112233\nb,a,B,,\n");
  auto change = import(
      table, "code,label,uri,label-de\nb,Bee,,Biene\nalpha,Alpha,https://t.example/a,\nc,C,,\n");
  ASSERT_TRUE(change) << change.error().detail;
  ASSERT_TRUE(change->problems.empty()) << change->problems.front().problem.detail;
  EXPECT_THAT(change->changed, ElementsAre(1, 2));
  EXPECT_THAT(change->created, ElementsAre(3));
  EXPECT_TRUE(change->columns_changed);
  EXPECT_THAT(content(table), ElementsAre("1 /alpha Alpha", "2 alpha/b Bee", "3 /c C"));
  auto record = store_->records().page(table.id, Role::owner, {});
  ASSERT_TRUE(record);
  EXPECT_EQ(record->records[0].values.at(term_columns(record->table)->color->id), "#112233");
  ASSERT_TRUE(undo(table));
  EXPECT_THAT(content(table), ElementsAre("1 /a A", "2 a/b B"));
  EXPECT_FALSE(
      term_columns(*store_->tables().find(table.slug, Role::owner))->labels.contains("de"));
}

TEST_F(Terms, the_same_again_is_no_entry) {
  const std::string csv = "code,parent,label\na,,A\nb,a,B\n";
  const Table table = make(csv);
  auto change = import(table, csv);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->sequence, 0);
  EXPECT_TRUE(change->created.empty() && change->changed.empty());
}

TEST_F(Terms, two_terms_may_swap_their_codes_by_their_uris) {
  const Table table = make("code,uri\na,https://t.example/1\nb,https://t.example/2\n");
  auto change = import(table, "code,uri\nb,https://t.example/1\na,https://t.example/2\n");
  ASSERT_TRUE(change && change->problems.empty());
  EXPECT_THAT(content(table), ElementsAre("1 /b b", "2 /a a"));
}

TEST_F(Terms, circles_and_unknown_parents_are_told_and_nothing_is_written) {
  const Table table = make("code,parent\na,\nb,a\nc,b\n");
  auto circle = import(table, "code,parent\na,c\n");
  ASSERT_TRUE(circle);
  ASSERT_EQ(circle->problems.size(), 1u);
  EXPECT_EQ(circle->problems[0].index, 0u);
  EXPECT_THAT(circle->problems[0].problem.detail, HasSubstr("\"a\" is below \"c\""));
  auto stranger = import(table, "code,parent\nd,a\ne,x\nf,f\n");
  ASSERT_TRUE(stranger);
  ASSERT_EQ(stranger->problems.size(), 2u);
  EXPECT_EQ(stranger->problems[0].index, 1u);
  EXPECT_EQ(stranger->problems[0].problem.title, "Parent not found");
  EXPECT_EQ(stranger->problems[1].problem.title, "Circular hierarchy of terms");
  EXPECT_EQ(content(table).size(), 3u);
  EXPECT_EQ(store_->tables().find(table.slug, Role::owner)->sequence, 1);
}

TEST_F(Terms, one_term_named_by_its_uri_and_by_its_code_is_refused) {
  const Table table = make("code,uri\na,https://t.example/1\n");
  auto change = import(table, "code,uri\na,\nb,https://t.example/1\n");
  ASSERT_TRUE(change);
  ASSERT_FALSE(change->problems.empty());
  EXPECT_EQ(change->problems[0].problem.title, "Duplicate term");
  auto twice = import(table, "code,uri\nx,https://t.example/2\ny,https://t.example/2\n");
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->problems.at(0).problem.title, "Duplicate URI");
}

TEST_F(Terms, values_that_no_column_takes_are_told_with_their_term) {
  const Table table = make("code,uri\na,\n");
  auto change = import(
      table, "code,uri,definition\nb,javascript:alert(1),\nc,," + std::string(100'001, 'x') + "\n");
  ASSERT_TRUE(change);
  ASSERT_EQ(change->problems.size(), 2u);
  EXPECT_EQ(change->problems[0].problem.field, "uri");
  EXPECT_EQ(change->problems[1].index, 1u);
}

TEST_F(Terms, a_dry_run_tells_and_keeps_nothing) {
  const Table table = make("code,label\na,A\n");
  auto change = import(table, "code,label,label-de\na,Ah,\nb,B,\n", true);
  ASSERT_TRUE(change);
  EXPECT_THAT(change->created, ElementsAre(2));
  EXPECT_THAT(content(table), ElementsAre("1 /a A"));
  EXPECT_FALSE(
      term_columns(*store_->tables().find(table.slug, Role::owner))->labels.contains("de"));
}

TEST_F(Terms, only_a_list_takes_terms_and_names_are_not_given_twice) {
  Table plain;
  plain.project_id = 1;
  plain.name = "Units";
  auto made = store_->tables().create(plain);
  ASSERT_TRUE(made);
  EXPECT_EQ(import(*made, "code\na\n").error().title, "Not a term list");
  EXPECT_EQ(create(*read_terms_csv("code\na\n"), "UNITS").error().code, ErrorCode::conflict);
  EXPECT_EQ(store_->tables().of_project(1, Role::owner)->size(), 1u);
}

TEST_F(Terms, tables_come_all_or_none_and_name_each_other) {
  NewTable terms, units;
  terms.table.project_id = units.table.project_id = 1;
  terms.table.name = "Kinds";
  terms.table.columns = new_term_columns({});
  terms.terms = *read_terms_csv("code,parent\npit,cut\ncut,\n");
  units.table.name = "Units";
  Column kind, above;
  kind.name = "Kind";
  kind.kind = ColumnKind::term;
  kind.target = TableId(1);  // replaced by the previous table of the request
  above.name = "Above";
  above.kind = ColumnKind::relation;
  above.target = kOwnTable;
  units.table.columns = {kind, above};
  units.targets = {{0, 0}};
  auto made = store_->tables().create_several({terms, units}, false, "ana", "template");
  ASSERT_TRUE(made) << made.error().detail;
  ASSERT_EQ(made->size(), 2u);
  EXPECT_EQ((*made)[1].table.columns[0].target, (*made)[0].table.id);
  EXPECT_EQ((*made)[1].table.columns[1].target, (*made)[1].table.id);
  EXPECT_EQ((*made)[0].created.size(), 2u);

  terms.table.name = "Other kinds";
  EXPECT_EQ(store_->tables().create_several({terms, units}, false, "ana", "template").error().code,
            ErrorCode::conflict);
  terms.terms = *read_terms_csv("code,parent\npit,nothing\n");
  units.table.name = "Other units";
  auto refused = store_->tables().create_several({terms, units}, false, "ana", "template");
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->front().problems.empty());
  EXPECT_EQ(store_->tables().of_project(1, Role::owner)->size(), 2u);
}

}  // namespace
}  // namespace strata::store
