#include <algorithm>

#include "core/progress.h"
#include "core/text/hex.h"
#include "domain/scene/surveyed_object.h"
#include "domain/scene/up.h"
#include "store/content/models.h"
#include "store/content/surface_image_rows.h"
#include "store/content/surface_images.h"
#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kSelectModels = sql(
    "SELECT m.id, m.project_id, m.name, m.slug::text, m.unit, m.unit_assumed, m.scale_verified, m.up, m.north, m.crs, "
    "m.origin, m.bounds_min, m.bounds_max, m.triangles, m.vertices, m.area, m.atlas, m.repairs, m.default_resolution, "
    "m.inventory_number, m.owner, m.creator, m.captured, m.method, m.accuracy, m.processing, m.rights_uri, m.credit, "
    "m.source_download, m.object_id, m.survey_date, m.sequence, m.version, coalesce(m.proposal, 'null'), "
    "coalesce(m.open_edges, 'null'), coalesce(m.from_points, 'null'), coalesce(m.parts, 'null'), "
    "(SELECT coalesce(jsonb_agg(jsonb_build_object('name', s.name, 'sha256', encode(s.sha256, 'hex'), 'bytes', b.bytes) "
    "ORDER BY s.position), '[]') FROM model_sources s JOIN blobs b USING (sha256) WHERE s.model_id = m.id) "
    "FROM models m ");

glm::dvec3 vec3_of(const std::vector<double>& v) {
  return v.size() == 3 ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(0);
}

Model read_model(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Model m;
  m.id = row.id<ModelId>();
  m.project_id = row.id<ProjectId>();
  m.name = row.text();
  m.slug = row.text();
  m.unit = parse_unit(row.text()).value_or(Unit::m);
  m.unit_assumed = row.boolean();
  m.scale_verified = row.boolean();
  m.up = row.text();
  m.north = row.text();
  m.crs = row.text();
  m.origin = vec3_of(row.reals());
  m.bounds_min = vec3_of(row.reals());
  m.bounds_max = vec3_of(row.reals());
  m.triangles = static_cast<std::uint64_t>(row.integer());
  m.vertices = static_cast<std::uint64_t>(row.integer());
  m.area = row.real();
  m.atlas = atlas_from_json(row.json());
  for (const auto& repair : row.json())
    m.repairs.push_back(
        {repair.value("what", std::string()), repair.value("count", std::uint64_t{0})});
  m.default_resolution = static_cast<int>(row.integer());
  for (std::string* text : {&m.inventory_number, &m.owner, &m.creator, &m.captured, &m.method,
                            &m.accuracy, &m.processing, &m.rights_uri, &m.credit})
    *text = row.text();
  // An unknown role must not make the files downloadable for additional roles.
  m.source_download = parse_role(row.text()).value_or(Role::curator);
  m.object = row.id<std::optional<ObjectId>>();
  m.survey_date = row.text();
  m.sequence = row.integer();
  m.version = row.integer();
  m.proposal = scale_proposal_from_json(row.json());
  m.open_edges = open_edges_from_json(row.json());
  m.from_points = surface_from_points_from_json(row.json());
  m.parts = model_parts_from_json(row.json());
  for (const auto& file : row.json())
    m.source_files.push_back({file.at("name"), file.at("sha256"), file.at("bytes")});
  return m;
}

Result<void> check(const Model& m) {
  STRATA_TRY(check_name(m.name));
  if (!is_up(m.up))
    return fail(ErrorCode::malformed, "Invalid direction",
                "`up` must be one of x, y, z, -x, -y and -z.", "up");
  for (const auto& repair : m.repairs) STRATA_TRY(check_text(repair.what, "repairs"));
  for (const ModelPart& part : m.parts) {
    STRATA_TRY(check_text(part.name, "parts"));
    STRATA_TRY(check_text(part.folder, "parts"));
  }
  return check_texts({{&m.slug, "slug"},
                      {&m.north, "north"},
                      {&m.crs, "crs"},
                      {&m.inventory_number, "inventory_number"},
                      {&m.owner, "owner"},
                      {&m.creator, "creator"},
                      {&m.captured, "captured"},
                      {&m.method, "method"},
                      {&m.accuracy, "accuracy"},
                      {&m.processing, "processing"},
                      {&m.rights_uri, "rights_uri"},
                      {&m.credit, "credit"},
                      {&m.atlas.source, "atlas"}});
}

// Metadata that can be changed later: $1 name, $2 slug, … $22 survey_date.
Params metadata(const Model& m, const std::string& slug) {
  Params params;
  params.text(m.name)
      .text(slug)
      .id(m.project_id)
      .text(name(m.unit))
      .boolean(m.unit_assumed)
      .boolean(m.scale_verified)
      .text(m.up)
      .text(m.north)
      .text(m.crs)
      .integer(m.default_resolution)
      .text(m.inventory_number)
      .text(m.owner)
      .text(m.creator)
      .text(m.captured)
      .text(m.method)
      .text(m.accuracy)
      .text(m.processing)
      .text(m.rights_uri)
      .text(m.credit)
      .text(name(m.source_download))
      .optional_id(m.object)
      .text(m.survey_date);
  return params;
}

PgArray array_of(const glm::dvec3& v) {
  PgArray array(oid::kFloat8);
  array.add(v.x);
  array.add(v.y);
  array.add(v.z);
  return array;
}

Result<PgResult> insert_model(PgConnection& connection, const Model& m, const std::string& slug,
                              const Sha256& geometry) {
  auto repairs = nlohmann::json::array();
  for (const auto& repair : m.repairs)
    repairs.push_back({{"what", repair.what}, {"count", repair.count}});
  Params params = metadata(m, slug);
  params.array(array_of(m.origin))
      .array(array_of(m.bounds_min))
      .array(array_of(m.bounds_max))
      .integer(static_cast<std::int64_t>(m.triangles))
      .integer(static_cast<std::int64_t>(m.vertices))
      .real(m.area)
      .json(to_json(m.atlas, 1.0))
      .json(repairs)
      .bytes(geometry)
      .json(m.proposal ? to_json(*m.proposal) : nlohmann::json())
      .json(m.open_edges ? to_json(*m.open_edges, 1.0) : nlohmann::json())
      .json(m.from_points ? to_json(*m.from_points, 1.0) : nlohmann::json())
      .json(m.parts.empty() ? nlohmann::json() : to_json(m.parts, 1.0));
  return connection.query(
      "INSERT INTO models (name, slug, project_id, unit, unit_assumed, scale_verified, up, north, crs, default_resolution, "
      "inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri, credit, source_download, "
      "object_id, survey_date, origin, bounds_min, bounds_max, triangles, vertices, area, atlas, repairs, geometry, proposal, "
      "open_edges, from_points, parts) "
      "VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17, $18, $19, $20, $21, $22, $23, $24, "
      "$25, $26, $27, $28, $29, $30, $31, nullif($32, 'null'), nullif($33, 'null'), nullif($34, 'null'), nullif($35, 'null')) ON CONFLICT DO NOTHING RETURNING id",
      params);
}

SurfaceImage surface_image_of(const NewModel::NewSurfaceImage& fresh, std::size_t position) {
  SurfaceImage image;
  image.name = fresh.name;
  image.media_type = fresh.media_type;
  image.width = fresh.width;
  image.height = fresh.height;
  image.visible = position == 0;
  image.order = static_cast<int>(position);
  return image;
}

Result<Model> model_by_id(PgConnection& connection, ModelId id) {
  auto rows = STRATA_TRY(connection.query(sql(kSelectModels, "WHERE m.id = $1"), Params().id(id)));
  if (rows.rows() == 0) return no_such("model", to_string(id));
  return read_model(rows, 0);
}

}  // namespace

Result<Model> Models::create(const NewModel& fresh, const std::function<bool()>& cancelled,
                             const IdempotentResponse<Model>& answer) {
  STRATA_TRY(check(fresh.model));
  STRATA_TRY(
      check_survey(fresh.model.object || !fresh.object_name.empty(), fresh.model.survey_date));
  for (const auto& source : fresh.sources) {
    if (source.name.empty() || source.name.size() > kMaxNameLength)
      return fail(ErrorCode::malformed, "Invalid file name",
                  "The name of a file must be 1 to 255 bytes long.", "source_files");
    STRATA_TRY(check_text(source.name, "source_files"));
  }
  if (fresh.images.size() > SurfaceImages::kMaxSurfaceImages)
    return fail(ErrorCode::invalid, "Too many surface images",
                "A model can have at most " + std::to_string(SurfaceImages::kMaxSurfaceImages) +
                    " surface images.",
                "looks");
  for (std::size_t i = 0; i < fresh.images.size(); ++i)
    STRATA_TRY(check_surface_image(surface_image_of(fresh.images[i], i)));
  // In this order: the geometry, its coarser copies, the surface images, the source files.
  std::vector<Content> contents{content_of(Bytes(fresh.geometry))};
  for (const auto& level : fresh.detail_levels) contents.push_back(content_of(Bytes(level)));
  const std::size_t first_surface_image = contents.size();
  for (const auto& image : fresh.images) contents.push_back(content_of(Bytes(image.bytes)));
  const std::size_t first_source = contents.size();
  for (const auto& source : fresh.sources) {
    auto content = STRATA_TRY(content_of(source.file, cancelled));
    contents.push_back(std::move(content));
  }
  STRATA_TRY(blobs_.upload(contents, cancelled));
  const auto work = [&](PgConnection& connection) -> Result<Model> {
    const Sha256 geometry = contents.front().hash;
    std::vector<const Content*> by_hash;
    for (const Content& content : contents) by_hash.push_back(&content);
    std::sort(by_hash.begin(), by_hash.end(),
              [](const Content* a, const Content* b) { return a->hash < b->hash; });
    for (const Content* content : by_hash) STRATA_TRY(keep_blob(connection, *content, cancelled));
    Model m = fresh.model;
    if (!fresh.object_name.empty())
      m.object = STRATA_TRY(object_named(connection, m.project_id, fresh.object_name));
    STRATA_TRY(check_object(connection, m));
    auto row = STRATA_TRY(insert_with_slug(
        connection, "SELECT slug::text FROM models WHERE slug LIKE $1", {},
        m.slug.empty() ? m.name : m.slug,
        [&](const std::string& slug) { return insert_model(connection, m, slug, geometry); }));
    const ModelId id = row.id<ModelId>(0, 0);
    for (std::size_t i = 1; i < first_surface_image; ++i) {
      STRATA_TRY(connection.query(
          "INSERT INTO detail_levels (model_id, level, geometry) VALUES ($1, $2, $3)",
          Params().id(id).integer(static_cast<std::int64_t>(i)).bytes(contents[i].hash)));
    }
    for (std::size_t i = 0; i < fresh.images.size(); ++i) {
      SurfaceImage image = surface_image_of(fresh.images[i], i);
      image.model_id = id;
      STRATA_TRY(insert_surface_image(connection, image, contents[first_surface_image + i].hash));
    }
    for (std::size_t i = 0; i < fresh.sources.size(); ++i) {
      STRATA_TRY(connection.query(
          "INSERT INTO model_sources (model_id, name, position, sha256) VALUES ($1, $2, $3, $4)",
          Params()
              .id(id)
              .text(fresh.sources[i].name)
              .integer(static_cast<std::int64_t>(i))
              .bytes(contents[first_source + i].hash)));
    }
    if (cancelled && cancelled()) return cancelled_problem();
    return model_by_id(connection, id);
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::vector<Model>> Models::all(std::optional<ProjectId> project_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Model>> {
    auto rows = STRATA_TRY(
        connection.query(sql(kSelectModels, "WHERE $1 IS NULL OR m.project_id = $1 ORDER BY m.id"),
                         Params().optional_id(project_id)));
    std::vector<Model> models;
    for (int i = 0; i < rows.rows(); ++i) models.push_back(read_model(rows, i));
    return models;
  });
}

Result<Model> Models::find(const std::string& ref) {
  if (!check_text(ref, "model")) return no_such("model", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Model> {
    if (const auto id = id_of<ModelId>(ref)) return model_by_id(connection, *id);
    auto rows =
        STRATA_TRY(connection.query(sql(kSelectModels, "WHERE m.slug = $1"), Params().text(ref)));
    if (rows.rows() == 0) return no_such("model", ref);
    return read_model(rows, 0);
  });
}

Result<Model> Models::update(Model m, const IdempotentResponse<Model>& answer) {
  STRATA_TRY(check(m));
  STRATA_TRY(check_survey(m.object.has_value(), m.survey_date));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Model> {
    STRATA_TRY(check_object(connection, m));
    // The order of locks is that of edits: the model, then its layers.
    STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                Params().id(m.id)));
    // Computed layers can contain lengths, heights and slopes, so they are stale, also in the
    // Trash. Afterwards, the statement below checks the version.
    STRATA_TRY(connection.query(
        "UPDATE all_layers SET computed_sequence = 0 WHERE model_id = $1 AND expression IS NOT NULL AND EXISTS "
        "(SELECT 1 FROM models WHERE id = $1 AND version = $2 AND (unit, up) IS DISTINCT FROM ($3, $4))",
        Params().id(m.id).integer(m.version).text(name(m.unit)).text(m.up)));
    auto row = STRATA_TRY(connection.query(
        "UPDATE models SET name = $1, slug = $2, project_id = $3, unit = $4, unit_assumed = $5, scale_verified = $6, up = $7, "
        "north = $8, crs = $9, default_resolution = $10, inventory_number = $11, owner = $12, creator = $13, captured = $14, "
        "method = $15, accuracy = $16, processing = $17, rights_uri = $18, credit = $19, source_download = $20, "
        "object_id = $21, survey_date = $22, version = version + 1 WHERE id = $23 AND version = $24 RETURNING id",
        metadata(m, m.slug).id(m.id).integer(m.version)));
    auto now = STRATA_TRY(model_by_id(connection, m.id));
    if (row.rows() == 0) return stale("model");
    auto layer = STRATA_TRY(connection.query(
        "SELECT l.name FROM all_layers l JOIN record_tables t ON t.id = l.table_id WHERE l.model_id = $1 AND t.project_id <> $2 "
        "LIMIT 1",
        Params().id(m.id).id(m.project_id)));
    if (layer.rows() > 0)
      return fail(ErrorCode::conflict, "Tables belong to project",
                  "The keys of the layer " + layer.text(0, 0) +
                      " belong to a table of the model's current project. Erase this "
                      "layer before you move the model to another project.",
                  "project");
    return now;
  });
}

Result<void> Models::remove(ModelId id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<void> {
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1", Params().id(id)));
    return known.rows() > 0 ? erase_model(connection, id) : no_such("model", to_string(id));
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::vector<std::uint8_t>> Models::geometry(ModelId model_id) {
  const auto row = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query("SELECT geometry FROM models WHERE id = $1", Params().id(model_id));
  }));
  if (row.rows() == 0) return no_such("model", to_string(model_id));
  return blobs_.read(row.bytes(0, 0));
}

Result<std::vector<std::vector<std::uint8_t>>> Models::detail_levels(ModelId model_id) {
  const auto rows = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query("SELECT geometry FROM detail_levels WHERE model_id = $1 ORDER BY level",
                            Params().id(model_id));
  }));
  std::vector<std::vector<std::uint8_t>> levels;
  for (int i = 0; i < rows.rows(); ++i) {
    auto level = STRATA_TRY(blobs_.read(rows.bytes(i, 0)));
    levels.push_back(std::move(level));
  }
  return levels;
}

Result<SourceFile> Models::read_source(
    ModelId model_id, const std::string& file,
    const std::function<bool(std::span<const std::uint8_t>)>& sink) {
  if (!check_text(file, "name")) return no_such("source file", file);
  auto known = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query(
        "SELECT b.sha256, b.bytes FROM model_sources s JOIN blobs b USING (sha256) "
        "WHERE s.model_id = $1 AND s.name = $2",
        Params().id(model_id).text(file));
  }));
  if (known.rows() == 0) return no_such("source file", file);
  const SourceFile source{file, to_hex(known.bytes(0, 0)),
                          static_cast<std::uint64_t>(known.integer(0, 1))};
  STRATA_TRY(blobs_.stream(known.bytes(0, 0), 0, source.bytes, sink));
  return source;
}

}  // namespace strata::store
