#include "store/people/audit.h"

#include <limits>

#include "core/text/utf8.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr int kPurgedAtOnce = 2000;
constexpr std::size_t kMaxTriedName = 1024;  // the database shortens it to 255 bytes

// This query is planned for each call, because the best index depends on the filters.
constexpr const char* kRows =
    "SELECT a.id, a.time, a.actor_kind, a.actor, a.person_id, a.address, a.action, a.subject_kind, a.subject_id, "
    "a.subject, a.project_id, coalesce(p.slug::text, ''), a.count, a.details "
    "FROM audit_log a LEFT JOIN projects p ON p.id = a.project_id "
    "WHERE ($1 = '' OR lower(a.actor) = lower($1)) AND ($2 = '' OR a.action = $2) "
    "AND ($3 = '' OR a.subject_kind = $3) AND ($4::text IS NULL OR a.time >= $4::timestamptz) "
    "AND ($5::text IS NULL OR a.time < $5::timestamptz) AND ($6::bigint IS NULL OR a.project_id = $6) AND a.id < $7 "
    "ORDER BY a.id DESC LIMIT $8";

AuditRow read_audit_row(const PgResult& rows, int i) {
  PgRow row(rows, i);
  AuditRow found;
  found.id = row.integer();
  found.time = row.time();
  found.actor_kind = row.text();
  found.actor = row.text();
  found.person = row.id<std::optional<PersonId>>();
  found.address = row.text();
  found.action = row.text();
  found.subject_kind = row.text();
  found.subject_id = row.optional_integer();
  found.subject = row.text();
  found.project = row.id<std::optional<ProjectId>>();
  found.project_slug = row.text();
  found.count = row.integer();
  found.details = row.json();
  return found;
}

// Replaces text that PostgreSQL cannot store: invalid UTF-8 and U+0000.
std::string storable(std::string_view text) {
  std::string mended = mended_utf8(text.substr(0, kMaxTriedName));
  for (char& c : mended)
    if (c == '\0') c = ' ';
  return mended;
}

}  // namespace

Result<void> Audit::exported(const AuditExport& data) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(connection.query("SELECT audit('export', $1, $2, $3, $4, $5)",
                                Params()
                                    .text(data.kind)
                                    .optional_integer(data.id)
                                    .text(storable(data.file))
                                    .optional_id(data.project)
                                    .json(data.details)));
    return {};
  });
}

Result<void> Audit::failed_sign_in(std::string_view name, std::string_view way) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(connection.query("SELECT audit_failed_sign_in($1, $2)",
                                Params().text(storable(name)).text(way)));
    return {};
  });
}

Result<std::vector<AuditRow>> Audit::rows(const AuditQuery& query) {
  // No row contains text that PostgreSQL cannot store.
  for (const std::string* text : {&query.actor, &query.action, &query.subject_kind})
    if (!check_text(*text, {})) return std::vector<AuditRow>();
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<AuditRow>> {
    const auto rows = STRATA_TRY(connection.query_once(
        kRows, Params()
                   .text(query.actor)
                   .text(query.action)
                   .text(query.subject_kind)
                   .optional_text(query.from)
                   .optional_text(query.to)
                   .optional_id(query.project)
                   .integer(query.before.value_or(std::numeric_limits<std::int64_t>::max()))
                   .integer(query.limit)));
    std::vector<AuditRow> found;
    for (int i = 0; i < rows.rows(); ++i) found.push_back(read_audit_row(rows, i));
    return found;
  });
}

Result<bool> Audit::purge_some(std::chrono::days keep) {
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<bool> {
    const auto deleted =
        STRATA_TRY(connection.query("SELECT audit_purge($1::integer, $2::integer)",
                                    Params().integer(keep.count()).integer(kPurgedAtOnce)));
    return deleted.integer(0, 0) >= kPurgedAtOnce;
  });
}

}  // namespace strata::store
