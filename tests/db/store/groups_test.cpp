#include "store/people/groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/members.h"
#include "store/people/tokens.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using Names = std::vector<std::string>;

ProjectId project(Store& store, const std::string& name) {
  Project made;
  made.name = name;
  return store.projects().create(made).value().id;
}

std::string session_of(Store& store, const std::string& user, Role role) {
  EXPECT_TRUE(store.accounts().create(user, "", role));
  return store.tokens()
      .create(TokenKind::session, user, role, std::chrono::seconds(60))
      .value()
      .secret;
}

Roles roles_of(Store& store, const std::string& secret) {
  return store.tokens().find(secret).value()->roles;
}

Names names_of(const std::vector<GroupDetail::Member>& members) {
  Names names;
  for (const auto& member : members) names.push_back(member.user);
  return names;
}

TEST(Groups, are_told_apart_by_their_names_in_any_case) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  const auto students = groups.create("Ärzte 2026", {}).value().group;
  EXPECT_EQ(groups.create("äRZTE 2026", {}).error().code, ErrorCode::conflict);
  for (const std::string& name :
       {std::string(), std::string(" x"), std::string("x "), std::string(101, 'x'),
        std::string("\xff"), std::string("a\0b", 3), std::string("x\n")}) {
    EXPECT_GE(groups.create(name, {}).error().code, ErrorCode::malformed) << name;
    EXPECT_LT(groups.create(name, {}).error().code, ErrorCode::internal) << name;
  }
  std::string hundred;
  for (int i = 0; i < 100; ++i) hundred += "ü";
  const auto longest = groups.create(hundred, {}).value().group;
  ASSERT_TRUE(groups.change(students.id, {"Ärzte 2027"}, {}));
  ASSERT_TRUE(groups.change(students.id, {"ärzte 2027"}, {})) << "its own name, spelled otherwise";
  EXPECT_EQ(groups.change(longest.id, {"ÄRZTE 2027"}, {}).error().code, ErrorCode::conflict);
  const auto all = groups.all().value();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "ärzte 2027");
  EXPECT_EQ(groups.group(GroupId(longest.id.number() + 1)).error().code, ErrorCode::not_found);
  EXPECT_EQ(groups.change(GroupId(longest.id.number() + 1), {"x"}, {}).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(groups.remove(GroupId(longest.id.number() + 1), {}).error().code, ErrorCode::not_found);
}

TEST(Groups, the_database_itself_refuses_what_is_no_group) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  ASSERT_TRUE(store->groups().create("Students", {}));
  for (const char* sql :
       {"INSERT INTO groups (name) VALUES ('')", "INSERT INTO groups (name) VALUES (' x')",
        "INSERT INTO groups (name) VALUES (repeat('x', 101))",
        "INSERT INTO groups (name) VALUES ('sTUDENTS')",
        "INSERT INTO project_groups SELECT 1, id, 'guest' FROM groups",
        "INSERT INTO project_groups SELECT 1, id, 'administrator' FROM groups"})
    EXPECT_FALSE(PgConnection::connect(dsn)->script(sql)) << sql;
}

TEST(Groups, the_highest_of_ones_own_role_and_those_of_ones_groups_counts) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  const auto villa = project(*store, "Villa"), forum = project(*store, "Forum");
  const auto gus = session_of(*store, "Gus", Role::guest);
  const auto weak =
      store->tokens().create(TokenKind::script, "Gus", Role::viewer, {}).value().secret;
  const auto students = groups.create("Students", {"gus"}).value().group.id;
  const auto diggers = groups.create("Diggers", {"Gus"}).value().group.id;
  EXPECT_EQ(roles_of(*store, gus), Roles{}) << "a group gives nothing of itself";
  ASSERT_TRUE(groups.put(villa, students, Role::annotator, {}));
  ASSERT_TRUE(groups.put(villa, diggers, Role::curator, {}));
  ASSERT_TRUE(groups.put(forum, diggers, Role::viewer, {}));
  EXPECT_EQ(roles_of(*store, gus),
            (Roles{Role::guest, {{villa, Role::curator}, {forum, Role::viewer}}}));
  EXPECT_EQ(roles_of(*store, weak),
            (Roles{Role::guest, {{villa, Role::viewer}, {forum, Role::viewer}}}));
  ASSERT_TRUE(store->members().put(villa, "Gus", Role::viewer));
  EXPECT_EQ(roles_of(*store, gus).in(villa), Role::curator)
      << "a lower role of their own takes nothing";
  const auto given = groups.roles_of("Gus").value();
  ASSERT_EQ(given.size(), 3u);
  EXPECT_EQ(given[0].group + " " + given[1].group + " " + given[2].group,
            "Diggers Diggers Students");
  ASSERT_TRUE(store->members().put(forum, "Gus", Role::annotator));
  EXPECT_EQ(roles_of(*store, gus).in(forum), Role::annotator) << "nor does a lower one of a group";
  EXPECT_EQ(groups.roles_of("Gus")->size(), 2u) << "what is less than their own is given by nobody";
  EXPECT_EQ(groups.people_with_role(villa)->size(), 1u);
  // Tests each way in which the role ends.
  ASSERT_TRUE(groups.put(villa, diggers, Role::annotator, {}));
  EXPECT_EQ(roles_of(*store, gus).in(villa), Role::annotator);
  ASSERT_TRUE(groups.take(villa, diggers, {}));
  EXPECT_EQ(groups.take(villa, diggers, {}).error().code, ErrorCode::not_found);
  EXPECT_EQ(roles_of(*store, gus).in(villa), Role::annotator) << "by the students";
  EXPECT_EQ(groups.change(students, {.remove = {"GUS"}}, {}).value().people, Names{"Gus"});
  EXPECT_EQ(roles_of(*store, gus).in(villa), Role::viewer) << "their own";
  ASSERT_TRUE(store->members().remove(villa, "Gus"));
  EXPECT_EQ(groups.change(students, {.add = {"Gus"}}, {}).value().people, Names{"Gus"});
  EXPECT_EQ(roles_of(*store, gus).in(villa), Role::annotator);
  EXPECT_EQ(groups.remove(students, {}).value(), Names{"Gus"});
  EXPECT_EQ(roles_of(*store, gus), (Roles{Role::guest, {{forum, Role::annotator}}}));
  EXPECT_TRUE(groups.of_project(villa)->empty());
  EXPECT_EQ(store->accounts().find("Gus")->groups, Names{"Diggers"});
}

TEST(Groups, only_roles_of_projects_are_given_and_to_what_is_there) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  const auto villa = project(*store, "Villa");
  const auto students = groups.create("Students", {}).value().group.id;
  for (const Role role : {Role::guest, Role::administrator, Role::owner})
    EXPECT_EQ(groups.put(villa, students, role, {}).error().code, ErrorCode::invalid);
  EXPECT_EQ(groups.put(villa, GroupId(students.number() + 1), Role::viewer, {}).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(groups.put(ProjectId(villa.number() + 1), students, Role::viewer, {}).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(groups.take(villa, students, {}).error().code, ErrorCode::not_found);
  const auto put = groups.put(villa, students, Role::viewer, {}).value();
  EXPECT_EQ(put.now.role, Role::viewer);
  EXPECT_EQ(put.now.group.name, "Students");
  ASSERT_TRUE(store->projects().remove(villa)) << "roles keep no project";
  EXPECT_TRUE(groups.group(students)->projects.empty());
}

TEST(Groups, people_are_put_in_and_taken_out_all_or_none) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  for (const char* name : {"Ada", "Bob", "Cyd"})
    ASSERT_TRUE(store->accounts().create(name, "", Role::viewer));
  EXPECT_EQ(groups.create("Students", {"Ada", "nobody"}).error().code, ErrorCode::invalid);
  EXPECT_TRUE(groups.all()->empty()) << "nothing is left of what was refused";
  const auto students = groups.create("Students", {"bob", "Ada", "Ada"}).value();
  EXPECT_EQ(names_of(students.members), (Names{"Ada", "Bob"}));
  const auto id = students.group.id;
  for (const char* nobody : {"nobody", "", "\xff",
                             "\xc3\x84"
                             "da"}) {
    EXPECT_EQ(groups.change(id, {.name = "Changed", .add = {"Cyd", nobody}}, {}).error().code,
              ErrorCode::invalid)
        << nobody;
    EXPECT_EQ(groups.change(id, {.remove = {"Ada", nobody}}, {}).error().field, "remove") << nobody;
  }
  EXPECT_EQ(groups.group(id)->group.name, "Students");
  EXPECT_EQ(names_of(groups.group(id)->members), (Names{"Ada", "Bob"}));
  const auto changed = groups.change(id, {.add = {"Cyd", "Ada"}, .remove = {"Bob"}}, {}).value();
  EXPECT_EQ(names_of(changed.now.members), (Names{"Ada", "Cyd"}));
  EXPECT_TRUE(changed.people.empty()) << "in no project does anybody do anything else than before";
  EXPECT_EQ(groups.all()->front().people, 2);
  // Deleted users leave groups. Invitations may contain groups.
  ASSERT_TRUE(store->accounts().remove("Ada"));
  EXPECT_EQ(names_of(groups.group(id)->members), Names{"Cyd"});
  EXPECT_EQ(store->accounts().create("Dan", "", Role::guest, {id, id}).value().groups,
            Names{"Students"});
  EXPECT_EQ(
      store->accounts().create("Eve", "", Role::guest, {id, GroupId(id.number() + 1)}).error().code,
      ErrorCode::invalid);
  EXPECT_EQ(store->accounts().find("Eve").error().code, ErrorCode::not_found);
}

TEST(Groups, it_is_told_who_could_do_less_without_one) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  const auto villa = project(*store, "Villa"), forum = project(*store, "Forum");
  // Of these users, only those without another role lose access. Users keep access if they have a
  // role for the whole server, a role through another group, or their own role.
  session_of(*store, "Only", Role::guest);
  session_of(*store, "Viewer", Role::viewer);
  session_of(*store, "Other", Role::guest);
  session_of(*store, "Own", Role::guest);
  session_of(*store, "Out", Role::guest);
  const auto students =
      groups.create("Students", {"Only", "Viewer", "Other", "Own", "Out"}).value().group.id;
  const auto other = groups.create("Others", {"Other"}).value().group.id;
  ASSERT_TRUE(groups.put(villa, students, Role::viewer, {}));
  ASSERT_TRUE(groups.put(villa, other, Role::viewer, {}));
  ASSERT_TRUE(store->members().put(villa, "Own", Role::annotator));
  ASSERT_TRUE(store->accounts().update(store->accounts().find("Out")->id, {{}, {}, true}));
  EXPECT_EQ(groups.group(students)->losing, 1);
  ASSERT_TRUE(groups.put(villa, students, Role::annotator, {}));
  EXPECT_EQ(groups.group(students)->losing, 3) << "all but who has the same of their own";
  ASSERT_TRUE(groups.put(forum, students, Role::viewer, {}));
  EXPECT_EQ(groups.group(students)->losing, 4);
  EXPECT_EQ(groups.group(other)->losing, 0);
}

TEST(Groups, there_are_not_too_many_and_none_is_too_large) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  Groups& groups = store->groups();
  const auto students = groups.create("Students", {}).value().group.id;
  auto connection = PgConnection::connect(dsn);
  ASSERT_TRUE(connection->script(
      "INSERT INTO users (name, role) SELECT 'p' || i, 'viewer' FROM generate_series(1, 1001) i;"
      "INSERT INTO group_people SELECT g.id, u.id FROM groups g, users u WHERE u.name LIKE 'p%' AND u.name <> 'p1001' AND u.name <> 'p1000';"
      "INSERT INTO groups (name) SELECT 'g' || i FROM generate_series(1, 198) i"));
  EXPECT_EQ(groups.change(students, {.add = {"p1000", "p1001"}}, {}).error().code,
            ErrorCode::conflict);
  ASSERT_TRUE(groups.change(students, {.add = {"p1000"}}, {}));
  EXPECT_EQ(groups.change(students, {.add = {"p1001"}}, {}).error().code, ErrorCode::conflict);
  EXPECT_EQ(store->accounts().create("New", "", Role::viewer, {students}).error().code,
            ErrorCode::conflict);
  ASSERT_TRUE(groups.change(students, {.add = {"p1001"}, .remove = {"p1"}}, {}))
      << "who leaves makes room";
  EXPECT_EQ(groups.group(students)->members.size(), 1000u);
  // Only one of several concurrent requests can create the last group.
  std::atomic<int> made = 0;
  {
    std::vector<std::jthread> administrators;
    for (int i = 0; i < 4; ++i)
      administrators.emplace_back([&, i] {
        if (groups.create("last " + std::to_string(i), {})) ++made;
      });
  }
  EXPECT_EQ(made, 1);
  EXPECT_EQ(groups.all()->size(), 200u);
}

TEST(Groups, who_asked_for_what_is_told_in_each_project) {
  auto store = test::fresh_store();
  Groups& groups = store->groups();
  const auto villa = project(*store, "Villa"), forum = project(*store, "Forum");
  session_of(*store, "Gus", Role::guest);
  const auto students = groups.create("Students", {}).value().group.id;
  ASSERT_TRUE(groups.put(villa, students, Role::viewer, "Anne"));
  ASSERT_TRUE(groups.put(villa, students, Role::curator, "Anne"));
  ASSERT_TRUE(groups.put(villa, students, Role::curator, "Anne")) << "again is no change";
  ASSERT_TRUE(groups.change(students, {.name = "Pupils", .add = {"Gus"}}, "Anne"));
  ASSERT_TRUE(groups.change(students, {.remove = {"Gus"}}, "Anne"));
  ASSERT_TRUE(groups.put(forum, students, Role::viewer, {})) << "the command line asks as nobody";
  ASSERT_TRUE(groups.remove(students, "Anne"));
  const auto lines_of = [&](ProjectId of_project) {
    ActivityQuery query;
    query.with_members = true;
    Names lines;
    const auto page = store->projects().activity(of_project, Role::owner, query).value();
    for (const Activity& line : page.lines)
      if (line.kind == "member")
        lines.push_back(line.user + " " + line.op + " " + line.group + " " + line.person + " " +
                        line.role);
    std::ranges::sort(lines);
    return lines;
  };
  EXPECT_EQ(lines_of(villa), (Names{"Anne added Pupils Gus curator", "Anne added Students  viewer",
                                    "Anne changed Students  curator", "Anne removed Pupils  ",
                                    "Anne removed Pupils Gus "}));
  EXPECT_EQ(lines_of(forum), Names{"Anne removed Pupils  "});
}

}  // namespace
}  // namespace strata::store
