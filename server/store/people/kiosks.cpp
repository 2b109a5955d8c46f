#include "store/people/kiosks.h"

#include "core/digest.h"
#include "core/secret.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kKiosks = sql(
    "SELECT k.id, k.name, t.id, m.id, p.id, t.slug, t.name, m.slug, m.name, p.slug, k.user_name, k.created, "
    "k.expires, k.last_seen, k.revoked, k.wants_reload, k.phone FROM kiosks k JOIN tours t ON t.id = k.tour_id "
    "JOIN models m ON m.id = t.model_id JOIN projects p ON p.id = m.project_id ");
constexpr auto kGoodKiosk = sql("(k.revoked IS NULL AND (k.expires IS NULL OR k.expires > now()))");
// Links that ended over 30 days ago are not listed. The next new link deletes them.
constexpr auto kListedKiosk = sql(
    "(least(k.revoked, k.expires) IS NULL OR least(k.revoked, k.expires) > now() - interval '30 days')");

Kiosk read_kiosk(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Kiosk kiosk;
  kiosk.id = row.id<KioskId>();
  kiosk.name = row.text();
  kiosk.tour_id = row.id<NamedPartId>();
  kiosk.model_id = row.id<ModelId>();
  kiosk.project_id = row.id<ProjectId>();
  kiosk.tour = row.text();
  kiosk.tour_name = row.text();
  kiosk.model = row.text();
  kiosk.model_name = row.text();
  kiosk.project = row.text();
  kiosk.user = row.text();
  kiosk.created = row.time();
  kiosk.expires = row.optional_time();
  kiosk.last_seen = row.optional_time();
  kiosk.revoked = row.optional_time();
  kiosk.wants_reload = row.boolean();
  kiosk.phone = row.optional_text().value_or(std::string());
  return kiosk;
}

Result<Kiosk> load(PgConnection& connection, KioskId id) {
  auto rows = STRATA_TRY(connection.query(sql(kKiosks, "WHERE k.id = $1"), Params().id(id)));
  if (rows.rows() == 0) return no_such("kiosk", to_string(id));
  return read_kiosk(rows, 0);
}

// Returns the kiosk after a change, or a `conflict` error if the link was not valid.
Result<Kiosk> changed(PgConnection& connection, KioskId id, const PgResult& done) {
  auto kiosk = load(connection, id);
  if (kiosk && done.affected() == 0)
    return fail(ErrorCode::conflict, "Link is not valid",
                "The link of this kiosk was revoked or has expired. Create a new link.");
  return kiosk;
}

}  // namespace

Result<Kiosks::Page> Kiosks::all(const std::optional<std::vector<ProjectId>>& projects, int limit,
                                 int offset, std::int64_t after) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    PgArray ids(oid::kInt8);
    if (projects)
      for (const ProjectId project : *projects) ids.add(project);
    auto total = STRATA_TRY(connection.query(
        sql("SELECT count(*) FROM kiosks k JOIN tours t ON t.id = k.tour_id JOIN models m ON m.id = t.model_id "
            "WHERE ($1 OR m.project_id = any($2)) AND ",
            kListedKiosk),
        Params().boolean(!projects).array(ids)));
    auto rows = STRATA_TRY(connection.query(
        sql(kKiosks, "WHERE ($1 OR p.id = any($2)) AND ", kListedKiosk,
            " AND k.id > $5 ORDER BY k.id LIMIT $3 OFFSET $4"),
        Params().boolean(!projects).array(ids).integer(limit).integer(offset).integer(after)));
    Page page;
    page.total = total.integer(0, 0);
    for (int i = 0; i < rows.rows(); ++i) page.kiosks.push_back(read_kiosk(rows, i));
    return page;
  });
}

Result<Kiosk> Kiosks::kiosk(KioskId id) {
  return pool_.read([&](PgConnection& connection) { return load(connection, id); });
}

Result<std::vector<KioskId>> Kiosks::of_tour(NamedPartId tour_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<KioskId>> {
    auto rows = connection.query("SELECT id FROM kiosks WHERE tour_id = $1", Params().id(tour_id));
    if (!rows) return tl::unexpected(rows.error());
    std::vector<KioskId> ids;
    for (int i = 0; i < rows->rows(); ++i) ids.push_back(rows->id<KioskId>(i, 0));
    return ids;
  });
}

Result<NewKiosk> Kiosks::create(NamedPartId tour_id, const std::string& name,
                                const std::string& user,
                                std::optional<std::chrono::seconds> lifetime, bool phones) {
  STRATA_TRY(check_name(name));
  STRATA_TRY(check_texts({{&user, "user"}}));
  return pool_.write([&](PgConnection& connection) -> Result<NewKiosk> {
    // Lock the tour, so that concurrent transactions cannot exceed the limit together.
    auto tour = STRATA_TRY(connection.query("SELECT 1 FROM tours WHERE id = $1 FOR NO KEY UPDATE",
                                            Params().id(tour_id)));
    if (tour.rows() == 0) return no_such("tour", to_string(tour_id));
    auto cleared =
        connection.query(sql("DELETE FROM kiosks k WHERE k.tour_id = $1 AND NOT ", kListedKiosk),
                         Params().id(tour_id));
    if (!cleared) return tl::unexpected(cleared.error());
    auto count = STRATA_TRY(
        connection.query(sql("SELECT count(*) FROM kiosks k WHERE k.tour_id = $1 AND ", kGoodKiosk),
                         Params().id(tour_id)));
    if (count.integer(0, 0) >= kMaxKiosks)
      return fail(ErrorCode::conflict, "Too many kiosks",
                  "A tour can have links for at most " + std::to_string(kMaxKiosks) +
                      " kiosks. Revoke some links first.");
    NewKiosk made;
    made.secret = random_token();
    std::optional<Time> expires;
    if (lifetime) expires = std::chrono::system_clock::now() + *lifetime;
    const Sha256 hash = sha256(made.secret);
    auto row = STRATA_TRY(connection.query(
        "INSERT INTO kiosks (tour_id, hash, name, user_name, expires, phone) VALUES ($1, $2, $3, $4, $5, $6) RETURNING id",
        Params().id(tour_id).bytes(hash).text(name).text(user).time(expires).optional_text(
            phones ? std::optional(random_token()) : std::nullopt)));
    auto kiosk = STRATA_TRY(load(connection, row.id<KioskId>(0, 0)));
    made.kiosk = std::move(kiosk);
    return made;
  });
}

Result<std::optional<Kiosk>> Kiosks::find(const std::string& secret) {
  return pool_.read([&](PgConnection& connection) -> Result<std::optional<Kiosk>> {
    const Sha256 hash = sha256(secret);
    auto rows = STRATA_TRY(
        connection.query(sql(kKiosks, "WHERE (k.hash = $1 OR k.phone = $2) AND ", kGoodKiosk),
                         Params().bytes(hash).text(secret)));
    if (rows.rows() == 0) return std::optional<Kiosk>();
    Kiosk kiosk = read_kiosk(rows, 0);
    kiosk.is_phone = kiosk.phone == secret;
    return std::optional(std::move(kiosk));
  });
}

Result<void> Kiosks::seen(KioskId id, bool loaded) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto done = connection.query(
        "UPDATE kiosks SET last_seen = now(), wants_reload = wants_reload AND NOT $2 WHERE id = $1 AND "
        "(last_seen IS NULL OR last_seen < now() - interval '1 minute' OR (wants_reload AND $2))",
        Params().id(id).boolean(loaded));
    return done ? Result<void>() : tl::unexpected(done.error());
  });
}

Result<void> Kiosks::revoke(KioskId id) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto done = STRATA_TRY(connection.query(
        "UPDATE kiosks SET revoked = coalesce(revoked, now()), wants_reload = false WHERE id = $1",
        Params().id(id)));
    if (done.affected() == 0) return no_such("kiosk", to_string(id));
    return {};
  });
}

Result<Kiosk> Kiosks::ask_reload(KioskId id) {
  return pool_.write([&](PgConnection& connection) -> Result<Kiosk> {
    auto done = STRATA_TRY(connection.query(
        sql("UPDATE kiosks k SET wants_reload = true WHERE k.id = $1 AND ", kGoodKiosk),
        Params().id(id)));
    return changed(connection, id, done);
  });
}

Result<Kiosk> Kiosks::allow_phones(KioskId id, bool allowed) {
  const auto phone = allowed ? std::optional(random_token()) : std::nullopt;
  return pool_.write([&](PgConnection& connection) -> Result<Kiosk> {
    // A link that is already on keeps its secret, so phones that use it stay connected.
    auto done = STRATA_TRY(connection.query(
        sql("UPDATE kiosks k SET phone = CASE WHEN $2::text IS NULL THEN NULL ELSE coalesce(k.phone, $2) END "
            "WHERE k.id = $1 AND ",
            kGoodKiosk),
        Params().id(id).optional_text(phone)));
    return changed(connection, id, done);
  });
}

}  // namespace strata::store
