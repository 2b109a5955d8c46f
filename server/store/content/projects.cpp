#include "store/content/projects.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

Project read_project(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<ProjectId>(), row.text(), row.text(), row.text(), row.integer(), row.boolean()};
}

Result<void> check(const Project& project) {
  STRATA_TRY(check_name(project.name));
  return check_texts({{&project.slug, "slug"}, {&project.description, "description"}});
}

// Erases the remaining data of models that users have already erased from the Trash.
Result<void> erase_models_of(PgConnection& connection, ProjectId project_id) {
  auto models = STRATA_TRY(connection.query(
      "SELECT id FROM all_models WHERE project_id = $1 AND erasing", Params().id(project_id)));
  for (int i = 0; i < models.rows(); ++i)
    STRATA_TRY(erase_model(connection, models.id<ModelId>(i, 0)));
  return {};
}

}  // namespace

Result<std::vector<Project>> Projects::all() {
  return pool_.read([](PgConnection& connection) -> Result<std::vector<Project>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT id, name, slug::text, description, version, require_if_match FROM projects ORDER BY id"));
    std::vector<Project> projects;
    for (int i = 0; i < rows.rows(); ++i) projects.push_back(read_project(rows, i));
    return projects;
  });
}

Result<Project> Projects::find(const std::string& ref) {
  if (!check_text(ref, "project")) return no_such("project", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Project> {
    const auto id = id_of<ProjectId>(ref);
    auto rows =
        id ? connection.query(
                 "SELECT id, name, slug::text, description, version, require_if_match FROM projects WHERE id = $1",
                 Params().id(*id))
           : connection.query(
                 "SELECT id, name, slug::text, description, version, require_if_match FROM projects WHERE slug = $1",
                 Params().text(ref));
    if (!rows) return tl::unexpected(rows.error());
    if (rows->rows() == 0) return no_such("project", ref);
    return read_project(*rows, 0);
  });
}

Result<std::size_t> Projects::names_until(const NamedId& place, std::span<const NamedId> sorted) {
  STRATA_TRY(check_text(place.name, "after"));
  PgArray names(oid::kText), ids(oid::kInt8);
  for (const NamedId& each : sorted) {
    names.add(std::string_view(each.name));
    ids.add(each.id);
  }
  return pool_.read([&](PgConnection& connection) -> Result<std::size_t> {
    auto row = STRATA_TRY(
        connection.query("SELECT count(*) FROM unnest($3::text[], $4::bigint[]) AS e (name, id) "
                         "WHERE (lower(e.name), e.id) <= (lower($1), $2)",
                         Params().text(place.name).integer(place.id).array(names).array(ids)));
    return static_cast<std::size_t>(row.integer(0, 0));
  });
}

Result<std::string> Projects::state(ProjectId id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::string> {
    // Returns SQL for the ids and versions of the rows that the FROM clause `part` selects.
    const auto versions = [](const std::string& part) {
      return "coalesce((SELECT string_agg(concat_ws('.', p.id, p.version), ',' ORDER BY p.id) FROM " +
             part + "), '')";
    };
    const std::string of_models = " p JOIN models m ON m.id = p.model_id WHERE m.project_id = $1";
    const std::string sql =
        "SELECT concat_ws(';', " + versions("models p WHERE p.project_id = $1") + ", " +
        versions("layers" + of_models) + ", " + versions("looks" + of_models) + ", " +
        versions("views" + of_models) +
        ", (SELECT string_agg(concat_ws('.', id, version, sequence), ',' ORDER BY id) "
        "FROM record_tables WHERE project_id = $1))";
    auto row = STRATA_TRY(connection.query(sql.c_str(), Params().id(id)));
    return row.text(0, 0);
  });
}

Result<Project> Projects::create(Project project, const IdempotentResponse<Project>& answer) {
  STRATA_TRY(check(project));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Project> {
    auto row = STRATA_TRY(insert_with_slug(
        connection, "SELECT slug::text FROM projects WHERE slug LIKE $1", {},
        project.slug.empty() ? project.name : project.slug, [&](const std::string& slug) {
          return connection.query(
              "INSERT INTO projects (name, slug, description) VALUES ($1, $2, $3) "
              "ON CONFLICT (slug) DO NOTHING RETURNING id, name, slug::text, description, version, require_if_match",
              Params().text(project.name).text(slug).text(project.description));
        }));
    return read_project(row, 0);
  });
}

Result<Project> Projects::update(Project project, const IdempotentResponse<Project>& answer) {
  STRATA_TRY(check(project));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Project> {
    auto row = STRATA_TRY(connection.query(
        "UPDATE projects SET name = $3, slug = $4, description = $5, require_if_match = $6, version = version + 1 "
        "WHERE id = $1 AND version = $2 RETURNING id, name, slug::text, description, version, require_if_match",
        Params()
            .id(project.id)
            .integer(project.version)
            .text(project.name)
            .text(project.slug)
            .text(project.description)
            .boolean(project.require_if_match)));
    if (row.rows() > 0) return read_project(row, 0);
    auto known = connection.query("SELECT 1 FROM projects WHERE id = $1", Params().id(project.id));
    if (!known) return tl::unexpected(known.error());
    if (known->rows() == 0) return no_such("project", to_string(project.id));
    return stale("project");
  });
}

Result<void> Projects::remove(ProjectId id, const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    auto row = STRATA_TRY(connection.query(
        "SELECT slug::text, (SELECT count(*) FROM models WHERE project_id = p.id), "
        "(SELECT count(*) FROM record_tables WHERE project_id = p.id), "
        "(SELECT count(*) FROM all_models WHERE project_id = p.id AND NOT erasing) "
        "FROM projects p WHERE id = $1 FOR UPDATE",
        Params().id(id)));
    if (row.rows() == 0) return no_such("project", to_string(id));
    if (row.text(0, 0) == "default")
      return fail(
          ErrorCode::conflict, "Cannot delete project",
          "The project `default` must exist, because models imported without a project go there.");
    if (row.integer(0, 1) > 0)
      return fail(ErrorCode::conflict, "Cannot delete project",
                  "The project still contains " + std::to_string(row.integer(0, 1)) +
                      " models. Delete them or move them to another project first.");
    if (row.integer(0, 3) > 0)
      return fail(ErrorCode::conflict, "Cannot delete project",
                  "The Trash of the project still contains " + std::to_string(row.integer(0, 3)) +
                      " models. Restore them, or erase them there first.");
    if (row.integer(0, 2) > 0)
      return fail(ErrorCode::conflict, "Cannot delete project",
                  "The project still contains " + std::to_string(row.integer(0, 2)) +
                      " tables. Delete them first.");
    STRATA_TRY(erase_models_of(connection, id));
    auto done = connection.query("DELETE FROM projects WHERE id = $1", Params().id(id));
    return done ? Result<void>{} : tl::unexpected(done.error());
  });
}

}  // namespace strata::store
