#include "store/content/objects.h"

#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

// Transactions lock an object before its models.

namespace strata::store {
namespace {

constexpr auto kSelectObjects = sql(
    "SELECT o.id, o.project_id, o.name, o.version, (SELECT coalesce(jsonb_agg(jsonb_build_object('model', m.id, "
    "'slug', m.slug::text, 'name', m.name, 'date', m.survey_date) ORDER BY m.survey_date COLLATE \"C\", m.id), '[]') "
    "FROM models m WHERE m.object_id = o.id) FROM objects o ");

SurveyedObject read_object(const PgResult& rows, int i) {
  PgRow row(rows, i);
  SurveyedObject object{row.id<ObjectId>(), row.id<ProjectId>(), row.text(), row.integer()};
  for (const auto& survey : row.json())
    object.surveys.push_back({survey.at("model").get<ModelId>(), survey.at("slug"),
                              survey.at("name"), survey.at("date")});
  return object;
}

Result<SurveyedObject> load(PgConnection& connection, ProjectId project_id, ObjectId id) {
  auto rows =
      STRATA_TRY(connection.query(sql(kSelectObjects, "WHERE o.project_id = $1 AND o.id = $2"),
                                  Params().id(project_id).id(id)));
  if (rows.rows() == 0) return no_such("object", to_string(id));
  return read_object(rows, 0);
}

// Locks the project, so that concurrent transactions cannot take a name twice or exceed the limit
// together.
Result<void> lock_names(PgConnection& connection, ProjectId project_id) {
  auto project = STRATA_TRY(connection.query(
      "SELECT 1 FROM projects WHERE id = $1 FOR NO KEY UPDATE", Params().id(project_id)));
  return project.rows() > 0 ? Result<void>() : no_such("project", to_string(project_id));
}

// Returns the object with this name, ignoring case.
Result<std::optional<ObjectId>> object_with_name(PgConnection& connection, ProjectId project_id,
                                                 const std::string& name) {
  auto rows = STRATA_TRY(
      connection.query("SELECT id FROM objects WHERE project_id = $1 AND lower(name) = lower($2)",
                       Params().id(project_id).text(name)));
  return rows.rows() > 0 ? std::optional(rows.id<ObjectId>(0, 0)) : std::nullopt;
}

tl::unexpected<Error> name_taken(const std::string& name) {
  return fail(
      ErrorCode::conflict, "Name already used",
      "The project already has an object with the name `" + name + "`. Choose another name.",
      "name");
}

// The caller has locked the names and checked that the name is free.
Result<ObjectId> insert_object(PgConnection& connection, ProjectId project_id,
                               const std::string& name) {
  auto count = STRATA_TRY(connection.query("SELECT count(*) FROM objects WHERE project_id = $1",
                                           Params().id(project_id)));
  if (count.integer(0, 0) >= Objects::kMaxObjects)
    return fail(ErrorCode::conflict, "Too many objects",
                "A project can have at most " + std::to_string(Objects::kMaxObjects) +
                    " objects. Delete some first.");
  auto made = STRATA_TRY(
      connection.query("INSERT INTO objects (project_id, name) VALUES ($1, $2) RETURNING id",
                       Params().id(project_id).text(name)));
  return made.id<ObjectId>(0, 0);
}

// Locks the object, so that its name and its models stay the same until the commit.
Result<void> lock_version(PgConnection& connection, const SurveyedObject& object) {
  auto rows = STRATA_TRY(
      connection.query("SELECT version FROM objects WHERE project_id = $1 AND id = $2 FOR UPDATE",
                       Params().id(object.project_id).id(object.id)));
  if (rows.rows() == 0) return no_such("object", to_string(object.id));
  if (rows.integer(0, 0) != object.version) return stale("object");
  return {};
}

}  // namespace

Result<ObjectId> object_named(PgConnection& connection, ProjectId project_id,
                              const std::string& name) {
  STRATA_TRY(check_name(name));
  STRATA_TRY(lock_names(connection, project_id));
  const auto known = STRATA_TRY(object_with_name(connection, project_id, name));
  return known ? *known : insert_object(connection, project_id, name);
}

Result<void> check_object(PgConnection& connection, const Model& model) {
  if (!model.object) return {};
  auto object = STRATA_TRY(
      connection.query("SELECT 1 FROM objects WHERE id = $1 AND project_id = $2 FOR NO KEY UPDATE",
                       Params().id(*model.object).id(model.project_id)));
  if (object.rows() == 0)
    return fail(ErrorCode::invalid, "Object not found",
                "The project has no object `" + to_string(*model.object) + "`.", "object");
  auto others = STRATA_TRY(
      connection.query("SELECT count(*) FROM all_models WHERE object_id = $1 AND id <> $2",
                       Params().id(*model.object).id(model.id)));
  if (others.integer(0, 0) >= Objects::kMaxSurveys)
    return fail(ErrorCode::conflict, "Too many surveys",
                "An object can have at most " + std::to_string(Objects::kMaxSurveys) +
                    " surveys. Take some models out of it first.",
                "object");
  return {};
}

Result<Objects::Page> Objects::of_project(ProjectId project_id, int limit, int offset,
                                          std::int64_t after) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    auto total = STRATA_TRY(connection.query("SELECT count(*) FROM objects WHERE project_id = $1",
                                             Params().id(project_id)));
    auto rows = STRATA_TRY(connection.query(
        sql(kSelectObjects,
            "WHERE o.project_id = $1 AND o.id > $4 ORDER BY o.id LIMIT $2 OFFSET $3"),
        Params().id(project_id).integer(limit).integer(offset).integer(after)));
    Page page;
    page.total = total.integer(0, 0);
    for (int i = 0; i < rows.rows(); ++i) page.objects.push_back(read_object(rows, i));
    return page;
  });
}

Result<SurveyedObject> Objects::find(ProjectId project_id, ObjectId id) {
  return pool_.read([&](PgConnection& connection) { return load(connection, project_id, id); });
}

Result<SurveyedObject> Objects::create(ProjectId project_id, const std::string& name,
                                       const IdempotentResponse<SurveyedObject>& answer) {
  STRATA_TRY(check_name(name));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<SurveyedObject> {
    STRATA_TRY(lock_names(connection, project_id));
    const auto known = STRATA_TRY(object_with_name(connection, project_id, name));
    if (known) return name_taken(name);
    const auto id = STRATA_TRY(insert_object(connection, project_id, name));
    return load(connection, project_id, id);
  });
}

Result<SurveyedObject> Objects::rename(const SurveyedObject& object,
                                       const IdempotentResponse<SurveyedObject>& answer) {
  STRATA_TRY(check_name(object.name));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<SurveyedObject> {
    STRATA_TRY(lock_names(connection, object.project_id));
    STRATA_TRY(lock_version(connection, object));
    const auto known = STRATA_TRY(object_with_name(connection, object.project_id, object.name));
    if (known && *known != object.id) return name_taken(object.name);
    STRATA_TRY(connection.query("UPDATE objects SET name = $2, version = version + 1 WHERE id = $1",
                                Params().id(object.id).text(object.name)));
    return load(connection, object.project_id, object.id);
  });
}

Result<void> Objects::remove(const SurveyedObject& object, const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(lock_version(connection, object));
    // Locks the models, so that none of them is restored from the Trash until the commit.
    auto models = STRATA_TRY(connection.query(
        "SELECT binned IS NULL FROM all_models WHERE object_id = $1 ORDER BY id FOR NO KEY UPDATE",
        Params().id(object.id)));
    int surveys = 0;
    for (int i = 0; i < models.rows(); ++i) surveys += models.boolean(i, 0) ? 1 : 0;
    if (surveys > 0)
      return fail(ErrorCode::conflict, "Cannot delete object",
                  "The object still has " + std::to_string(surveys) +
                      (surveys == 1 ? " survey. Take its model" : " surveys. Take their models") +
                      " out of it first.");
    STRATA_TRY(connection.query(
        "UPDATE all_models SET object_id = NULL, survey_date = '' WHERE object_id = $1",
        Params().id(object.id)));
    auto done = connection.query("DELETE FROM objects WHERE id = $1", Params().id(object.id));
    return done ? Result<void>() : tl::unexpected(done.error());
  });
}

}  // namespace strata::store
