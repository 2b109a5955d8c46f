#include "store/content/jobs.h"

#include "store/store_impl.h"

namespace strata::store {

Result<std::vector<StoredJob>> Jobs::take_over(int most) {
  return pool_.write([&](PgConnection& connection) -> Result<std::vector<StoredJob>> {
    STRATA_TRY(connection.query(
        "UPDATE jobs j SET state = 'lost', ended = now() WHERE state = 'begun' AND NOT EXISTS "
        "(SELECT FROM nodes n WHERE n.id = j.node AND n.lease_until > clock_timestamp())"));
    STRATA_TRY(connection.query("DELETE FROM jobs WHERE ended < now() - $1 * interval '1 day'",
                                Params().integer(kDaysKept)));
    auto rows = STRATA_TRY(connection.query(
        "SELECT id, project_id, user_name, kind, state, coalesce(problem, 'null'), coalesce(result, 'null') FROM jobs "
        "WHERE state <> 'begun' ORDER BY id DESC LIMIT $1",
        Params().integer(most)));
    std::vector<StoredJob> jobs;
    for (int i = 0; i < rows.rows(); ++i)
      jobs.push_back({rows.id<JobId>(i, 0), rows.id<ProjectId>(i, 1), rows.text(i, 2),
                      rows.text(i, 3), rows.text(i, 4), rows.json(i, 5), rows.json(i, 6)});
    return jobs;
  });
}

Result<void> Jobs::begin(const StoredJob& job) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto inserted = STRATA_TRY(connection.query(
        "INSERT INTO jobs (id, project_id, user_name, kind, node) SELECT $1, id, $3, $4, $5::text::uuid FROM projects WHERE id = $2",
        Params()
            .id(job.id)
            .id(job.project_id)
            .text(job.user)
            .text(job.kind)
            .optional_text(job.node ? std::optional(to_string(*job.node)) : std::nullopt)));
    return inserted.affected() > 0 ? Result<void>() : no_such("project", to_string(job.project_id));
  });
}

Result<void> Jobs::end(const StoredJob& job) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto updated = connection.query(
        "UPDATE jobs SET state = $2, problem = nullif($3, 'null'), result = nullif($4, 'null'), ended = now() "
        "WHERE id = $1 AND (state = 'begun' OR ($2 = 'done' AND state = 'done'))",
        Params().id(job.id).text(job.state).json(job.problem).json(job.result));
    return updated ? Result<void>() : tl::unexpected(updated.error());
  });
}

Result<void> finish_job(PgConnection& connection, JobId job, nlohmann::json result) {
  result.erase("request");
  STRATA_TRY(check_json(result, "result"));
  auto updated =
      connection.query("UPDATE jobs SET state = 'done', result = $2, ended = now() WHERE id = $1",
                       Params().id(job).json(result));
  return updated ? Result<void>() : tl::unexpected(updated.error());
}

}  // namespace strata::store
