#include "store/people/groups.h"

#include <algorithm>
#include <set>

#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

// A change to a group locks the group first, and then users in the order of their names. Facts that
// were read about a locked group or user stay true until the commit.

namespace strata::store {
namespace {

constexpr std::size_t kMaxGroupNameLength = 100;  // characters

constexpr auto kGroupColumns =
    sql("g.id, g.name, (SELECT count(*) FROM group_people p WHERE p.group_id = g.id), "
        "(SELECT count(*) FROM project_groups r WHERE r.group_id = g.id)");

Group read_group(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<GroupId>(), row.text(), row.integer(), row.integer()};
}

Role read_role(const PgResult& rows, int row, int column) {
  return parse_role(rows.text(row, column)).value_or(Role::viewer);
}

Result<Group> load(PgConnection& connection, GroupId id, bool lock) {
  constexpr auto kRead = sql("SELECT ", kGroupColumns, " FROM groups g WHERE g.id = $1");
  constexpr auto kLock = sql(kRead, " FOR UPDATE");
  auto rows = STRATA_TRY(connection.query(lock ? kLock.c_str() : kRead.c_str(), Params().id(id)));
  if (rows.rows() == 0) return no_such("group", to_string(id));
  return read_group(rows, 0);
}
Result<Group> lock_group(PgConnection& connection, GroupId id) {
  return load(connection, id, true);
}

Result<GroupDetail> load_detail(PgConnection& connection, GroupId id) {
  auto group = STRATA_TRY(load(connection, id, false));
  GroupDetail detail;
  detail.group = std::move(group);
  auto members = STRATA_TRY(connection.query(
      "SELECT u.name, u.full_name FROM group_people p JOIN users u ON u.id = p.user_id WHERE p.group_id = $1 "
      "ORDER BY lower(u.name)",
      Params().id(id)));
  for (int i = 0; i < members.rows(); ++i)
    detail.members.push_back({members.text(i, 0), members.text(i, 1)});
  auto projects = STRATA_TRY(connection.query(
      "SELECT p.slug::text, p.name, r.role FROM project_groups r JOIN projects p ON p.id = r.project_id "
      "WHERE r.group_id = $1 ORDER BY lower(p.name), p.id",
      Params().id(id)));
  for (int i = 0; i < projects.rows(); ++i)
    detail.projects.push_back(
        {projects.text(i, 0), projects.text(i, 1), read_role(projects, i, 2)});
  // Count the users who have no role of the same or a higher rank from another source: from the
  // site, from the project, or from another group.
  auto losing = STRATA_TRY(connection.query(
      "SELECT count(*) FROM group_people p JOIN users u ON u.id = p.user_id WHERE p.group_id = $1 AND "
      "u.disabled IS NULL AND EXISTS (SELECT 1 FROM project_groups g WHERE g.group_id = $1 AND "
      "role_rank(g.role) > role_rank(u.role) AND NOT EXISTS (SELECT 1 FROM project_roles r WHERE "
      "r.project_id = g.project_id AND r.user_id = u.id AND r.group_id IS DISTINCT FROM $1 AND "
      "role_rank(r.role) >= role_rank(g.role)))",
      Params().id(id)));
  detail.losing = losing.integer(0, 0);
  return detail;
}

Result<std::vector<std::string>> people_in(PgConnection& connection, GroupId id) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT u.name FROM group_people p JOIN users u ON u.id = p.user_id WHERE p.group_id = $1",
      Params().id(id)));
  std::vector<std::string> people;
  for (int i = 0; i < rows.rows(); ++i) people.push_back(rows.text(i, 0));
  return people;
}

// Checks the name of a new or renamed group. The lock keeps the names and their number until the
// commit.
Result<void> check_name(PgConnection& connection, const std::string& name, GroupId own_id) {
  STRATA_TRY(connection.query("LOCK TABLE groups IN SHARE ROW EXCLUSIVE MODE"));
  auto taken =
      connection.query("SELECT name FROM groups WHERE lower(name) = lower($1) AND id <> $2",
                       Params().text(name).id(own_id));
  if (!taken) return tl::unexpected(taken.error());
  if (taken->rows() > 0)
    return fail(
        ErrorCode::conflict, "Name already used",
        "There is already a group with the name `" + taken->text(0, 0) + "`. Choose another name.",
        "name");
  return {};
}

Result<void> check_spelling(const std::string& name) {
  const auto is_blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  const auto characters = std::ranges::count_if(name, [](char c) { return (c & 0xc0) != 0x80; });
  if (name.empty() || static_cast<std::size_t>(characters) > kMaxGroupNameLength ||
      is_blank(name.front()) || is_blank(name.back()))
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a group must be 1 to 100 characters long, without spaces at the "
                "beginning or the end.",
                "name");
  return check_text(name, "name");
}

// Locks the users, and returns each user once, even if `names` contains a name several times.
Result<std::vector<Person>> lock_people(PgConnection& connection,
                                        const std::vector<std::string>& names, const char* field) {
  std::vector<Person> people;
  for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
    auto person = lock_person(connection, name);
    if (!person && person.error().code == ErrorCode::not_found)
      return fail(ErrorCode::invalid, "Person not found", person.error().detail, field);
    if (!person) return tl::unexpected(person.error());
    people.push_back(std::move(*person));
  }
  return people;
}

// Adds the user to the group, which must be locked. Returns true if the user was not in the group.
Result<bool> put_person(PgConnection& connection, GroupId group_id, PersonId person_id) {
  auto put = STRATA_TRY(connection.query(
      "INSERT INTO group_people (group_id, user_id) VALUES ($1, $2) ON CONFLICT DO NOTHING RETURNING 1",
      Params().id(group_id).id(person_id)));
  return put.rows() > 0;
}

Result<void> check_not_too_full(PgConnection& connection, GroupId group_id, const char* field) {
  auto count = STRATA_TRY(connection.query("SELECT count(*) FROM group_people WHERE group_id = $1",
                                           Params().id(group_id)));
  if (count.integer(0, 0) > Groups::kMaxPeople)
    return fail(ErrorCode::conflict, "Too many people",
                "A group can have at most " + std::to_string(Groups::kMaxPeople) +
                    " people. Create another group for the other people.",
                field);
  return {};
}

Result<std::vector<std::string>> put_people(PgConnection& connection, GroupId id,
                                            const std::vector<std::string>& names,
                                            const char* field) {
  const auto people = STRATA_TRY(lock_people(connection, names, field));
  std::vector<std::string> put;
  for (const Person& person : people) {
    const auto is_new = STRATA_TRY(put_person(connection, id, person.id));
    if (is_new) put.push_back(person.name);
  }
  STRATA_TRY(check_not_too_full(connection, id, field));
  return put;
}

Result<std::vector<std::string>> take_people(PgConnection& connection, GroupId id,
                                             const std::vector<std::string>& names) {
  const auto people = STRATA_TRY(lock_people(connection, names, "remove"));
  std::vector<std::string> taken;
  for (const Person& person : people) {
    auto gone = STRATA_TRY(connection.query(
        "DELETE FROM group_people WHERE group_id = $1 AND user_id = $2 RETURNING 1",
        Params().id(id).id(person.id)));
    if (gone.rows() > 0) taken.push_back(person.name);
  }
  return taken;
}

Result<void> rename(PgConnection& connection, GroupId id, const std::string& name) {
  STRATA_TRY(check_name(connection, name, id));
  auto done =
      connection.query("UPDATE groups SET name = $2 WHERE id = $1", Params().id(id).text(name));
  return done ? Result<void>() : tl::unexpected(done.error());
}

}  // namespace

Result<void> join_groups(PgConnection& connection, PersonId person_id,
                         const std::vector<GroupId>& groups) {
  for (const GroupId id : std::set<GroupId>(groups.begin(), groups.end())) {
    const auto group = lock_group(connection, id);
    if (!group && group.error().code == ErrorCode::not_found)
      return fail(ErrorCode::invalid, "Group not found", group.error().detail, "groups");
    if (!group) return tl::unexpected(group.error());
    STRATA_TRY(put_person(connection, id, person_id));
    STRATA_TRY(check_not_too_full(connection, id, "groups"));
  }
  return {};
}

Result<std::vector<Group>> Groups::all() {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Group>> {
    auto rows =
        connection.query(sql("SELECT ", kGroupColumns, " FROM groups g ORDER BY lower(g.name)"));
    if (!rows) return tl::unexpected(rows.error());
    std::vector<Group> groups;
    for (int i = 0; i < rows->rows(); ++i) groups.push_back(read_group(*rows, i));
    return groups;
  });
}

Result<GroupDetail> Groups::group(GroupId id) {
  return pool_.read([&](PgConnection& connection) { return load_detail(connection, id); });
}

Result<GroupDetail> Groups::create(const std::string& name,
                                   const std::vector<std::string>& people) {
  STRATA_TRY(check_spelling(name));
  return pool_.write([&](PgConnection& connection) -> Result<GroupDetail> {
    STRATA_TRY(check_name(connection, name, 0));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM groups"));
    if (count.integer(0, 0) >= kMaxGroups)
      return fail(
          ErrorCode::conflict, "Too many groups",
          "There are already " + std::to_string(kMaxGroups) + " groups. Delete some groups first.",
          "name");
    auto made =
        connection.query("INSERT INTO groups (name) VALUES ($1) RETURNING id", Params().text(name));
    if (!made) return tl::unexpected(made.error());
    const GroupId id = made->id<GroupId>(0, 0);
    STRATA_TRY(put_people(connection, id, people, "members"));
    return load_detail(connection, id);
  });
}

Result<Regrouped<GroupDetail>> Groups::change(GroupId id, const GroupChange& change,
                                              const std::string& by) {
  if (change.name) STRATA_TRY(check_spelling(*change.name));
  return pool_.write([&](PgConnection& connection) -> Result<Regrouped<GroupDetail>> {
    STRATA_TRY(act_as(connection, by));
    if (change.name) STRATA_TRY(rename(connection, id, *change.name));
    STRATA_TRY(lock_group(connection, id));
    auto taken = STRATA_TRY(take_people(connection, id, change.remove));
    auto put = STRATA_TRY(put_people(connection, id, change.add, "add"));
    auto detail = STRATA_TRY(load_detail(connection, id));
    std::vector<std::string> people;
    // If the group has no roles, the rights of its users do not change.
    if (!detail.projects.empty()) std::ranges::set_union(taken, put, std::back_inserter(people));
    return Regrouped<GroupDetail>{std::move(detail), std::move(people)};
  });
}

Result<std::vector<std::string>> Groups::remove(GroupId id, const std::string& by) {
  return pool_.write([&](PgConnection& connection) -> Result<std::vector<std::string>> {
    STRATA_TRY(act_as(connection, by));
    STRATA_TRY(lock_group(connection, id));
    auto people = STRATA_TRY(people_in(connection, id));
    // Delete the roles first, so that the activity of each project lists the end of its role.
    for (const char* sql :
         {"DELETE FROM project_groups WHERE group_id = $1", "DELETE FROM groups WHERE id = $1"})
      STRATA_TRY(connection.query(sql, Params().id(id)));
    return people;
  });
}

Result<std::vector<ProjectGroup>> Groups::of_project(ProjectId project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<ProjectGroup>> {
    auto rows =
        connection.query(sql("SELECT ", kGroupColumns,
                             ", i.role FROM project_groups i JOIN groups g ON g.id = i.group_id "
                             "WHERE i.project_id = $1 ORDER BY lower(g.name)"),
                         Params().id(project_id));
    if (!rows) return tl::unexpected(rows.error());
    std::vector<ProjectGroup> groups;
    for (int i = 0; i < rows->rows(); ++i)
      groups.push_back({read_group(*rows, i), read_role(*rows, i, 4)});
    return groups;
  });
}

Result<Regrouped<ProjectGroup>> Groups::put(ProjectId project_id, GroupId id, Role role,
                                            const std::string& by) {
  STRATA_TRY(check_project_role(role));
  return pool_.write([&](PgConnection& connection) -> Result<Regrouped<ProjectGroup>> {
    auto group = STRATA_TRY(lock_group(connection, id));
    STRATA_TRY(lock_project(connection, project_id));
    STRATA_TRY(act_as(connection, by));
    STRATA_TRY(connection.query(
        "INSERT INTO project_groups (project_id, group_id, role) VALUES ($1, $2, $3) "
        "ON CONFLICT (group_id, project_id) DO UPDATE SET role = excluded.role",
        Params().id(project_id).id(id).text(strata::name(role))));
    auto people = STRATA_TRY(people_in(connection, id));
    return Regrouped<ProjectGroup>{{std::move(group), role}, std::move(people)};
  });
}

Result<std::vector<std::string>> Groups::take(ProjectId project_id, GroupId id,
                                              const std::string& by) {
  return pool_.write([&](PgConnection& connection) -> Result<std::vector<std::string>> {
    STRATA_TRY(lock_group(connection, id));
    STRATA_TRY(act_as(connection, by));
    auto gone = STRATA_TRY(connection.query(
        "DELETE FROM project_groups WHERE project_id = $1 AND group_id = $2 RETURNING 1",
        Params().id(project_id).id(id)));
    if (gone.rows() == 0) return no_such("group of the project", to_string(id));
    return people_in(connection, id);
  });
}

Result<std::vector<PersonId>> Groups::people_with_role(ProjectId project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<PersonId>> {
    auto rows = STRATA_TRY(
        connection.query("SELECT DISTINCT user_id FROM project_roles WHERE project_id = $1",
                         Params().id(project_id)));
    std::vector<PersonId> ids;
    for (int i = 0; i < rows.rows(); ++i) ids.push_back(rows.id<PersonId>(i, 0));
    return ids;
  });
}

Result<std::vector<GivenRole>> Groups::roles_of(const std::string& user) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<GivenRole>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT r.project_id, r.role, g.name FROM users u JOIN project_roles r ON r.user_id = u.id "
        "JOIN groups g ON g.id = r.group_id LEFT JOIN project_members m ON m.user_id = u.id AND m.project_id = r.project_id "
        "WHERE u.name = $1 AND (m.role IS NULL OR role_rank(m.role) < role_rank(r.role)) ORDER BY lower(g.name)",
        Params().text(user)));
    std::vector<GivenRole> roles;
    for (int i = 0; i < rows.rows(); ++i)
      roles.push_back({rows.id<ProjectId>(i, 0), read_role(rows, i, 1), rows.text(i, 2)});
    return roles;
  });
}

}  // namespace strata::store
