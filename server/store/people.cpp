#include "store/people.h"

#include "store/hash.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr std::pair<TokenKind, std::string_view> kKinds[] = {{TokenKind::session, "session"},
                                                             {TokenKind::script, "script"},
                                                             {TokenKind::owner_link, "owner_link"},
                                                             {TokenKind::invitation, "invitation"}};

std::string_view name(TokenKind kind) {
  for (const auto& [each, text] : kKinds)
    if (each == kind) return text;
  return {};
}

TokenKind parse_kind(const std::string& text) {
  for (const auto& [kind, each] : kKinds)
    if (each == text) return kind;
  return TokenKind::session;
}

constexpr std::string_view kFormer = "former-";

// `last_used` is right to this, so that most requests write nothing.
#define STRATA_SOME_MINUTES "interval '5 minutes'"
#define STRATA_GOOD_TOKEN "revoked IS NULL AND (expires IS NULL OR expires > now())"
#define STRATA_PERSON_COLUMNS                                                        \
  "id, name, full_name, role, password IS NOT NULL, disabled IS NOT NULL, created, " \
  "(SELECT max(last_used) FROM tokens t WHERE t.user_name = users.name)"

Person read_person(const PgResult& rows, int i) {
  Person person{
      rows.integer(i, 0), rows.text(i, 1),    rows.text(i, 2), parse_role(rows.text(i, 3)).value_or(Role::viewer),
      rows.boolean(i, 4), rows.boolean(i, 5), rows.time(i, 6), std::nullopt};
  if (!rows.null(i, 7)) person.last_seen = rows.time(i, 7);
  return person;
}

Result<Person> load_person(PgConnection& connection, const std::string& name) {
  if (!check_text(name, "user")) return not_found("person", name);
  auto rows =
      connection.query("SELECT " STRATA_PERSON_COLUMNS " FROM users WHERE lower(name) = lower($1) AND deleted IS NULL",
                       Params().text(name));
  if (!rows) return tl::unexpected(rows.error());
  if (rows->rows() == 0) return not_found("person", name);
  return read_person(*rows, 0);
}

Result<void> run(PgConnection& connection, const char* sql, const Params& params) {
  auto done = connection.query(sql, params);
  return done ? Result<void>() : tl::unexpected(done.error());
}

Result<std::string> insert_token(PgConnection& connection, TokenKind kind, const std::string& user, Role role,
                                 std::optional<std::chrono::seconds> lifetime, const std::string& label) {
  const std::string secret = random_token();
  std::optional<Time> expires;
  if (lifetime) expires = std::chrono::system_clock::now() + *lifetime;
  auto made = run(
      connection, "INSERT INTO tokens (hash, kind, user_name, role, expires, label) VALUES ($1, $2, $3, $4, $5, $6)",
      Params().bytes(sha256(secret)).text(name(kind)).text(user).text(strata::name(role)).time(expires).text(label));
  if (!made) return tl::unexpected(made.error());
  return secret;
}

Result<std::optional<Principal>> principal(PgConnection& connection, const std::string& secret) {
  auto row = connection.query(
      "SELECT u.name, u.role, t.role, t.kind, t.id FROM tokens t JOIN users u ON u.name = t.user_name "
      "WHERE t.hash = $1 AND t." STRATA_GOOD_TOKEN " AND u.disabled IS NULL AND u.deleted IS NULL",
      Params().bytes(sha256(secret)));
  if (!row) return tl::unexpected(row.error());
  if (row->rows() == 0) return std::optional<Principal>();
  const Role persons = parse_role(row->text(0, 1)).value_or(Role::viewer);
  const Role own = parse_role(row->text(0, 2)).value_or(Role::viewer);
  const TokenKind kind = parse_kind(row->text(0, 3));
  return std::optional<Principal>(
      {row->text(0, 0), kind == TokenKind::script ? std::min(persons, own) : persons, kind, row->integer(0, 4)});
}

Result<void> revoke_all(PgConnection& connection, const std::string& user, TokenKind kind,
                        std::optional<std::int64_t> kept) {
  return run(connection,
             "UPDATE tokens SET revoked = now() WHERE user_name = $1 AND kind = $2 AND revoked IS NULL AND "
             "id IS DISTINCT FROM $3",
             Params().text(user).text(name(kind)).optional_integer(kept));
}

Result<void> put_password(PgConnection& connection, const std::string& user, const std::string& hash,
                          std::optional<std::int64_t> kept) {
  if (auto set = run(connection, "UPDATE users SET password = $2 WHERE name = $1", Params().text(user).text(hash));
      !set)
    return set;
  if (auto ended = revoke_all(connection, user, TokenKind::session, kept); !ended) return ended;
  return revoke_all(connection, user, TokenKind::invitation, {});
}

}  // namespace

Result<std::vector<Person>> Store::people() {
  return impl_->pool.read([&](PgConnection& connection) -> Result<std::vector<Person>> {
    auto rows =
        connection.query("SELECT " STRATA_PERSON_COLUMNS " FROM users WHERE deleted IS NULL ORDER BY lower(name)");
    if (!rows) return tl::unexpected(rows.error());
    std::vector<Person> people;
    for (int i = 0; i < rows->rows(); ++i) people.push_back(read_person(*rows, i));
    return people;
  });
}

Result<Person> Store::person(const std::string& name) {
  return impl_->pool.read([&](PgConnection& connection) { return load_person(connection, name); });
}

Result<Person> Store::create_person(const std::string& name, const std::string& full_name, Role role) {
  if (auto good = check_name(name); !good) return tl::unexpected(good.error());
  if (auto good = check_texts({{&full_name, "full_name"}}); !good) return tl::unexpected(good.error());
  if (name.starts_with(kFormer))
    return fail(409, "Name taken", "Names that begin with `former-` are kept for who is deleted. Choose another name.",
                "user");
  return impl_->pool.write([&](PgConnection& connection) -> Result<Person> {
    auto made = connection.query(
        "INSERT INTO users (name, full_name, role) VALUES ($1, $2, $3) ON CONFLICT DO NOTHING RETURNING id",
        Params().text(name).text(full_name).text(strata::name(role)));
    if (!made) return tl::unexpected(made.error());
    if (made->rows() == 0)
      return fail(409, "Name taken", "There is somebody called `" + name + "`. Choose another name.", "user");
    return load_person(connection, name);
  });
}

Result<Person> Store::update_person(const Person& person) {
  if (auto good = check_texts({{&person.full_name, "full_name"}}); !good) return tl::unexpected(good.error());
  return impl_->pool.write([&](PgConnection& connection) -> Result<Person> {
    auto done = connection.query(
        "UPDATE users SET full_name = $2, role = $3, disabled = CASE WHEN $4 THEN coalesce(disabled, now()) END "
        "WHERE id = $1 AND deleted IS NULL RETURNING name",
        Params().integer(person.id).text(person.full_name).text(strata::name(person.role)).boolean(person.disabled));
    if (!done) return tl::unexpected(done.error());
    if (done->rows() == 0) return not_found("person", person.name);
    if (person.disabled)
      if (auto ended = revoke_all(connection, done->text(0, 0), TokenKind::session, {}); !ended)
        return tl::unexpected(ended.error());
    return load_person(connection, done->text(0, 0));
  });
}

Result<void> Store::delete_person(const std::string& name) {
  return impl_->pool.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<void> {
    auto person = load_person(connection, name);
    if (!person) return tl::unexpected(person.error());
    const std::string former = std::string(kFormer) + std::to_string(person->id);
    auto ended = run(connection, "DELETE FROM tokens WHERE user_name = $1", Params().text(person->name));
    if (!ended) return ended;
    for (const char* sql :
         {"UPDATE users SET name = $2, full_name = '', password = NULL, deleted = now() WHERE name = $1",
          "UPDATE edits SET user_name = $2 WHERE user_name = $1",
          "UPDATE table_edits SET user_name = $2 WHERE user_name = $1",
          "UPDATE attachments SET user_name = $2 WHERE user_name = $1"})
      if (auto done = run(connection, sql, Params().text(person->name).text(former)); !done) return done;
    return {};
  });
}

Result<std::string> Store::password_of(const std::string& name) {
  if (!check_text(name, "user")) return std::string();
  return impl_->pool.read([&](PgConnection& connection) -> Result<std::string> {
    auto rows = connection.query(
        "SELECT password FROM users WHERE lower(name) = lower($1) AND disabled IS NULL AND deleted IS NULL AND "
        "password IS NOT NULL",
        Params().text(name));
    if (!rows) return tl::unexpected(rows.error());
    return rows->rows() == 0 ? std::string() : rows->text(0, 0);
  });
}

Result<void> Store::set_password(const std::string& name, const std::string& hash, std::optional<std::int64_t> kept) {
  return impl_->pool.write([&](PgConnection& connection) -> Result<void> {
    auto person = load_person(connection, name);
    if (!person) return tl::unexpected(person.error());
    return put_password(connection, person->name, hash, kept);
  });
}

Result<std::string> Store::create_token(TokenKind kind, const std::string& user, Role role,
                                        std::optional<std::chrono::seconds> lifetime, const std::string& label) {
  if (auto good = check_name(user); !good) return tl::unexpected(good.error());
  if (auto good = check_texts({{&label, "name"}}); !good) return tl::unexpected(good.error());
  return impl_->pool.write([&](PgConnection& connection) -> Result<std::string> {
    auto person = run(connection, "INSERT INTO users (name, role) VALUES ($1, $2) ON CONFLICT DO NOTHING",
                      Params().text(user).text(strata::name(role)));
    if (!person) return tl::unexpected(person.error());
    return insert_token(connection, kind, user, role, lifetime, label);
  });
}

Result<std::optional<Principal>> Store::find_token(const std::string& secret) {
  auto found = impl_->pool.read([&](PgConnection& connection) { return principal(connection, secret); });
  if (!found || !*found) return found;
  // That it was used is only remembered: whoever asks is let in also where nothing can be written.
  (void)impl_->pool.write([&](PgConnection& connection) {
    return run(connection,
               "UPDATE tokens SET last_used = now() WHERE id = $1 AND "
               "(last_used IS NULL OR last_used < now() - " STRATA_SOME_MINUTES ")",
               Params().integer((*found)->token));
  });
  return found;
}

Result<std::vector<Token>> Store::tokens(const std::string& user, TokenKind kind) {
  return impl_->pool.read([&](PgConnection& connection) -> Result<std::vector<Token>> {
    auto rows = connection.query(
        "SELECT id, label, role, created, expires, last_used FROM tokens WHERE user_name = $1 AND kind = $2 "
        "AND " STRATA_GOOD_TOKEN " ORDER BY id DESC",
        Params().text(user).text(name(kind)));
    if (!rows) return tl::unexpected(rows.error());
    std::vector<Token> tokens;
    for (int i = 0; i < rows->rows(); ++i) {
      Token& token = tokens.emplace_back();
      token.id = rows->integer(i, 0);
      token.kind = kind;
      token.label = rows->text(i, 1);
      token.role = parse_role(rows->text(i, 2)).value_or(Role::viewer);
      token.created = rows->time(i, 3);
      if (!rows->null(i, 4)) token.expires = rows->time(i, 4);
      if (!rows->null(i, 5)) token.last_used = rows->time(i, 5);
    }
    return tokens;
  });
}

Result<std::optional<std::string>> Store::redeem_owner_link(const std::string& link, std::chrono::seconds lifetime,
                                                            const std::string& label) {
  return impl_->pool.write([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    auto owner = principal(connection, link);
    if (!owner) return tl::unexpected(owner.error());
    if (!*owner || (*owner)->kind != TokenKind::owner_link) return std::optional<std::string>();
    auto secret = insert_token(connection, TokenKind::session, (*owner)->user, (*owner)->role, lifetime, label);
    if (!secret) return tl::unexpected(secret.error());
    return std::optional<std::string>(std::move(*secret));
  });
}

Result<std::optional<std::string>> Store::accept_invitation(const std::string& invitation, const std::string& hash,
                                                            const std::optional<std::string>& full_name,
                                                            std::chrono::seconds lifetime, const std::string& label) {
  if (full_name)
    if (auto good = check_texts({{&*full_name, "full_name"}}); !good) return tl::unexpected(good.error());
  return impl_->pool.write([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    // Of two who use it at once, one comes first.
    auto locked =
        connection.query("SELECT 1 FROM tokens WHERE hash = $1 FOR UPDATE", Params().bytes(sha256(invitation)));
    if (!locked) return tl::unexpected(locked.error());
    auto invited = principal(connection, invitation);
    if (!invited) return tl::unexpected(invited.error());
    if (!*invited || (*invited)->kind != TokenKind::invitation) return std::optional<std::string>();
    const std::string& user = (*invited)->user;
    if (auto set = put_password(connection, user, hash, {}); !set) return tl::unexpected(set.error());
    if (full_name) {
      auto named =
          run(connection, "UPDATE users SET full_name = $2 WHERE name = $1", Params().text(user).text(*full_name));
      if (!named) return tl::unexpected(named.error());
    }
    auto secret = insert_token(connection, TokenKind::session, user, (*invited)->role, lifetime, label);
    if (!secret) return tl::unexpected(secret.error());
    return std::optional<std::string>(std::move(*secret));
  });
}

Result<void> Store::revoke_token(const std::string& secret) {
  return impl_->pool.write([&](PgConnection& connection) {
    return run(connection, "UPDATE tokens SET revoked = now() WHERE hash = $1 AND revoked IS NULL",
               Params().bytes(sha256(secret)));
  });
}

Result<void> Store::revoke_token(const std::string& user, TokenKind kind, std::int64_t id) {
  return impl_->pool.write([&](PgConnection& connection) -> Result<void> {
    auto done = connection.query(
        "UPDATE tokens SET revoked = now() WHERE user_name = $1 AND kind = $2 AND id = $3 AND " STRATA_GOOD_TOKEN
        " RETURNING id",
        Params().text(user).text(name(kind)).integer(id));
    if (!done) return tl::unexpected(done.error());
    if (done->rows() == 0) return not_found(kind == TokenKind::session ? "session" : "token", std::to_string(id));
    return {};
  });
}

Result<void> Store::revoke_tokens(const std::string& user, TokenKind kind, std::optional<std::int64_t> kept) {
  return impl_->pool.write([&](PgConnection& connection) { return revoke_all(connection, user, kind, kept); });
}

}  // namespace strata::store
