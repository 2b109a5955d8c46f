#include "store/people/sign_ons.h"

#include <algorithm>

#include "core/digest.h"
#include "core/text/ascii.h"
#include "core/text/search_text.h"
#include "core/text/utf8.h"
#include "store/people/groups.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

// A sign-in locks the sign-on first, then groups in the order of their ids, and then the user, as
// changes to groups do (store/people/groups.cpp).

namespace strata::store {
namespace {

constexpr std::string_view kUser = "user", kFormer = "former-";
constexpr std::size_t kMaxUserName = 64, kMaxFullName = 200, kMaxIdentity = 255;
constexpr int kMaxNames = 1000;  // names to try for a new account

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

std::string displayable(const std::string& name) {
  std::string shown(first_bytes(mended_utf8(name), kMaxFullName));
  std::ranges::replace_if(
      shown, [](char c) { return c >= 0 && c < ' '; }, ' ');
  return std::string(trimmed(shown));
}

Result<void> check_identity(const std::string& issuer, const std::string& subject) {
  STRATA_TRY(check_texts({{&issuer, "issuer"}, {&subject, "subject"}}));
  for (const auto& [text, field] : {std::pair{&issuer, "issuer"}, std::pair{&subject, "subject"}})
    if (text->empty() || text->size() > kMaxIdentity)
      return fail(ErrorCode::invalid, "Invalid identity",
                  "The issuer and the subject must have 1 to 255 bytes.", field);
  return {};
}

// Lets one transaction at a time create the account of an identity.
Result<void> lock_identity(PgConnection& connection, const std::string& issuer,
                           const std::string& subject) {
  STRATA_TRY(connection.query(
      "SELECT pg_advisory_xact_lock(hashtextextended('strata.sign_on ' || $1 || ' ' || $2, 0))",
      Params().text(issuer).text(subject)));
  return {};
}

struct Binding {
  std::int64_t id = 0;
  std::string user;
};

Result<std::optional<Binding>> find_binding(PgConnection& connection, const std::string& issuer,
                                            const std::string& subject) {
  const auto rows = STRATA_TRY(connection.query(
      "SELECT s.id, u.name FROM sign_ons s JOIN users u ON u.id = s.user_id WHERE s.issuer = $1 AND s.subject = $2",
      Params().text(issuer).text(subject)));
  if (rows.rows() == 0) return std::optional<Binding>();
  return std::optional(Binding{rows.integer(0, 0), rows.text(0, 1)});
}

Result<Binding> insert_binding(PgConnection& connection, const std::string& issuer,
                               const std::string& subject, const std::string& user) {
  const auto made = STRATA_TRY(connection.query(
      "INSERT INTO sign_ons (issuer, subject, user_id) SELECT $1, $2, id FROM users WHERE name = $3 RETURNING id",
      Params().text(issuer).text(subject).text(user)));
  return Binding{made.integer(0, 0), user};
}

// Creates an account with the first free name of NAME, NAME-2, NAME-3…
Result<std::string> create_account(PgConnection& connection, const SignOn& sign_on) {
  const std::string wanted = user_name_from(sign_on.name);
  for (int n = 1; n <= kMaxNames; ++n) {
    const std::string suffix = n == 1 ? std::string() : "-" + std::to_string(n);
    const std::string name = wanted.substr(0, kMaxUserName - suffix.size()) + suffix;
    const auto made = STRATA_TRY(connection.query(
        "INSERT INTO users (name, full_name, role) VALUES ($1, $2, $3) ON CONFLICT DO NOTHING RETURNING id",
        Params()
            .text(name)
            .text(displayable(sign_on.full_name))
            .text(strata::name(sign_on.role.value_or(sign_on.new_role)))));
    if (made.rows() > 0) return name;
  }
  return fail(ErrorCode::conflict, "Name already used",
              "There are too many people with a user name like `" + wanted + "`.", "user");
}

struct LockedGroup {
  GroupId id = 0;
  bool wanted = false;
};

// Locks the groups that the claims name, and the groups that earlier claims gave.
Result<std::vector<LockedGroup>> lock_groups(PgConnection& connection, std::int64_t sign_on_id,
                                             const std::vector<std::string>& names,
                                             std::vector<std::string>& unknown) {
  PgArray wanted(oid::kText);
  for (const std::string& name : names)
    if (check_text(name, "groups")) wanted.add(std::string_view(name));
  const auto rows = STRATA_TRY(connection.query(
      "SELECT g.id, lower(g.name) IN (SELECT lower(n) FROM unnest($1) n) FROM groups g "
      "WHERE lower(g.name) IN (SELECT lower(n) FROM unnest($1) n) "
      "OR g.id IN (SELECT p.group_id FROM group_people p WHERE p.sign_on_id = $2) "
      "ORDER BY g.id FOR UPDATE OF g",
      Params().array(wanted).integer(sign_on_id)));
  std::vector<LockedGroup> groups;
  for (int i = 0; i < rows.rows(); ++i)
    groups.push_back({rows.id<GroupId>(i, 0), rows.boolean(i, 1)});
  const auto missing = STRATA_TRY(connection.query(
      "SELECT DISTINCT n FROM unnest($1) n WHERE NOT EXISTS (SELECT 1 FROM groups g WHERE lower(g.name) = lower(n))",
      Params().array(wanted)));
  for (int i = 0; i < missing.rows(); ++i) unknown.push_back(missing.text(i, 0));
  return groups;
}

// Updates the memberships that come from the claims of this sign-on.
Result<void> update_groups(PgConnection& connection, std::int64_t sign_on_id, PersonId person,
                           const std::vector<LockedGroup>& groups, SignedOn& result) {
  for (const LockedGroup& group : groups) {
    if (!group.wanted) {
      const auto gone = STRATA_TRY(connection.query(
          "DELETE FROM group_people WHERE group_id = $1 AND user_id = $2 AND sign_on_id = $3 RETURNING 1",
          Params().id(group.id).id(person).integer(sign_on_id)));
      result.changed = result.changed || gone.rows() > 0;
      continue;
    }
    const auto put = STRATA_TRY(connection.query(
        "INSERT INTO group_people (group_id, user_id, sign_on_id) SELECT $1, $2, $3 "
        "WHERE (SELECT count(*) FROM group_people WHERE group_id = $1) < $4 ON CONFLICT DO NOTHING RETURNING 1",
        Params().id(group.id).id(person).integer(sign_on_id).integer(Groups::kMaxPeople)));
    result.changed = result.changed || put.rows() > 0;
    if (put.rows() > 0) continue;
    const auto full = STRATA_TRY(
        connection.query("SELECT g.name FROM groups g WHERE g.id = $1 AND NOT EXISTS "
                         "(SELECT 1 FROM group_people WHERE group_id = $1 AND user_id = $2)",
                         Params().id(group.id).id(person)));
    if (full.rows() > 0) result.skipped_groups.push_back(full.text(0, 0));
  }
  return {};
}

Result<void> update_role(PgConnection& connection, const SignOn& sign_on, Person& person,
                         SignedOn& result) {
  if (!sign_on.role || person.role == Role::owner || person.role == *sign_on.role) return {};
  STRATA_TRY(connection.query("UPDATE users SET role = $2 WHERE id = $1",
                              Params().id(person.id).text(strata::name(*sign_on.role))));
  person.role = *sign_on.role;
  result.changed = true;
  return {};
}

}  // namespace

std::string user_name_from(const std::string& name) {
  const bool is_ascii =
      std::ranges::all_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  std::string made;
  for (const char c : is_ascii ? name : search_text(name)) {
    if (is_plain(c) || (!made.empty() && std::string_view("._@").find(c) != std::string_view::npos))
      made += c;
    else if (!made.empty() && made.back() != '-')
      made += '-';
    if (made.size() == kMaxUserName) break;
  }
  while (made.ends_with('-')) made.pop_back();
  if (made.empty()) return std::string(kUser);
  // These names are reserved for deleted accounts.
  if (to_lower(made).starts_with(kFormer))
    made = (std::string(kUser) + "-" + made).substr(0, kMaxUserName);
  return made;
}

Result<void> SignOns::begin(const std::string& state, const std::string& browser,
                            const PendingSignIn& pending, std::chrono::seconds lifetime) {
  STRATA_TRY(check_texts({{&pending.return_to, "return_to"}}));
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    // If very many sign-ins wait, somebody may be attacking the server. Therefore, the oldest
    // sign-ins are removed.
    STRATA_TRY(
        connection.query("DELETE FROM pending_sign_ins WHERE expires <= now() OR state IN "
                         "(SELECT state FROM pending_sign_ins ORDER BY expires DESC OFFSET $1)",
                         Params().integer(kMaxPending - 1)));
    const Sha256 state_hash = sha256(state), browser_hash = sha256(browser);
    const auto made = STRATA_TRY(connection.query(
        "INSERT INTO pending_sign_ins (state, browser, provider, nonce, code_verifier, return_to, expires) "
        "SELECT $1, $2, $3, $4, $5, $6, now() + $7 * interval '1 second' "
        "WHERE (SELECT count(*) FROM pending_sign_ins) < $8 RETURNING 1",
        Params()
            .bytes(state_hash)
            .bytes(browser_hash)
            .text(pending.provider)
            .text(pending.nonce)
            .text(pending.code_verifier)
            .text(pending.return_to)
            .integer(lifetime.count())
            .integer(kMaxPending)));
    if (made.rows() > 0) return {};
    return fail(ErrorCode::busy, "Too many sign-ins",
                "Too many people are signing in. Try again in a few minutes.");
  });
}

Result<std::optional<PendingSignIn>> SignOns::take(const std::string& state,
                                                   const std::string& browser) {
  return pool_.write([&](PgConnection& connection) -> Result<std::optional<PendingSignIn>> {
    const Sha256 state_hash = sha256(state), browser_hash = sha256(browser);
    const auto rows = STRATA_TRY(connection.query(
        "DELETE FROM pending_sign_ins WHERE state = $1 AND browser = $2 AND expires > now() "
        "RETURNING provider, nonce, code_verifier, return_to",
        Params().bytes(state_hash).bytes(browser_hash)));
    if (rows.rows() == 0) return std::optional<PendingSignIn>();
    PgRow row(rows, 0);
    PendingSignIn pending;
    pending.provider = row.text();
    pending.nonce = row.text();
    pending.code_verifier = row.text();
    pending.return_to = row.text();
    return std::optional(std::move(pending));
  });
}

Result<SignedOn> SignOns::sign_in(const SignOn& sign_on, std::chrono::seconds lifetime,
                                  const std::string& label) {
  STRATA_TRY(check_identity(sign_on.issuer, sign_on.subject));
  STRATA_TRY(check_texts({{&label, "name"}}));
  return pool_.write([&](PgConnection& connection) -> Result<SignedOn> {
    SignedOn result;
    STRATA_TRY(lock_identity(connection, sign_on.issuer, sign_on.subject));
    auto binding = STRATA_TRY(find_binding(connection, sign_on.issuer, sign_on.subject));
    if (!binding) {
      if (!sign_on.may_create) return result;
      const std::string user = STRATA_TRY(create_account(connection, sign_on));
      binding = STRATA_TRY(insert_binding(connection, sign_on.issuer, sign_on.subject, user));
    }
    result.user = binding->user;
    const auto groups =
        STRATA_TRY(lock_groups(connection, binding->id, sign_on.groups, result.skipped_groups));
    auto person = STRATA_TRY(lock_person(connection, binding->user));
    // While this transaction waited, an administrator may have deleted the account and created
    // another one of this name.
    const auto again = STRATA_TRY(find_binding(connection, sign_on.issuer, sign_on.subject));
    if (!again || again->id != binding->id || again->user != person.name)
      return fail(ErrorCode::busy, "Account was changed",
                  "The account was changed during the sign-in. Sign in again.");
    if (person.disabled) {
      result.outcome = SignedOn::Outcome::disabled;
      return result;
    }
    STRATA_TRY(update_role(connection, sign_on, person, result));
    STRATA_TRY(update_groups(connection, binding->id, person.id, groups, result));
    STRATA_TRY(connection.query(
        "UPDATE sign_ons SET first_used = coalesce(first_used, now()), last_used = now() WHERE id = $1",
        Params().integer(binding->id)));
    auto session = STRATA_TRY(open_session(connection, person, lifetime, label));
    result.session = std::move(session.secret);
    result.outcome = SignedOn::Outcome::signed_in;
    return result;
  });
}

Result<void> SignOns::bind(const std::string& user, const std::string& issuer,
                           const std::string& subject) {
  STRATA_TRY(check_identity(issuer, subject));
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(lock_identity(connection, issuer, subject));
    const auto person = STRATA_TRY(lock_person(connection, user));
    const auto bound = STRATA_TRY(find_binding(connection, issuer, subject));
    if (bound && bound->user == person.name) return {};
    if (bound)
      return fail(ErrorCode::conflict, "Identity already used",
                  "This identity belongs to the account `" + bound->user + "`.", "subject");
    STRATA_TRY(insert_binding(connection, issuer, subject, person.name));
    return {};
  });
}

}  // namespace strata::store
