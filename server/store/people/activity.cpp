#include "store/people/activity.h"

#include <limits>

#include "store/content/projects.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// Of what is about a layer, or in a thread about one: to whoever sees that layer, in the Trash or
// not, or saw it when it was erased.
#define STRATA_ACTIVITY_IS_SEEN                                                                                          \
  "coalesce((SELECT l.visibility FROM all_layers l WHERE l.id = activities.layer_id), activities.visibility) = any($6) " \
  "AND (activities.comment_id IS NULL OR (SELECT coalesce(l.visibility, f.visibility) FROM comments c JOIN comments "    \
  "f ON f.id = coalesce(c.thread_id, c.id) LEFT JOIN all_layers l ON l.id = f.layer_id "                                 \
  "WHERE c.id = activities.comment_id) = any($6))"
// The page is found first, by indexes alone; what its lines are about is looked up for those.
#define STRATA_ACTIVITY_LINES(asked)                                                     \
  "(SELECT * FROM activities WHERE " asked                                               \
  " AND (time, id) < (timestamptz 'epoch' + $2 * interval '1 microsecond', $3::bigint) " \
  "AND ($4 OR kind <> 'member') AND " STRATA_ACTIVITY_IS_SEEN                            \
  " ORDER BY time DESC, id DESC LIMIT $5)"
#define STRATA_ACTIVITY_PAGE(lines)                                                                                  \
  "SELECT a.id, a.time, a.begun, a.user_name, a.kind, a.op, coalesce(l.name, t.name, CASE WHEN a.kind = 'model' "    \
  "THEN m.name END, a.subject), m.id, l.id, t.id, c.id, m.name, a.record_key, left(c.text, 200), a.person, a.role, " \
  "a.count, a.texels, a.area_m2, to_jsonb(a.changed), (extract(epoch FROM a.time) * 1000000)::bigint, "              \
  "a.group_name FROM "                                                                                               \
  "(" lines                                                                                                          \
  ") a LEFT JOIN models m ON m.id = a.model_id LEFT JOIN layers l ON l.id = a.layer_id "                             \
  "LEFT JOIN record_tables t ON t.id = a.table_id LEFT JOIN comments c ON c.id = a.comment_id "                      \
  "ORDER BY a.time DESC, a.id DESC"
// Of the model, and of each table whose records lie on it.
#define STRATA_ACTIVITY_OF_MODEL \
  "SELECT * FROM (" STRATA_ACTIVITY_LINES(                                                                \
      "model_id = $1") " UNION ALL SELECT of_table.* FROM (SELECT DISTINCT table_id FROM layers "         \
                       "WHERE model_id = $1 AND table_id IS NOT NULL) on_it CROSS JOIN LATERAL "          \
                       STRATA_ACTIVITY_LINES("activities.table_id = on_it.table_id") " of_table) found "  \
  "ORDER BY time DESC, id DESC LIMIT $5"

// the year 2286
constexpr ActivityPlace kAfterAll{9'999'999'999'999'999, std::numeric_limits<std::int64_t>::max()};

std::optional<std::int64_t> integer_at(const PgResult& rows, int row, int column) {
  return rows.null(row, column) ? std::nullopt : std::optional(rows.integer(row, column));
}
std::string text_at(const PgResult& rows, int row, int column) {
  return rows.null(row, column) ? std::string() : rows.text(row, column);
}

Activity read_line(const PgResult& rows, int i) {
  Activity line;
  line.id = rows.integer(i, 0);
  line.time = rows.time(i, 1);
  line.begun = rows.time(i, 2);
  line.user = rows.text(i, 3);
  line.kind = rows.text(i, 4);
  line.op = rows.text(i, 5);
  line.name = rows.text(i, 6);
  line.model = rows.id<std::optional<ModelId>>(i, 7);
  line.layer = rows.id<std::optional<LayerId>>(i, 8);
  line.table = rows.id<std::optional<TableId>>(i, 9);
  line.comment = rows.id<std::optional<CommentId>>(i, 10);
  line.model_name = text_at(rows, i, 11);
  if (line.table) line.record = integer_at(rows, i, 12);
  line.text = text_at(rows, i, 13);
  line.person = text_at(rows, i, 14);
  line.role = text_at(rows, i, 15);
  line.group = text_at(rows, i, 21);
  line.count = rows.integer(i, 16);
  line.texels = integer_at(rows, i, 17);
  if (!rows.null(i, 18)) line.area_m2 = rows.real(i, 18);
  if (!rows.null(i, 19)) line.changed = rows.json(i, 19).get<std::vector<std::string>>();
  return line;
}

}  // namespace

Result<ActivityPage> Projects::activity(ProjectId project_id, Role seen_by,
                                        const ActivityQuery& query) {
  return pool_.read([&](PgConnection& connection) -> Result<ActivityPage> {
    const ActivityPlace before = query.before.value_or(kAfterAll);
    const int limit = std::max(query.limit, 1);
    Params params;
    params.integer(query.model ? query.model->number() : project_id.number())
        .integer(before.time_us)
        .integer(before.id)
        .boolean(query.with_members)
        .integer(limit + 1)  // one more tells whether there is a next page
        .array(visibilities_seen_by(seen_by));
    auto rows = STRATA_TRY(connection.query(
        query.model ? STRATA_ACTIVITY_PAGE(STRATA_ACTIVITY_OF_MODEL)
                    : STRATA_ACTIVITY_PAGE(STRATA_ACTIVITY_LINES("project_id = $1")),
        params));
    ActivityPage page;
    for (int i = 0; i < std::min(rows.rows(), limit); ++i) page.lines.push_back(read_line(rows, i));
    if (rows.rows() > limit)
      page.next = ActivityPlace{rows.integer(limit - 1, 20), page.lines.back().id};
    return page;
  });
}

Result<void> act_as(PgConnection& connection, const std::string& user) {
  if (user.empty()) return {};
  auto set = connection.query("SELECT set_config('strata.user', $1, true)", Params().text(user));
  return set ? Result<void>{} : tl::unexpected(set.error());
}

Result<void> rename_in_activity(PgConnection& connection, const std::string& name,
                                const std::string& former) {
  for (const char* sql : {"UPDATE activities SET user_name = $2 WHERE user_name = $1",
                          "UPDATE activities SET person = $2 WHERE person = $1"})
    STRATA_TRY(connection.query(sql, Params().text(name).text(former)));
  return {};
}

}  // namespace strata::store
