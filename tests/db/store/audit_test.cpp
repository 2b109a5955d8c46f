#include "store/people/audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "db/journal_painter.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/content/trash.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/kiosks.h"
#include "store/people/members.h"
#include "store/people/tokens.h"
#include "store/pg/acting.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class AuditLog : public ::testing::Test {
 protected:
  AuditLog() {
    ada_ = store_->accounts().create("ada", "Ada Lovelace", Role::annotator).value();
    last_seen_ = newest();
  }
  std::int64_t newest() {
    const auto rows = store_->audit().rows({.limit = 1}).value();
    return rows.empty() ? 0 : rows.front().id;
  }
  // Returns the rows since the last call as "kind:actor action subject_kind subject", oldest first.
  std::vector<std::string> fresh() {
    std::vector<std::string> lines;
    const auto rows = store_->audit().rows({.limit = 1000}).value();
    for (const AuditRow& row : rows)
      if (row.id > last_seen_)
        lines.insert(lines.begin(), row.actor_kind + ":" + row.actor + " " + row.action + " " +
                                        row.subject_kind + " " + row.subject);
    last_seen_ = newest();
    return lines;
  }
  AuditRow last() {
    const auto rows = store_->audit().rows({.limit = 1}).value();
    return rows.front();
  }
  static Actor owner() { return {"person", "owner", "192.0.2.7", {}}; }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  Person ada_;
  std::int64_t last_seen_ = 0;
};

TEST_F(AuditLog, changes_of_accounts_and_roles_name_who_made_them_and_from_where) {
  const ActingAs acting(owner());
  const Person bob = store_->accounts().create("bob", "Bob", Role::viewer).value();
  ASSERT_TRUE(
      store_->accounts().update(bob.id, {.full_name = {}, .role = Role::curator, .disabled = {}}));
  const AuditRow changed = last();
  EXPECT_EQ(changed.details, nlohmann::json({{"before", "viewer"}, {"after", "curator"}}));
  EXPECT_EQ(changed.address, "192.0.2.7");
  EXPECT_EQ(changed.person, PersonId(1));
  EXPECT_EQ(changed.subject_id, bob.id.number());
  ASSERT_TRUE(
      store_->accounts().update(bob.id, {.full_name = "Robert", .role = {}, .disabled = true}));
  ASSERT_TRUE(store_->members().put(1, "bob", Role::viewer, "owner"));
  ASSERT_TRUE(store_->members().put(1, "bob", Role::viewer, "owner"));  // changes nothing
  ASSERT_TRUE(store_->members().put(1, "bob", Role::annotator, "owner"));
  EXPECT_EQ(last().project, ProjectId(1));
  ASSERT_TRUE(store_->members().remove(1, "bob", "owner"));
  ASSERT_TRUE(store_->accounts().remove("bob"));
  EXPECT_THAT(
      fresh(),
      ElementsAre("person:owner account_created person bob", "person:owner role_changed person bob",
                  "person:owner account_disabled person bob",
                  "person:owner account_renamed person bob", "person:owner member_added person bob",
                  "person:owner role_changed person bob", "person:owner member_removed person bob",
                  "person:owner account_deleted person bob"));
}

TEST_F(AuditLog, roles_of_groups_have_rows) {
  const ActingAs acting(owner());
  const Group group = store_->groups().create("Staff", {"ada"}).value().group;
  ASSERT_TRUE(store_->groups().put(1, group.id, Role::curator, "owner"));
  ASSERT_TRUE(store_->groups().remove(group.id, "owner"));
  EXPECT_THAT(
      fresh(),
      ElementsAre("person:owner group_created group Staff", "person:owner member_added person ada",
                  "person:owner member_added group Staff",
                  "person:owner member_removed group Staff", "person:owner deletion group Staff"));
}

TEST_F(AuditLog, a_sign_in_names_its_person_and_its_way) {
  std::string session;
  {
    const ActingAs acting({{}, {}, "192.0.2.8", "password"});
    session = store_->tokens()
                  .create(TokenKind::session, "ada", Role::viewer, std::chrono::hours(1))
                  .value()
                  .secret;
  }
  EXPECT_EQ(last().details, nlohmann::json({{"method", "password"}}));
  EXPECT_EQ(last().person, ada_.id);
  {
    const ActingAs acting({"person", "ada", "192.0.2.8", {}});
    ASSERT_TRUE(store_->tokens().revoke(session));
    const NewToken token =
        store_->tokens()
            .create(TokenKind::script, "ada", Role::viewer, std::chrono::hours(1), "nightly copy")
            .value();
    EXPECT_EQ(last().details.value("role", ""), "viewer");
    // The log must not contain the secret in any column.
    const auto whole = connection_->query("SELECT string_agg(l::text, ' ') FROM audit_log l");
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->text(0, 0).find(token.secret), std::string::npos);
    EXPECT_EQ(whole->text(0, 0).find(session), std::string::npos);
    ASSERT_TRUE(store_->tokens().revoke("ada", TokenKind::script, token.token.id));
  }
  ASSERT_TRUE(store_->tokens().create_link(TokenKind::owner_link, "owner", std::chrono::hours(1)));
  EXPECT_THAT(fresh(),
              ElementsAre("person:ada sign_in session ada", "person:ada sign_out session ada",
                          "person:ada token_created token nightly copy",
                          "person:ada token_revoked token nightly copy",
                          "server: link_created person owner"));
}

TEST_F(AuditLog, many_failed_sign_ins_are_counted_in_one_row) {
  const auto fail_as = [&](const std::string& address, const std::string& name) {
    const ActingAs acting({{}, {}, address, "password"});
    ASSERT_TRUE(store_->audit().failed_sign_in(name, "password"));
  };
  for (int i = 0; i < 7; ++i) fail_as("192.0.2.9", "ada");
  fail_as("192.0.2.10", "ada");
  std::int64_t of_ada = 0;
  const auto failed = store_->audit().rows({.action = "sign_in_failed"}).value();
  for (const AuditRow& row : failed) {
    EXPECT_EQ(row.person, ada_.id);
    of_ada += row.count;
  }
  EXPECT_EQ(of_ada, 8);
  // The minute may change during the test, and then each name has two rows.
  EXPECT_LE(store_->audit().rows({.action = "sign_in_failed"})->size(), 4u);
  for (int i = 0; i < 100; ++i) fail_as("192.0.2.11", "guess " + std::to_string(i));
  EXPECT_LE(store_->audit().rows({.action = "sign_in_failed", .limit = 1000})->size(),
            4u + 2u * 21u);
  fail_as("192.0.2.12", std::string(2000, 'x'));
  EXPECT_EQ(last().actor.size(), 255u);
  fail_as("192.0.2.13", std::string("a\0\xff", 3));
  EXPECT_EQ(last().address, "192.0.2.13");
}

TEST_F(AuditLog, deletions_and_the_trash_have_rows) {
  const Model model = test::make_model(*store_);
  const Layer layer = test::make_layer(*store_, model.id);
  fresh();
  const ActingAs acting(owner());
  const auto in_trash = [&] {
    return store_->trash()
        .entry(1, TrashEntry::Kind::layer, layer.id.number(), 0,
               {Role::owner, std::chrono::days(30)})
        .value();
  };
  const IdempotentResponse<> by{.key = {}, .make = {}, .user = "owner"};
  ASSERT_TRUE(store_->trash().put_layer(layer.id, by));
  ASSERT_TRUE(store_->trash().restore(in_trash(), {.key = {}, .make = {}, .user = "owner"}));
  ASSERT_TRUE(store_->trash().put_layer(layer.id, by));
  ASSERT_TRUE(store_->trash().erase(in_trash(), by));
  while (store_->trash().erase_some().value()) {
  }
  EXPECT_THAT(fresh(),
              ElementsAre("person:owner deletion layer layer", "person:owner restored layer layer",
                          "person:owner deletion layer layer", "person:owner erased layer layer"));
}

TEST_F(AuditLog, deleted_records_are_counted_in_one_row) {
  Table table;
  table.project_id = 1;
  table.name = "Finds";
  const Table made = store_->tables().create(table, {.key = {}, .make = {}, .user = "ada"}).value();
  WriteRecords request;
  request.records.resize(1);
  ASSERT_TRUE(store_->records().write(made.id, request, "ada"));
  EXPECT_THAT(fresh(), IsEmpty());
  ASSERT_TRUE(store_->records().remove(made.id, 1, std::nullopt, "ada", false, {}));
  EXPECT_THAT(fresh(), ElementsAre("person:ada deletion record Finds"));
}

TEST_F(AuditLog, kiosks_have_rows) {
  const Model model = test::make_model(*store_);
  NamedPart tour;
  tour.model_id = model.id;
  tour.name = "Once around";
  tour.content = {{"languages", {"en"}}, {"idle_s", 60}, {"stops", nlohmann::json::array()}};
  tour.user = "carl";
  const NamedPart made = store_->tours().create(tour).value();
  fresh();
  const ActingAs acting(owner());
  const Kiosk kiosk = store_->kiosks().create(made.id, "Hall", "owner", {}).value().kiosk;
  ASSERT_TRUE(store_->kiosks().seen(kiosk.id, true));
  ASSERT_TRUE(store_->kiosks().allow_phones(kiosk.id, true));
  ASSERT_TRUE(store_->kiosks().revoke(kiosk.id));
  EXPECT_THAT(fresh(), ElementsAre("person:owner kiosk_created kiosk Hall",
                                   "person:owner kiosk_changed kiosk Hall",
                                   "person:owner kiosk_deleted kiosk Hall"));
}

TEST_F(AuditLog, rows_are_not_changed_or_deleted) {
  constexpr const char* kWithLimit =
      "BEGIN; SELECT set_config('strata.audit_limit', '9999-01-01', true); DELETE FROM audit_log; COMMIT";
  for (const char* statement :
       {"UPDATE audit_log SET actor = 'nobody'", "UPDATE audit_log SET count = count + 1",
        "DELETE FROM audit_log", "TRUNCATE audit_log", kWithLimit}) {
    const auto done = connection_->script(statement);
    EXPECT_FALSE(done) << statement;
    (void)connection_->script("ROLLBACK");
  }
  EXPECT_GE(newest(), 1);
}

TEST_F(AuditLog, retention_deletes_only_old_rows_and_writes_a_row) {
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(store_->audit().failed_sign_in("bob", "link"));
  EXPECT_EQ(store_->audit().purge_some(std::chrono::days(1)), false);
  EXPECT_THAT(fresh(), ElementsAre("link:bob sign_in_failed session "));
  ASSERT_TRUE(connection_->script(
      "ALTER TABLE audit_log DISABLE TRIGGER USER; UPDATE audit_log SET time = time - interval '9 "
      "days' WHERE action = 'sign_in_failed'; ALTER TABLE audit_log ENABLE TRIGGER USER"));
  EXPECT_EQ(store_->audit().purge_some(std::chrono::days(10)), false);
  EXPECT_THAT(fresh(), IsEmpty());
  EXPECT_EQ(store_->audit().purge_some(std::chrono::days(8)), false);
  EXPECT_THAT(fresh(), ElementsAre("server: audit_purged audit "));
  EXPECT_EQ(last().details.value("rows", 0), 1);
  EXPECT_EQ(store_->audit().rows({.action = "sign_in_failed"})->size(), 0u);
  EXPECT_FALSE(store_->audit().purge_some(std::chrono::days(0)));
}

TEST_F(AuditLog, filters_and_pages_select_rows) {
  {
    const ActingAs acting({"token", "ada", "192.0.2.7", {}});
    ASSERT_TRUE(
        store_->audit().exported({"layer", 7, "cracks.tif", ProjectId(1), {{"path", "/x"}}}));
    ASSERT_TRUE(store_->audit().exported({"table", {}, "finds.csv", {}}));
  }
  EXPECT_EQ(store_->audit().rows({.actor = "ADA"})->size(), 2u);
  EXPECT_EQ(store_->audit().rows({.actor = std::string("a\0", 2)})->size(), 0u);
  EXPECT_EQ(store_->audit().rows({.action = "export", .subject_kind = "layer"})->size(), 1u);
  const auto of_project = store_->audit().rows({.project = ProjectId(1)}).value();
  ASSERT_EQ(of_project.size(), 1u);
  EXPECT_EQ(of_project.front().project_slug, "default");
  EXPECT_EQ(of_project.front().subject_id, 7);
  EXPECT_EQ(store_->audit().rows({.action = "export", .before = of_project.front().id})->size(),
            0u);
  EXPECT_EQ(store_->audit().rows({.from = "2999-01-01T00:00:00Z"})->size(), 0u);
  EXPECT_EQ(store_->audit().rows({.to = "2001-01-01T00:00:00Z"})->size(), 0u);
  EXPECT_EQ(
      store_->audit().rows({.from = "2001-01-01T00:00:00Z", .to = "2999-01-01T00:00:00Z"})->size(),
      3u);
}

TEST_F(AuditLog, the_list_of_actions_is_that_of_the_database) {
  const auto known = connection_->query(
      "SELECT pg_get_constraintdef(oid) FROM pg_constraint WHERE conname = 'audit_log_action_check'");
  ASSERT_TRUE(known);
  std::size_t quotes = 0;
  for (const char c : known->text(0, 0)) quotes += c == '\'';
  EXPECT_EQ(quotes, 2 * kAuditActions.size());
  for (const std::string_view action : kAuditActions)
    EXPECT_THAT(known->text(0, 0), HasSubstr("'" + std::string(action) + "'"));
}

}  // namespace
}  // namespace strata::store
