#include "store/people/activity.h"

#include <limits>

#include "store/content/projects.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// A line about a layer, or in a thread about a layer, is visible to users who see that layer or who
// saw it when it was erased. The layer may be in the Trash.
constexpr auto kActivityIsSeen = sql(
    "coalesce((SELECT l.visibility FROM all_layers l WHERE l.id = activities.layer_id), activities.visibility) = any($6) "
    "AND (activities.comment_id IS NULL OR (SELECT coalesce(l.visibility, f.visibility) FROM comments c JOIN comments "
    "f ON f.id = coalesce(c.thread_id, c.id) LEFT JOIN all_layers l ON l.id = f.layer_id "
    "WHERE c.id = activities.comment_id) = any($6))");
// Finds the page first, which needs only indexes, and then looks up the objects of its lines.
consteval auto activity_lines(const auto& condition) {
  return sql("(SELECT * FROM activities WHERE ", condition,
             " AND (time, id) < (timestamptz 'epoch' + $2 * interval '1 microsecond', $3::bigint) "
             "AND ($4 OR kind <> 'member') AND ",
             kActivityIsSeen, " ORDER BY time DESC, id DESC LIMIT $5)");
}
consteval auto activity_page(const auto& lines) {
  return sql(
      "SELECT a.id, a.time, a.begun, a.user_name, a.kind, a.op, coalesce(l.name, t.name, CASE WHEN a.kind = 'model' "
      "THEN m.name END, a.subject), m.id, l.id, t.id, c.id, m.name, a.record_key, left(c.text, 200), a.person, a.role, "
      "a.group_name, a.count, a.texels, a.area_m2, to_jsonb(a.changed), "
      "(extract(epoch FROM a.time) * 1000000)::bigint FROM (",
      lines,
      ") a LEFT JOIN models m ON m.id = a.model_id LEFT JOIN layers l ON l.id = a.layer_id "
      "LEFT JOIN record_tables t ON t.id = a.table_id LEFT JOIN comments c ON c.id = a.comment_id "
      "ORDER BY a.time DESC, a.id DESC");
}
// Lines about the model, and about each table with records on it.
constexpr auto kActivityOfModel =
    sql("SELECT * FROM (", activity_lines("model_id = $1"),
        " UNION ALL SELECT of_table.* FROM (SELECT DISTINCT table_id FROM layers "
        "WHERE model_id = $1 AND table_id IS NOT NULL) on_it CROSS JOIN LATERAL ",
        activity_lines("activities.table_id = on_it.table_id"),
        " of_table) found "
        "ORDER BY time DESC, id DESC LIMIT $5");

constexpr int kTimeColumn = 21;  // the time in microseconds, for the position of the next page
// the year 2286
constexpr ActivityPlace kAfterAll{9'999'999'999'999'999, std::numeric_limits<std::int64_t>::max()};

Activity read_line(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Activity line;
  line.id = row.integer();
  line.time = row.time();
  line.begun = row.time();
  line.user = row.text();
  line.kind = row.text();
  line.op = row.text();
  line.name = row.text();
  line.model = row.id<std::optional<ModelId>>();
  line.layer = row.id<std::optional<LayerId>>();
  line.table = row.id<std::optional<TableId>>();
  line.comment = row.id<std::optional<CommentId>>();
  line.model_name = row.optional_text().value_or("");
  const auto record = row.optional_integer();
  if (line.table) line.record = record;
  line.text = row.optional_text().value_or("");
  line.person = row.optional_text().value_or("");
  line.role = row.optional_text().value_or("");
  line.group = row.optional_text().value_or("");
  line.count = row.integer();
  line.texels = row.optional_integer();
  line.area_m2 = row.optional_real();
  if (const auto changed = row.optional_json())
    line.changed = changed->get<std::vector<std::string>>();
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
        .integer(limit + 1)  // one more line shows whether there is a next page
        .array(visibilities_seen_by(seen_by));
    constexpr auto kOfModel = activity_page(kActivityOfModel);
    constexpr auto kOfProject = activity_page(activity_lines("project_id = $1"));
    auto rows =
        STRATA_TRY(connection.query(query.model ? kOfModel.c_str() : kOfProject.c_str(), params));
    ActivityPage page;
    for (int i = 0; i < std::min(rows.rows(), limit); ++i) page.lines.push_back(read_line(rows, i));
    if (rows.rows() > limit)
      page.next = ActivityPlace{rows.integer(limit - 1, kTimeColumn), page.lines.back().id};
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
