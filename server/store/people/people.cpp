#include "store/people/people.h"

#include <algorithm>

#include "core/digest.h"
#include "core/secret.h"
#include "store/people/accounts.h"
#include "store/people/members.h"
#include "store/people/tokens.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

// A transaction that changes a user, or adds or removes a secret, locks the user first
// (`lock_person`). Facts that were read about the user then stay true until the commit.

namespace strata::store {
namespace {

constexpr std::string_view kFormer = "former-";
constexpr std::pair<TokenKind, std::string_view> kKinds[] = {{TokenKind::session, "session"},
                                                             {TokenKind::script, "script"},
                                                             {TokenKind::owner_link, "owner_link"},
                                                             {TokenKind::invitation, "invitation"}};

std::string_view name(TokenKind kind) {
  for (const auto& [each, text] : kKinds)
    if (each == kind) return text;
  return {};
}

std::optional<TokenKind> parse_kind(const std::string& text) {
  for (const auto& [kind, each] : kKinds)
    if (each == text) return kind;
  return std::nullopt;
}

constexpr auto kPersonColumns = sql(
    "id, name, full_name, role, password IS NOT NULL, disabled IS NOT NULL, created, last_seen, "
    "(SELECT coalesce(jsonb_agg(g.name ORDER BY lower(g.name)), '[]') FROM group_people p JOIN groups g "
    "ON g.id = p.group_id WHERE p.user_id = users.id), "
    "EXISTS (SELECT 1 FROM sign_ons s WHERE s.user_id = users.id AND s.first_used IS NOT NULL)");
constexpr auto kGoodToken = sql("(revoked IS NULL AND (expires IS NULL OR expires > now()))");

Person read_person(PgRow& row) {
  Person person;
  person.id = row.id<PersonId>();
  person.name = row.text();
  person.full_name = row.text();
  person.role = parse_role(row.text()).value_or(Role::viewer);
  person.has_password = row.boolean();
  person.disabled = row.boolean();
  person.created = row.time();
  person.last_seen = row.optional_time();
  person.groups = row.json().get<std::vector<std::string>>();
  person.has_sign_on = row.boolean();
  return person;
}

Person read_person(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return read_person(row);
}

bool is_ascii(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

Result<Person> load_person(PgConnection& connection, const std::string& name, bool lock) {
  // Names are ASCII. The lower case of a letter outside ASCII must not match a name.
  if (!is_ascii(name) || !check_text(name, "user")) return no_such("person", name);
  constexpr auto kRead = sql("SELECT ", kPersonColumns,
                             " FROM users WHERE lower(name) = lower($1) AND deleted IS NULL");
  constexpr auto kLock = sql(kRead, " FOR UPDATE");
  auto rows =
      STRATA_TRY(connection.query(lock ? kLock.c_str() : kRead.c_str(), Params().text(name)));
  if (rows.rows() == 0) return no_such("person", name);
  return read_person(rows, 0);
}
Result<void> run(PgConnection& connection, const auto& sql, const Params& params) {
  auto done = connection.query(sql, params);
  return done ? Result<void>() : tl::unexpected(done.error());
}

Result<void> revoke_tokens(PgConnection& connection, const std::string& user, TokenKind kind,
                           std::optional<TokenId> kept_token) {
  return run(
      connection,
      "UPDATE tokens SET revoked = now() WHERE user_name = $1 AND kind = $2 AND revoked IS NULL AND "
      "id IS DISTINCT FROM $3",
      Params().text(user).text(name(kind)).optional_id(kept_token));
}

Result<std::int64_t> count_good(PgConnection& connection, const std::string& user, TokenKind kind) {
  auto rows = connection.query(
      sql("SELECT count(*) FROM tokens WHERE user_name = $1 AND kind = $2 AND ", kGoodToken),
      Params().text(user).text(name(kind)));
  return rows ? Result<std::int64_t>(rows->integer(0, 0)) : tl::unexpected(rows.error());
}

Token read_token(const PgResult& rows, TokenKind kind, int i) {
  PgRow row(rows, i);
  Token token;
  token.id = row.id<TokenId>();
  token.kind = kind;
  token.label = row.text();
  token.role = parse_role(row.text()).value_or(Role::viewer);
  token.created = row.time();
  token.expires = row.optional_time();
  token.last_used = row.optional_time();
  token.project = row.optional_text();
  return token;
}
constexpr auto kTokenColumns = sql(
    "id, label, role, created, expires, last_used, (SELECT slug FROM projects p WHERE p.id = tokens.project_id)");

// The user must be locked.
Result<NewToken> insert_token(PgConnection& connection, TokenKind kind, const std::string& user,
                              Role role, std::optional<std::chrono::seconds> lifetime,
                              const std::string& label, std::optional<ProjectId> project = {}) {
  STRATA_TRY(run(
      connection,
      "DELETE FROM tokens WHERE user_name = $1 AND coalesce(revoked, expires) < now() - interval '30 days'",
      Params().text(user)));
  NewToken made;
  made.secret = random_token();
  std::optional<Time> expires;
  if (lifetime) expires = std::chrono::system_clock::now() + *lifetime;
  auto row = STRATA_TRY(connection.query(
      sql("INSERT INTO tokens (hash, kind, user_name, role, expires, label, project_id) VALUES ($1, $2, $3, $4, $5, $6, $7) "
          "RETURNING ",
          kTokenColumns),
      Params()
          .bytes(sha256(made.secret))
          .text(name(kind))
          .text(user)
          .text(strata::name(role))
          .time(expires)
          .text(label)
          .optional_id(project)));
  made.token = read_token(row, kind, 0);
  return made;
}

struct Found {
  Principal principal;
  bool is_fresh = false;  // its use was recorded in the last five minutes
};
Result<std::optional<Found>> find_secret(PgConnection& connection, const std::string& secret) {
  auto row = STRATA_TRY(connection.query(
      sql("SELECT u.name, u.role, t.role, t.kind, t.id, u.id, coalesce(t.last_used > now() - interval '5 minutes', false), "
          "t.project_id "
          "FROM (SELECT * FROM tokens WHERE hash = $1 AND ",
          kGoodToken,
          ") t JOIN users u ON u.name = t.user_name "
          "WHERE u.disabled IS NULL AND u.deleted IS NULL"),
      Params().bytes(sha256(secret))));
  if (row.rows() == 0) return std::optional<Found>();
  const auto persons = parse_role(row.text(0, 1)), own = parse_role(row.text(0, 2));
  const auto kind = parse_kind(row.text(0, 3));
  // the values are from a later version
  if (!persons || !own || !kind) return std::optional<Found>();
  Roles roles{*persons, {}};
  auto given =
      STRATA_TRY(connection.query("SELECT project_id, role FROM project_roles WHERE user_id = $1",
                                  Params().integer(row.integer(0, 5))));
  for (int i = 0; i < given.rows(); ++i)
    if (const auto role = parse_role(given.text(i, 1))) {
      Role& there = roles.in_projects[given.id<ProjectId>(i, 0)];
      there = std::max(there, *role);
    }
  if (*kind == TokenKind::script) roles = roles.at_most(*own);
  if (!row.null(0, 7)) {
    const ProjectId project = row.id<ProjectId>(0, 7);
    const Role there = std::min(roles.in(project), Role::curator);
    roles = {};
    if (there > Role::guest) roles.in_projects[project] = there;
  }
  return std::optional<Found>(
      {{row.text(0, 0), std::move(roles), *kind, row.id<TokenId>(0, 4)}, row.boolean(0, 6)});
}

Result<void> put_password(PgConnection& connection, const std::string& user,
                          const std::string& hash, std::optional<TokenId> kept_token) {
  STRATA_TRY(run(connection, "UPDATE users SET password = $2 WHERE name = $1",
                 Params().text(user).text(hash)));
  STRATA_TRY(revoke_tokens(connection, user, TokenKind::session, kept_token));
  for (const TokenKind link : {TokenKind::invitation, TokenKind::owner_link})
    STRATA_TRY(revoke_tokens(connection, user, link, {}));
  return {};
}

}  // namespace

Result<Person> lock_person(PgConnection& connection, const std::string& name) {
  return load_person(connection, name, true);
}

Result<NewToken> open_session(PgConnection& connection, const Person& person,
                              std::optional<std::chrono::seconds> lifetime,
                              const std::string& label) {
  auto made =
      insert_token(connection, TokenKind::session, person.name, person.role, lifetime, label);
  if (!made) return made;
  STRATA_TRY(run(
      connection,
      sql("UPDATE tokens SET revoked = now() WHERE id IN (SELECT id FROM tokens WHERE user_name = $1 AND "
          "kind = 'session' AND ",
          kGoodToken, " ORDER BY id DESC OFFSET $2)"),
      Params().text(person.name).integer(kMaxTokens)));
  return made;
}

Result<std::vector<Person>> Accounts::all() {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Person>> {
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT ", kPersonColumns, " FROM users WHERE deleted IS NULL ORDER BY lower(name)")));
    std::vector<Person> people;
    for (int i = 0; i < rows.rows(); ++i) people.push_back(read_person(rows, i));
    return people;
  });
}

Result<Person> Accounts::find(const std::string& name) {
  return pool_.read([&](PgConnection& connection) { return load_person(connection, name, false); });
}

Result<std::vector<Person>> Accounts::called(const std::vector<std::string>& names) {
  PgArray requested(oid::kText);
  for (const std::string& name : names)
    if (check_text(name, "user")) requested.add(std::string_view(name));
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Person>> {
    auto rows = STRATA_TRY(
        connection.query(sql("SELECT ", kPersonColumns, " FROM users WHERE name = any($1)"),
                         Params().array(requested)));
    std::vector<Person> people;
    for (int i = 0; i < rows.rows(); ++i) people.push_back(read_person(rows, i));
    return people;
  });
}

Result<Person> Accounts::create(const std::string& name, const std::string& full_name, Role role,
                                const std::vector<GroupId>& groups, const std::string& by) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto may_stand = [&](char c) {
    return is_plain(c) || std::string_view("._@-").find(c) != std::string_view::npos;
  };
  if (name.empty() || name.size() > 64 || !is_plain(name.front()) ||
      !std::ranges::all_of(name, may_stand))
    return fail(ErrorCode::invalid, "Invalid name",
                "A user name must consist of 1 to 64 letters (a to z), digits, `.`, `_`, `@` and "
                "`-`. It must begin with a letter or digit.",
                "user");
  std::string lower = name;
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (lower.starts_with(kFormer))
    return fail(ErrorCode::conflict, "Name reserved",
                "User names that begin with `former-` are reserved for deleted accounts. "
                "Choose another name.",
                "user");
  STRATA_TRY(check_texts({{&full_name, "full_name"}}));
  return pool_.write([&](PgConnection& connection) -> Result<Person> {
    auto made = STRATA_TRY(connection.query(
        sql("INSERT INTO users (name, full_name, role) VALUES ($1, $2, $3) ON CONFLICT DO NOTHING "
            "RETURNING ",
            kPersonColumns),
        Params().text(name).text(full_name).text(strata::name(role))));
    if (made.rows() == 0)
      return fail(
          ErrorCode::conflict, "Name already used",
          "There is already a person with the user name `" + name + "`. Choose another name.",
          "user");
    if (groups.empty()) return read_person(made, 0);
    STRATA_TRY(act_as(connection, by));
    STRATA_TRY(join_groups(connection, made.id<PersonId>(0, 0), groups));
    return load_person(connection, name, false);
  });
}

Result<Person> Accounts::update(PersonId id, const PersonChange& change) {
  if (change.full_name) STRATA_TRY(check_texts({{&*change.full_name, "full_name"}}));
  return pool_.write([&](PgConnection& connection) -> Result<Person> {
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT ", kPersonColumns, " FROM users WHERE id = $1 AND deleted IS NULL FOR UPDATE"),
        Params().id(id)));
    if (rows.rows() == 0) return no_such("person", to_string(id));
    Person person = read_person(rows, 0);
    if (change.full_name) person.full_name = *change.full_name;
    if (change.role) person.role = *change.role;
    if (change.disabled) person.disabled = *change.disabled;
    STRATA_TRY(run(
        connection,
        "UPDATE users SET full_name = $2, role = $3, disabled = CASE WHEN $4 THEN coalesce(disabled, now()) END "
        "WHERE id = $1",
        Params()
            .id(id)
            .text(person.full_name)
            .text(strata::name(person.role))
            .boolean(person.disabled)));
    if (person.disabled)
      for (const TokenKind kind : {TokenKind::session, TokenKind::invitation})
        STRATA_TRY(revoke_tokens(connection, person.name, kind, {}));
    return person;
  });
}

Result<void> Accounts::remove(const std::string& name) {
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<void> {
    auto person = STRATA_TRY(lock_person(connection, name));
    auto ended =
        run(connection, "DELETE FROM tokens WHERE user_name = $1", Params().text(person.name));
    if (!ended) return ended;
    STRATA_TRY(run(connection,
                   "DELETE FROM selections WHERE user_name = $1 AND content ->> 'audience' = "
                   "'personal'",
                   Params().text(person.name)));
    for (const char* sql :
         {"DELETE FROM project_members WHERE user_id = $1",
          "DELETE FROM group_people WHERE user_id = $1", "DELETE FROM sign_ons WHERE user_id = $1",
          "DELETE FROM personal_views WHERE user_id = $1"})
      STRATA_TRY(run(connection, sql, Params().id(person.id)));
    const std::string former = std::string(kFormer) + to_string(person.id);
    for (
        const char* sql :
        {"UPDATE users SET name = $2, full_name = '', password = NULL, deleted = now() WHERE name = $1",
         "UPDATE table_edits SET user_name = $2 WHERE user_name = $1",
         "UPDATE attachments SET user_name = $2 WHERE user_name = $1",
         "UPDATE views SET user_name = $2 WHERE user_name = $1",
         "UPDATE all_models SET binned_by = $2 WHERE binned_by = $1",
         "UPDATE all_layers SET binned_by = $2 WHERE binned_by = $1",
         "UPDATE snapshots SET user_name = $2 WHERE user_name = $1",
         "UPDATE selections SET user_name = $2 WHERE user_name = $1",
         "UPDATE tours SET user_name = $2 WHERE user_name = $1",
         "UPDATE kiosks SET user_name = $2 WHERE user_name = $1",
         "UPDATE jobs SET user_name = $2 WHERE user_name = $1"})
      STRATA_TRY(run(connection, sql, Params().text(person.name).text(former)));
    STRATA_TRY(rename_in_journal(connection, person.name, former));
    STRATA_TRY(rename_in_comments(connection, person.name, former));
    STRATA_TRY(rename_in_activity(connection, person.name, former));
    // Stored responses for repeated requests may contain the name, as a user name or in a mention.
    // JSON does not escape any character of a name.
    return run(
        connection,
        sql("DELETE FROM answers WHERE position('\"' || $1 || '\"' IN replace(answer::text, '\\', '')) > 0 "
            "OR ",
            mentions_them("answer::text")),
        Params().text(person.name));
  });
}

Result<std::vector<Membership>> Members::of_project(ProjectId project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Membership>> {
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT ", kPersonColumns,
            ", in_project FROM users JOIN "
            "(SELECT user_id, role AS in_project FROM project_members WHERE project_id = $1) m "
            "ON user_id = id ORDER BY lower(name)"),
        Params().id(project_id)));
    std::vector<Membership> members;
    for (int i = 0; i < rows.rows(); ++i) {
      PgRow row(rows, i);
      members.push_back({read_person(row), parse_role(row.text()).value_or(Role::viewer)});
    }
    return members;
  });
}

Result<void> check_project_role(Role role) {
  if (role < Role::viewer || role > Role::curator)
    return fail(ErrorCode::invalid, "Not a project role",
                "The role in a project must be viewer, annotator or curator.", "role");
  return {};
}

Result<void> lock_project(PgConnection& connection, ProjectId id) {
  auto project =
      connection.query("SELECT 1 FROM projects WHERE id = $1 FOR KEY SHARE", Params().id(id));
  if (!project) return tl::unexpected(project.error());
  if (project->rows() == 0) return no_such("project", to_string(id));
  return {};
}

Result<Membership> Members::put(ProjectId project_id, const std::string& user, Role role,
                                const std::string& by) {
  STRATA_TRY(check_project_role(role));
  return pool_.write([&](PgConnection& connection) -> Result<Membership> {
    auto person = STRATA_TRY(lock_person(connection, user));
    STRATA_TRY(lock_project(connection, project_id));
    STRATA_TRY(act_as(connection, by));
    STRATA_TRY(run(connection,
                   "INSERT INTO project_members (project_id, user_id, role) VALUES ($1, $2, $3) "
                   "ON CONFLICT (project_id, user_id) DO UPDATE SET role = excluded.role",
                   Params().id(project_id).id(person.id).text(strata::name(role))));
    return Membership{std::move(person), role};
  });
}

Result<void> Members::remove(ProjectId project_id, const std::string& user, const std::string& by) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto person = STRATA_TRY(lock_person(connection, user));
    STRATA_TRY(act_as(connection, by));
    auto gone = STRATA_TRY(connection.query(
        "DELETE FROM project_members WHERE project_id = $1 AND user_id = $2 RETURNING 1",
        Params().id(project_id).id(person.id)));
    if (gone.rows() == 0) return no_such("member", user);
    return {};
  });
}

Result<bool> Accounts::administrator_can_sign_in(bool local_accounts) {
  return pool_.read([&](PgConnection& connection) -> Result<bool> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT 1 FROM users WHERE ($1 AND password IS NOT NULL OR "
        "EXISTS (SELECT 1 FROM sign_ons s WHERE s.user_id = users.id AND s.first_used IS NOT NULL)) "
        "AND disabled IS NULL AND deleted IS NULL AND role IN ('administrator', 'owner') LIMIT 1",
        Params().boolean(local_accounts)));
    return rows.rows() > 0;
  });
}

Result<std::string> Accounts::password_of(const std::string& name) {
  if (!is_ascii(name) || !check_text(name, "user")) return std::string();
  return pool_.read([&](PgConnection& connection) -> Result<std::string> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT password FROM users WHERE lower(name) = lower($1) AND disabled IS NULL AND deleted IS NULL AND "
        "password IS NOT NULL",
        Params().text(name)));
    return rows.rows() == 0 ? std::string() : rows.text(0, 0);
  });
}

Result<void> Accounts::set_password(const std::string& name, const std::string& hash,
                                    std::optional<TokenId> kept_token) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto person = STRATA_TRY(lock_person(connection, name));
    return put_password(connection, person.name, hash, kept_token);
  });
}

Result<NewToken> Tokens::create(TokenKind kind, const std::string& user, Role role,
                                std::optional<std::chrono::seconds> lifetime,
                                const std::string& label, const std::optional<std::string>& hash,
                                std::optional<ProjectId> project) {
  STRATA_TRY(check_texts({{&label, "name"}}));
  return pool_.write([&](PgConnection& connection) -> Result<NewToken> {
    auto person = STRATA_TRY(lock_person(connection, user));
    if (person.disabled) return no_such("person", user);
    if (hash) {
      auto same = STRATA_TRY(connection.query("SELECT 1 FROM users WHERE id = $1 AND password = $2",
                                              Params().id(person.id).text(*hash)));
      if (same.rows() == 0)
        return fail(ErrorCode::unauthenticated, "Not signed in",
                    "The password was changed in the meantime. Sign in again.", "password");
    }
    if (kind == TokenKind::session) return open_session(connection, person, lifetime, label);
    const auto good = count_good(connection, person.name, kind);
    if (!good) return tl::unexpected(good.error());
    if (kind == TokenKind::script && *good >= static_cast<std::int64_t>(kMaxTokens))
      return fail(
          ErrorCode::conflict, "Too many tokens",
          "There are already " + std::to_string(kMaxTokens) + " tokens. Revoke some tokens first.");
    if (project) {
      STRATA_TRY(check_project_role(role));
      STRATA_TRY(lock_project(connection, *project));
    }
    return insert_token(connection, kind, person.name, role, lifetime, label, project);
  });
}

Result<NewToken> Tokens::create_link(TokenKind kind, const std::string& user,
                                     std::chrono::seconds lifetime) {
  return pool_.write([&](PgConnection& connection) -> Result<NewToken> {
    auto person = STRATA_TRY(lock_person(connection, user));
    if (person.disabled) return no_such("person", user);
    STRATA_TRY(revoke_tokens(connection, person.name, kind, {}));
    return insert_token(connection, kind, person.name, person.role, lifetime, {});
  });
}

Result<std::optional<Principal>> Tokens::find(const std::string& secret) {
  auto found = STRATA_TRY(
      pool_.read([&](PgConnection& connection) { return find_secret(connection, secret); }));
  if (!found) return std::optional<Principal>();
  const Principal& principal = found->principal;
  // Ignore a failure to record the use, because the secret is valid even if nothing can be written.
  if (!found->is_fresh &&
      (principal.kind == TokenKind::session || principal.kind == TokenKind::script))
    (void)pool_.write([&](PgConnection& connection) {
      return run(
          connection,
          "WITH used AS (UPDATE tokens SET last_used = now() WHERE id = $1 RETURNING user_name) "
          "UPDATE users SET last_seen = now() FROM used WHERE name = used.user_name",
          Params().id(principal.token));
    });
  return principal;
}

Result<std::vector<Token>> Tokens::of_user(const std::string& user, TokenKind kind) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Token>> {
    auto rows = STRATA_TRY(connection.query(sql("SELECT ", kTokenColumns,
                                                " FROM tokens WHERE user_name = $1 AND kind = $2 "
                                                "AND ",
                                                kGoodToken, " ORDER BY id DESC"),
                                            Params().text(user).text(name(kind))));
    std::vector<Token> tokens;
    for (int i = 0; i < rows.rows(); ++i) tokens.push_back(read_token(rows, kind, i));
    return tokens;
  });
}

Result<std::optional<std::string>> Tokens::redeem_owner_link(const std::string& link,
                                                             std::chrono::seconds lifetime,
                                                             const std::string& label) {
  return pool_.write([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    auto owner = STRATA_TRY(find_secret(connection, link));
    if (!owner || owner->principal.kind != TokenKind::owner_link)
      return std::optional<std::string>();
    auto person = STRATA_TRY(lock_person(connection, owner->principal.user));
    auto session = STRATA_TRY(open_session(connection, person, lifetime, label));
    return std::optional<std::string>(std::move(session.secret));
  });
}

Result<std::optional<std::string>> Accounts::accept_invitation(
    const std::string& invitation, const std::string& hash,
    const std::optional<std::string>& full_name, std::chrono::seconds lifetime,
    const std::string& label) {
  if (full_name) STRATA_TRY(check_texts({{&*full_name, "full_name"}}));
  return pool_.write([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    const auto is_good = [](const auto& found) {
      return found && found->principal.kind == TokenKind::invitation;
    };
    auto invited = STRATA_TRY(find_secret(connection, invitation));
    if (!is_good(invited)) return std::optional<std::string>();
    auto person = STRATA_TRY(lock_person(connection, invited->principal.user));
    // Two calls may use the invitation at the same time, and the user may have been disabled before
    // this transaction got the lock.
    auto still = STRATA_TRY(find_secret(connection, invitation));
    if (!is_good(still)) return std::optional<std::string>();
    STRATA_TRY(put_password(connection, person.name, hash, {}));
    if (full_name) {
      STRATA_TRY(run(connection, "UPDATE users SET full_name = $2 WHERE name = $1",
                     Params().text(person.name).text(*full_name)));
    }
    auto session = STRATA_TRY(open_session(connection, person, lifetime, label));
    return std::optional<std::string>(std::move(session.secret));
  });
}

Result<void> Tokens::revoke(const std::string& secret) {
  return pool_.write([&](PgConnection& connection) {
    return run(connection, "UPDATE tokens SET revoked = now() WHERE hash = $1 AND revoked IS NULL",
               Params().bytes(sha256(secret)));
  });
}

Result<void> Tokens::revoke(const std::string& user, TokenKind kind, TokenId id) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto done = STRATA_TRY(connection.query(
        sql("UPDATE tokens SET revoked = now() WHERE user_name = $1 AND kind = $2 AND id = $3 AND ",
            kGoodToken, " RETURNING id"),
        Params().text(user).text(name(kind)).id(id)));
    if (done.rows() == 0)
      return no_such(kind == TokenKind::session ? "session" : "token", to_string(id));
    return {};
  });
}

Result<void> Tokens::revoke_all(const std::string& user, TokenKind kind,
                                std::optional<TokenId> kept_token) {
  return pool_.write(
      [&](PgConnection& connection) { return revoke_tokens(connection, user, kind, kept_token); });
}

}  // namespace strata::store
