#include "store/hash.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

std::string_view kind_name(Store::TokenKind kind) {
  switch (kind) {
    case Store::TokenKind::session: return "session";
    case Store::TokenKind::script: return "script";
    default: return "owner_link";
  }
}

Store::TokenKind parse_kind(const std::string& name) {
  if (name == "session") return Store::TokenKind::session;
  return name == "script" ? Store::TokenKind::script : Store::TokenKind::owner_link;
}

Result<std::string> insert_token(PgConnection& connection, Store::TokenKind kind, const std::string& user,
                                 const std::string& role, std::optional<std::chrono::seconds> lifetime) {
  const std::string token = random_token();
  std::optional<Time> expires;
  if (lifetime) expires = std::chrono::system_clock::now() + *lifetime;
  auto person = connection.query("INSERT INTO users (name, role) VALUES ($1, $2) ON CONFLICT (name) DO NOTHING",
                                 Params().text(user).text(role));
  if (!person) return tl::unexpected(person.error());
  auto row = connection.query("INSERT INTO tokens (hash, kind, user_name, role, expires) VALUES ($1, $2, $3, $4, $5)",
                              Params().bytes(sha256(token)).text(kind_name(kind)).text(user).text(role).time(expires));
  if (!row) return tl::unexpected(row.error());
  return token;
}

Result<std::optional<Store::Principal>> principal(PgConnection& connection, const std::string& token) {
  auto row = connection.query(
      "SELECT user_name, role, kind FROM tokens WHERE hash = $1 AND revoked IS NULL "
      "AND (expires IS NULL OR expires > now())",
      Params().bytes(sha256(token)));
  if (!row) return tl::unexpected(row.error());
  if (row->rows() == 0) return std::optional<Store::Principal>();
  return std::optional<Store::Principal>({row->text(0, 0), row->text(0, 1), parse_kind(row->text(0, 2))});
}

}  // namespace

Result<std::string> Store::create_token(TokenKind kind, const std::string& user, const std::string& role,
                                        std::optional<std::chrono::seconds> lifetime) {
  if (auto good = check_name(user); !good) return tl::unexpected(good.error());
  if (auto good = check_text(role, "role"); !good) return tl::unexpected(good.error());
  return impl_->pool.write(
      [&](PgConnection& connection) { return insert_token(connection, kind, user, role, lifetime); });
}

Result<std::optional<Store::Principal>> Store::find_token(const std::string& token) {
  return impl_->pool.read([&](PgConnection& connection) { return principal(connection, token); });
}

Result<std::optional<std::string>> Store::redeem_owner_link(const std::string& link, std::chrono::seconds lifetime) {
  return impl_->pool.write([&](PgConnection& connection) -> Result<std::optional<std::string>> {
    auto owner = principal(connection, link);
    if (!owner) return tl::unexpected(owner.error());
    if (!*owner || (*owner)->kind != TokenKind::owner_link) return std::optional<std::string>();
    auto token = insert_token(connection, TokenKind::session, (*owner)->user, (*owner)->role, lifetime);
    if (!token) return tl::unexpected(token.error());
    return std::optional<std::string>(std::move(*token));
  });
}

Result<void> Store::revoke_token(const std::string& token) {
  return impl_->pool.write([&](PgConnection& connection) -> Result<void> {
    auto done = connection.query("UPDATE tokens SET revoked = now() WHERE hash = $1 AND revoked IS NULL",
                                 Params().bytes(sha256(token)));
    return done ? Result<void>{} : tl::unexpected(done.error());
  });
}

}  // namespace strata::store
