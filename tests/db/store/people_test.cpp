#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "db/journal_painter.h"
#include "store/content/answers.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/members.h"
#include "store/people/password.h"
#include "store/people/tokens.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using std::chrono::seconds;

TEST(Tokens, a_token_is_found_until_it_is_revoked_or_expires) {
  auto store = test::fresh_store();
  EXPECT_EQ(store->tokens().create(TokenKind::script, "Ada", Role::owner, {}).error().code,
            ErrorCode::not_found);
  ASSERT_TRUE(store->accounts().create("Ada", "", Role::owner));
  const auto token =
      store->tokens().create(TokenKind::script, "Ada", Role::owner, {}).value().secret;
  EXPECT_EQ(token.size(), 43u);
  EXPECT_EQ(
      token.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
      std::string::npos);
  const auto found = store->tokens().find(token).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->user, "Ada");
  EXPECT_EQ(found->roles.everywhere, Role::owner);
  EXPECT_EQ(found->kind, TokenKind::script);
  ASSERT_TRUE(store->tokens().revoke(token));
  EXPECT_FALSE(store->tokens().find(token).value());
  const auto old =
      store->tokens().create(TokenKind::session, "Ada", Role::owner, seconds(-1)).value().secret;
  EXPECT_FALSE(store->tokens().find(old).value());
  const auto fresh =
      store->tokens().create(TokenKind::session, "Ada", Role::owner, seconds(3600)).value().secret;
  EXPECT_TRUE(store->tokens().find(fresh).value());
  EXPECT_NE(
      fresh,
      store->tokens().create(TokenKind::session, "Ada", Role::owner, seconds(3600)).value().secret);
}

TEST(Tokens, guesses_and_oddities_are_nobody) {
  auto store = test::fresh_store();
  for (const std::string guess : {"", "x", "' OR 1=1 --", "\xff\xff"})
    EXPECT_FALSE(store->tokens().find(guess).value()) << guess;
  for (const char* nobody : {"", "x", "\xff", "' OR 1=1 --"})
    EXPECT_EQ(store->tokens().create(TokenKind::script, nobody, Role::owner, {}).error().code,
              ErrorCode::not_found);
}

TEST(Tokens, secrets_are_not_in_the_database) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  ASSERT_TRUE(store->accounts().create("Ada", "", Role::owner));
  const auto token =
      store->tokens().create(TokenKind::script, "Ada", Role::owner, {}).value().secret;
  auto rows = PgConnection::connect(dsn)->query(
      "SELECT octet_length(hash)::bigint, position(convert_to($1, 'UTF8') in hash) "
      "FROM tokens",
      Params().text(token));
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->integer(0, 0), 32);
  EXPECT_EQ(rows->integer(0, 1), 0);
}

TEST(Tokens, an_owner_link_opens_sessions_until_it_is_revoked) {
  auto store = test::fresh_store();
  const auto link =
      store->tokens().create(TokenKind::owner_link, "owner", Role::owner, {}).value().secret;
  const auto first = store->tokens().redeem_owner_link(link, seconds(60)).value();
  const auto second = store->tokens().redeem_owner_link(link, seconds(60)).value();
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ(store->tokens().find(*first).value()->kind, TokenKind::session);
  EXPECT_EQ(store->tokens().find(*first).value()->roles.everywhere, Role::owner);
  EXPECT_FALSE(
      store->tokens().redeem_owner_link(*first, seconds(60)).value());  // a session is not a link
  EXPECT_FALSE(store->tokens().redeem_owner_link("guess", seconds(60)).value());
  ASSERT_TRUE(store->tokens().revoke(link));
  EXPECT_FALSE(store->tokens().redeem_owner_link(link, seconds(60)).value());
  EXPECT_TRUE(store->tokens().find(*first).value());
}

TEST(People, names_are_one_persons_in_any_case) {
  auto store = test::fresh_store();
  const Person ada = store->accounts().create("Ada", "Ada L.", Role::annotator).value();
  EXPECT_EQ(store->accounts().create("aDA", "", Role::viewer).error().code, ErrorCode::conflict);
  EXPECT_EQ(store->accounts().find("ADA").value().id, ada.id);
  EXPECT_EQ(store->accounts().find("nobody").error().code, ErrorCode::not_found);
  EXPECT_EQ(store->accounts().find("\xff").error().code, ErrorCode::not_found);
  EXPECT_EQ(store->accounts().password_of("ada").value(), "");
  ASSERT_TRUE(store->accounts().set_password("ada", "a hash", {}));
  EXPECT_EQ(store->accounts().password_of("ADA").value(), "a hash");
  EXPECT_TRUE(store->accounts().find("Ada").value().has_password);
  std::vector<std::string> names;
  const auto people = store->accounts().all().value();
  for (const Person& person : people) names.push_back(person.name);
  EXPECT_EQ(names, (std::vector<std::string>{"Ada", "owner"}));
}

TEST(People, names_for_signing_in_are_plain) {
  auto store = test::fresh_store();
  for (const std::string name :
       {"", "a b", "-a", "<b>", "ada/..", "äda", "\xe2\x84\xaairk", "\xff"})
    EXPECT_EQ(store->accounts().create(name, "", Role::viewer).error().code, ErrorCode::invalid)
        << name;
  EXPECT_EQ(store->accounts().create(std::string(65, 'x'), "", Role::viewer).error().code,
            ErrorCode::invalid);
  ASSERT_TRUE(store->accounts().create("kirk", "", Role::viewer));
  ASSERT_TRUE(store->accounts().set_password("kirk", "a hash", {}));
  EXPECT_EQ(store->accounts().password_of("\xe2\x84\xaairk").value(), "")
      << "the sign of Kelvin is a k in lower case";
  EXPECT_TRUE(store->accounts().create("a@b.c-d_9", "", Role::viewer));
}

TEST(People, a_session_is_opened_only_by_the_password_that_holds) {
  auto store = test::fresh_store();
  ASSERT_TRUE(store->accounts().create("Ada", "", Role::annotator));
  ASSERT_TRUE(store->accounts().set_password("Ada", "new", {}));
  const auto open = [&](const std::string& hash) {
    return store->tokens().create(TokenKind::session, "ada", Role::viewer, seconds(60), "", hash);
  };
  EXPECT_EQ(open("old").error().code, ErrorCode::unauthenticated);
  const auto first = open("new").value().secret;
  EXPECT_EQ(store->tokens().find(first).value()->roles.everywhere, Role::annotator);
  for (std::size_t i = 0; i < kMaxTokens; ++i) ASSERT_TRUE(open("new"));
  EXPECT_EQ(store->tokens().of_user("Ada", TokenKind::session)->size(), kMaxTokens);
  EXPECT_FALSE(store->tokens().find(first).value()) << "the oldest gives way";
}

TEST(People, of_links_only_the_newest_is_good_and_none_once_there_is_a_password) {
  auto store = test::fresh_store();
  const auto link = [&] {
    return store->tokens().create_link(TokenKind::owner_link, "owner", seconds(60)).value().secret;
  };
  const auto old = link(), now = link();
  EXPECT_FALSE(store->tokens().redeem_owner_link(old, seconds(60)).value());
  EXPECT_TRUE(store->tokens().redeem_owner_link(now, seconds(60)).value());
  ASSERT_TRUE(store->accounts().set_password("owner", "hash", {}));
  EXPECT_FALSE(store->tokens().redeem_owner_link(now, seconds(60)).value());
}

TEST(People, a_token_does_no_more_than_its_person_and_a_session_the_same) {
  auto store = test::fresh_store();
  const Person ada = store->accounts().create("Ada", "", Role::curator).value();
  const auto session =
      store->tokens().create(TokenKind::session, "Ada", Role::curator, seconds(60)).value().secret;
  const auto weak =
      store->tokens().create(TokenKind::script, "Ada", Role::viewer, {}).value().secret;
  const auto strong =
      store->tokens().create(TokenKind::script, "Ada", Role::owner, {}).value().secret;
  const auto role_of = [&](const std::string& secret) {
    return store->tokens().find(secret).value()->roles.everywhere;
  };
  EXPECT_EQ(role_of(session), Role::curator);
  EXPECT_EQ(role_of(weak), Role::viewer);
  EXPECT_EQ(role_of(strong), Role::curator);
  ASSERT_TRUE(store->accounts().update(ada.id, {{}, Role::administrator, {}}));
  EXPECT_EQ(role_of(session), Role::administrator);
  EXPECT_EQ(role_of(weak), Role::viewer);
  const auto invitation =
      store->tokens().create_link(TokenKind::invitation, "Ada", seconds(60)).value().secret;
  ASSERT_TRUE(store->accounts().update(ada.id, {{}, {}, true}));
  EXPECT_EQ(store->tokens().create(TokenKind::script, "Ada", Role::viewer, {}).error().code,
            ErrorCode::not_found);
  for (const auto& secret : {session, weak, strong})
    EXPECT_FALSE(store->tokens().find(secret).value());
  // Users may change their own account too. This does not revert an administrator's change.
  EXPECT_TRUE(store->accounts().update(ada.id, {"Ada L.", {}, {}}).value().disabled);
  ASSERT_TRUE(store->accounts().update(ada.id, {{}, {}, false}));
  for (const auto& ended : {session, invitation}) EXPECT_FALSE(store->tokens().find(ended).value());
  EXPECT_TRUE(store->tokens().find(weak).value());
}

TEST(People, an_invitation_is_good_for_one_of_many_who_use_it_at_once) {
  auto store = test::fresh_store();
  ASSERT_TRUE(store->accounts().create("Ada", "", Role::annotator));
  const auto invitation = store->tokens()
                              .create(TokenKind::invitation, "Ada", Role::annotator, seconds(60))
                              .value()
                              .secret;
  EXPECT_FALSE(store->tokens().redeem_owner_link(invitation, seconds(60)).value());
  std::atomic<int> in = 0;
  {
    std::vector<std::jthread> browsers;
    for (int i = 0; i < 8; ++i)
      browsers.emplace_back([&] {
        const auto session =
            store->accounts().accept_invitation(invitation, "hash", "Ada L.", seconds(60), "");
        if (session && *session) ++in;
      });
  }
  EXPECT_EQ(in, 1);
  EXPECT_EQ(store->accounts().find("Ada").value().full_name, "Ada L.");
  EXPECT_FALSE(store->accounts().accept_invitation("guess", "hash", {}, seconds(60), "").value());
}

TEST(People, in_a_project_somebody_may_do_more) {
  auto store = test::fresh_store();
  Project villa;
  villa.name = "Villa";
  const auto project = store->projects().create(villa).value().id;
  ASSERT_TRUE(store->accounts().create("Gus", "Gustav G.", Role::guest));
  const auto session =
      store->tokens().create(TokenKind::session, "Gus", Role::guest, seconds(60)).value().secret;
  const auto weak =
      store->tokens().create(TokenKind::script, "Gus", Role::viewer, {}).value().secret;
  const auto roles_of = [&](const std::string& secret) {
    return store->tokens().find(secret).value()->roles;
  };
  EXPECT_EQ(roles_of(session), Roles{});
  EXPECT_EQ(store->members().put(project, "gus", Role::annotator).value().person.full_name,
            "Gustav G.");
  ASSERT_TRUE(store->members().put(project, "Gus", Role::curator)) << "in place of the other";
  EXPECT_EQ(roles_of(session), (Roles{Role::guest, {{project, Role::curator}}}));
  EXPECT_EQ(roles_of(weak), (Roles{Role::guest, {{project, Role::viewer}}}));
  const auto members = store->members().of_project(project).value();
  ASSERT_EQ(members.size(), 1u);
  EXPECT_EQ(members[0].person.name, "Gus");
  EXPECT_EQ(members[0].role, Role::curator);
  for (const Role role : {Role::guest, Role::administrator, Role::owner})
    EXPECT_EQ(store->members().put(project, "Gus", role).error().code, ErrorCode::invalid);
  EXPECT_EQ(store->members().put(project, "nobody", Role::viewer).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store->members().put(ProjectId(project.number() + 1), "Gus", Role::viewer).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store->members().remove(ProjectId(project.number() + 1), "Gus").error().code,
            ErrorCode::not_found);
  ASSERT_TRUE(store->members().remove(project, "GUS"));
  EXPECT_EQ(store->members().remove(project, "Gus").error().code, ErrorCode::not_found);
  EXPECT_EQ(roles_of(session), Roles{});
  // Deleting the project, or the user, removes the role.
  ASSERT_TRUE(store->members().put(project, "Gus", Role::viewer));
  ASSERT_TRUE(store->projects().remove(project));
  EXPECT_EQ(roles_of(session), Roles{});
  const auto other = store->projects().create(villa).value().id;
  ASSERT_TRUE(store->members().put(other, "Gus", Role::viewer));
  ASSERT_TRUE(store->accounts().remove("Gus"));
  EXPECT_TRUE(store->members().of_project(other).value().empty());
}

TEST(Tokens, of_one_project_are_good_there_alone_and_go_with_it) {
  auto store = test::fresh_store();
  Project villa;
  villa.name = "Villa";
  const auto project = store->projects().create(villa).value().id;
  for (const auto& [name, role] :
       {std::pair("root", Role::administrator), {"Ada", Role::annotator}, {"Gus", Role::guest}})
    ASSERT_TRUE(store->accounts().create(name, "", role));
  const auto token_of = [&](const char* name, Role role) {
    return store->tokens().create(TokenKind::script, name, role, {}, "", {}, project);
  };
  const auto roles_of = [&](const std::string& secret) {
    return store->tokens().find(secret).value()->roles;
  };
  const auto roots = token_of("root", Role::curator).value().secret,
             adas = token_of("Ada", Role::curator).value().secret;
  const auto weak = token_of("root", Role::viewer).value().secret,
             of_guest = token_of("Gus", Role::viewer).value().secret;
  EXPECT_EQ(roles_of(roots), (Roles{Role::guest, {{project, Role::curator}}}));
  EXPECT_EQ(roles_of(adas), (Roles{Role::guest, {{project, Role::annotator}}}))
      << "no more than its person";
  EXPECT_EQ(roles_of(weak), (Roles{Role::guest, {{project, Role::viewer}}}));
  EXPECT_EQ(roles_of(of_guest), Roles{}) << "who has no role there gives none";
  ASSERT_TRUE(store->members().put(project, "Gus", Role::curator));
  EXPECT_EQ(roles_of(of_guest), (Roles{Role::guest, {{project, Role::viewer}}}));
  EXPECT_EQ(store->tokens().of_user("Ada", TokenKind::script)->at(0).project, "villa");
  for (const Role role : {Role::guest, Role::administrator, Role::owner})
    EXPECT_EQ(token_of("root", role).error().code, ErrorCode::invalid);
  EXPECT_EQ(store->tokens()
                .create(TokenKind::script, "Ada", Role::viewer, {}, "", {},
                        ProjectId(project.number() + 1))
                .error()
                .code,
            ErrorCode::not_found);
  const auto everywhere =
      store->tokens().create(TokenKind::script, "Ada", Role::viewer, {}).value().secret;
  ASSERT_TRUE(store->projects().remove(project));
  for (const auto& secret : {roots, adas, weak, of_guest})
    EXPECT_FALSE(store->tokens().find(secret).value());
  EXPECT_TRUE(store->tokens().find(everywhere).value());
}

TEST(People, of_who_is_deleted_no_name_is_left_outside_of_the_audit_log) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  const Person ada =
      store->accounts().create("Ada.Lovelace", "The Countess", Role::annotator).value();
  ASSERT_TRUE(store->tokens().create(TokenKind::script, "Ada.Lovelace", Role::annotator, {},
                                     "Countess's script"));
  Table finds;
  finds.project_id = 1;
  finds.name = "Finds";
  finds.columns.resize(1);
  finds.columns[0].name = "Code";
  finds = store->tables().create(finds).value();
  WriteRecords request;
  request.records = {{{}, {{finds.columns[0].id, "F 1"}}, {}}};
  ASSERT_TRUE(store->records().write(finds.id, request, "Ada.Lovelace"));
  const auto answer = [](const Project&) {
    return nlohmann::json{{"status", 201}, {"body", R"({"user":"Ada.Lovelace"})"}};
  };
  Project villa;
  villa.name = "Villa";
  ASSERT_TRUE(store->projects().create(villa, {"her key", answer}));
  const auto group = store->groups().create("Students", {"Ada.Lovelace"}).value().group.id;
  ASSERT_TRUE(store->groups().put(1, group, Role::viewer, "Ada.Lovelace"));
  ASSERT_TRUE(store->groups().change(group, {.remove = {"Ada.Lovelace"}}, "owner"));
  ASSERT_TRUE(store->groups().change(group, {.add = {"Ada.Lovelace"}}, "owner"));
  const Layer layer = test::make_layer(*store, test::make_model(*store).id);
  const test::Painter painter(layer, 1);
  JournalWriter writer(*store, {});
  ASSERT_TRUE(test::save(writer, painter.entry(1, "stroke", "Ada.Lovelace")));
  auto decision = painter.entry(2, "reject", "Ben");
  decision.record = {{"op", "reject"},
                     {"user", "Ada.Lovelace"},
                     {"reason", "@ada.lovelace: too far, b@ada.lovelacex.org"}};
  decision.reviewed = {{1}, Review::rejected};
  decision.disable = {1};
  ASSERT_TRUE(test::save(writer, decision));
  ASSERT_TRUE(store->accounts().remove("ada.lovelace"));
  const std::string former = "former-" + to_string(ada.id);
  const auto edits = store->journal().history(layer.id, 10, 0)->rows;
  EXPECT_EQ(edits.at(1).user, former);
  EXPECT_EQ(edits[1].reviewer->reason, "@" + former + ": too far, b@ada.lovelacex.org");
  decision.record["user"] = former;
  decision.record["reason"] = edits[1].reviewer->reason;
  EXPECT_EQ(edits[0].record, decision.record) << "the rest of it is as it was";
  auto connection = PgConnection::connect(dsn);
  // Covers every table and column, including future ones. The audit log keeps the names.
  auto tables = connection->query(
      "SELECT format('%I.%I', schemaname, tablename) FROM pg_tables WHERE schemaname = 'public' "
      "AND tablename <> 'audit_log'");
  ASSERT_TRUE(tables);
  for (int i = 0; i < tables->rows(); ++i) {
    auto found = connection->query_once("SELECT count(*) FROM " + tables->text(i, 0) +
                                        " t WHERE t::text ~* 'lovelace(?!x)|countess'");
    ASSERT_TRUE(found) << found.error().detail;
    EXPECT_EQ(found->integer(0, 0), 0) << tables->text(i, 0);
  }
  const auto history = connection->query("SELECT count(*) FROM table_edits WHERE user_name = $1",
                                         Params().text(former));
  EXPECT_EQ(history->integer(0, 0), 1);
  for (const char* taken : {"former-7", "Former-8"})
    EXPECT_EQ(store->accounts().create(taken, "", Role::viewer).error().code, ErrorCode::conflict);
  EXPECT_TRUE(store->accounts().create("Ada.Lovelace", "", Role::viewer));
}

TEST(Passwords, fit_only_their_own_hash) {
  const std::string hash = hash_password("seven blue herons").value();
  EXPECT_TRUE(hash.starts_with("$argon2id$")) << hash;
  EXPECT_NE(hash, hash_password("seven blue herons").value());
  EXPECT_TRUE(password_fits(hash, "seven blue herons").value());
  for (const char* guess : {"", "seven blue heron", "Seven blue herons", "seven blue herons "})
    EXPECT_FALSE(password_fits(hash, guess).value()) << guess;
  for (const char* broken :
       {"", "x", "$argon2id$v=19$m=65536,t=2,p=1$", "a password that nobody has"})
    EXPECT_FALSE(password_fits(broken, "a password that nobody has").value()) << broken;
}

IdempotentResponse<Project> answer_of(const std::string& key) {
  return {key, [](const Project& made) {
            return nlohmann::json{{"status", 201}, {"id", made.id}, {"area", 0.1}};
          }};
}

Project named(const std::string& name) {
  Project project;
  project.name = name;
  return project;
}

TEST(Answers, an_answer_is_kept_with_the_change_for_seven_days) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  EXPECT_FALSE(store->answers().find("k").value());
  const auto made = store->projects().create(named("Villa"), answer_of("k")).value();
  const nlohmann::json first = {{"status", 201}, {"id", made.id}, {"area", 0.1}};
  EXPECT_EQ(store->answers().find("k").value(), first);
  auto connection = PgConnection::connect(dsn);
  ASSERT_TRUE(connection->script("UPDATE answers SET time = time - interval '6 days 23 hours'"));
  EXPECT_EQ(store->answers().find("k").value(), first);
  ASSERT_TRUE(connection->script("UPDATE answers SET time = time - interval '2 hours'"));
  EXPECT_FALSE(store->answers().find("k").value());
  const auto again = store->projects().create(named("Villa"), answer_of("k")).value();
  EXPECT_EQ(store->answers().find("k").value()->at("id"), again.id.number());
}

TEST(Answers, of_two_calls_with_one_key_only_one_changes_anything) {
  auto store = test::fresh_store();
  ASSERT_TRUE(store->projects().create(named("Villa"), answer_of("k")));
  const auto second = store->projects().create(named("Villa"), answer_of("k"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::conflict);
  EXPECT_EQ(store->projects().all()->size(), 2u) << "`default` and the first";
}

TEST(Answers, what_changes_nothing_keeps_no_answer) {
  auto store = test::fresh_store();
  EXPECT_FALSE(store->projects().create(named(""), answer_of("k")));
  EXPECT_FALSE(store->projects().remove(1, {"gone", [] {
                                              return nlohmann::json{{"status", 204}};
                                            }}));
  EXPECT_FALSE(store->answers().find("k").value());
  EXPECT_FALSE(store->answers().find("gone").value());
}

TEST(Answers, bad_keys_are_the_callers_mistake) {
  auto store = test::fresh_store();
  EXPECT_EQ(store->answers().find("").error().code, ErrorCode::malformed);
  for (const std::string& key :
       {std::string(256, 'k'), std::string("a\0b", 3), std::string("\xff")}) {
    EXPECT_EQ(store->answers().find(key).error().code, ErrorCode::malformed);
    EXPECT_EQ(store->projects().create(named("x"), answer_of(key)).error().code,
              ErrorCode::malformed);
  }
  EXPECT_EQ(store->projects().all()->size(), 1u);
}

}  // namespace
}  // namespace strata::store
