#include "store/content/photographs.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "core/version.h"
#include "store/cluster/schema_readers.h"
#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr const char* kMigration = "000056";  // that added the photographs
constexpr std::size_t kRowsAtOnce = 1000;
constexpr std::size_t kCalibrationNumbers = 15, kPoseNumbers = 12;

constexpr auto kPhotographs = sql(
    "SELECT p.id, p.model_id, p.name, p.lens, p.unit, p.calibrated_width, p.calibrated_height, "
    "p.calibration, p.pose, p.version, p.rights_uri, p.rights_holder, p.media_type, b.bytes, "
    "encode(p.sha256, 'hex'), p.width, p.height FROM photographs p LEFT JOIN blobs b USING (sha256) ");

// Of a model, whose names contain a text, with an image ($3) or without one ($4). The names sort by
// their bytes (collation "C"), where lower() would only know the letters of ASCII.
constexpr auto kChosen =
    sql("WHERE p.model_id = $1 AND position(lower($2) IN lower(p.name COLLATE \"default\")) > 0 "
        "AND CASE WHEN p.sha256 IS NULL THEN $4 ELSE $3 END ");

photo::Calibration read_calibration(PgRow& row) {
  photo::Calibration calibration;
  calibration.lens.model = photo::lens_model_named(row.text()).value_or(photo::LensModel::pinhole);
  calibration.unit =
      row.text() == "pixel" ? photo::CalibrationUnit::pixel : photo::CalibrationUnit::longest_side;
  calibration.width = static_cast<int>(row.integer());
  calibration.height = static_cast<int>(row.integer());
  const std::vector<double> numbers = row.reals();
  calibration.focal = {numbers[0], numbers[1]};
  calibration.offset = {numbers[2], numbers[3]};
  calibration.skew = numbers[4];
  auto& radial = calibration.lens.radial;
  std::copy_n(numbers.begin() + 5, radial.size(), radial.begin());
  auto& tangential = calibration.lens.tangential;
  std::copy_n(numbers.begin() + 11, tangential.size(), tangential.begin());
  return calibration;
}

void add_numbers(PgArray& numbers, const photo::Calibration& calibration) {
  for (const double number : {calibration.focal.x, calibration.focal.y, calibration.offset.x,
                              calibration.offset.y, calibration.skew})
    numbers.add(number);
  for (const double number : calibration.lens.radial) numbers.add(number);
  for (const double number : calibration.lens.tangential) numbers.add(number);
}

photo::Pose read_pose(PgRow& row) {
  const std::vector<double> numbers = row.reals();
  photo::Pose pose;
  auto next = numbers.begin();
  for (glm::length_t y = 0; y < 3; ++y)
    for (glm::length_t x = 0; x < 3; ++x) pose.camera_from_world[x][y] = *next++;
  pose.center = {numbers[9], numbers[10], numbers[11]};
  return pose;
}

void add_numbers(PgArray& numbers, const photo::Pose& pose) {
  for (glm::length_t y = 0; y < 3; ++y)
    for (glm::length_t x = 0; x < 3; ++x) numbers.add(pose.camera_from_world[x][y]);
  for (glm::length_t i = 0; i < 3; ++i) numbers.add(pose.center[i]);
}

Photograph read_photograph(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Photograph photograph;
  photograph.id = row.id<PhotographId>();
  photograph.model_id = row.id<ModelId>();
  photograph.posed.name = row.text();
  photograph.posed.calibration = read_calibration(row);
  photograph.posed.pose = read_pose(row);
  photograph.version = row.integer();
  photograph.rights_uri = row.text();
  photograph.rights_holder = row.text();
  if (auto media_type = row.optional_text()) {
    Original original;
    original.media_type = std::move(*media_type);
    original.bytes = static_cast<std::uint64_t>(row.integer());
    original.sha256 = row.text();
    original.width = static_cast<int>(row.integer());
    original.height = static_cast<int>(row.integer());
    photograph.original = std::move(original);
  }
  return photograph;
}

// Locks the model, so that concurrent transactions cannot exceed the limit together.
Result<void> lock_model(PgConnection& connection, ModelId model_id) {
  const auto model = STRATA_TRY(connection.query(
      "SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE", Params().id(model_id)));
  return model.rows() == 0 ? no_such("model", to_string(model_id)) : Result<void>{};
}

struct Size {
  int width = 0, height = 0;
};
using SizeOfOriginal = std::unordered_map<std::string, std::optional<Size>>;  // by name

Result<SizeOfOriginal> existing(PgConnection& connection, ModelId model_id) {
  const auto rows = STRATA_TRY(connection.query(
      "SELECT name, width, height FROM photographs WHERE model_id = $1", Params().id(model_id)));
  SizeOfOriginal sizes;
  for (int i = 0; i < rows.rows(); ++i) {
    auto& size = sizes[rows.text(i, 0)];
    if (!rows.null(i, 1))
      size = Size{static_cast<int>(rows.integer(i, 1)), static_cast<int>(rows.integer(i, 2))};
  }
  return sizes;
}

Result<void> upsert(PgConnection& connection, ModelId model_id,
                    std::span<const photo::PosedPhotograph* const> photographs) {
  PgArray names(oid::kText), lenses(oid::kText), units(oid::kText), widths(oid::kInt8),
      heights(oid::kInt8), calibrations(oid::kFloat8), poses(oid::kFloat8);
  for (const photo::PosedPhotograph* photograph : photographs) {
    const photo::Calibration& calibration = photograph->calibration;
    names.add(std::string_view(photograph->name));
    lenses.add(photo::name(calibration.lens.model));
    units.add(std::string_view(calibration.unit == photo::CalibrationUnit::pixel ? "pixel"
                                                                                 : "longest_side"));
    widths.add(std::int64_t{calibration.width});
    heights.add(std::int64_t{calibration.height});
    add_numbers(calibrations, calibration);
    add_numbers(poses, photograph->pose);
  }
  STRATA_TRY(connection.query(
      "INSERT INTO photographs (model_id, name, lens, unit, calibrated_width, calibrated_height, "
      "calibration, pose) "
      "SELECT $1, n.name, n.lens, n.unit, n.width, n.height, "
      "($7::float8[])[(n.i - 1) * $9::bigint + 1 : n.i * $9::bigint], "
      "($8::float8[])[(n.i - 1) * $10::bigint + 1 : n.i * $10::bigint] "
      "FROM unnest($2::text[], $3::text[], $4::text[], $5::bigint[], $6::bigint[]) "
      "WITH ORDINALITY AS n (name, lens, unit, width, height, i) "
      "ON CONFLICT (model_id, name) DO UPDATE SET lens = excluded.lens, unit = excluded.unit, "
      "calibrated_width = excluded.calibrated_width, "
      "calibrated_height = excluded.calibrated_height, calibration = excluded.calibration, "
      "pose = excluded.pose, version = photographs.version + 1",
      Params()
          .id(model_id)
          .array(names)
          .array(lenses)
          .array(units)
          .array(widths)
          .array(heights)
          .array(calibrations)
          .array(poses)
          .integer(kCalibrationNumbers)
          .integer(kPoseNumbers)));
  return {};
}

// Older programs do not know that photographs use content, and would delete it.
Result<void> exclude_older(PgConnection& connection) {
  const auto older = STRATA_TRY(exclude_older_programs(connection, kMigration, version(), {}));
  if (older != OlderPrograms::running) return {};
  return fail(ErrorCode::conflict, "Nodes of another version",
              "A node of another version uses this site, and cannot keep photographs. Update all "
              "nodes first.");
}

Result<Photograph> find_one(PgConnection& connection, ModelId model_id, PhotographId id) {
  const auto rows = STRATA_TRY(connection.query(
      sql(kPhotographs, "WHERE p.model_id = $1 AND p.id = $2"), Params().id(model_id).id(id)));
  if (rows.rows() == 0) return no_such("photograph", to_string(id));
  return read_photograph(rows, 0);
}

Result<void> drop_contents(PgConnection& connection, const PgResult& hashes) {
  std::vector<std::vector<std::uint8_t>> contents;
  for (int i = 0; i < hashes.rows(); ++i) {
    if (hashes.null(i, 0)) continue;
    const Bytes hash = hashes.bytes(i, 0);
    contents.emplace_back(hash.begin(), hash.end());
  }
  return contents.empty() ? Result<void>{} : drop_unused(connection, contents);
}

}  // namespace

Result<MergedPhotographs> Photographs::merge(ModelId model_id,
                                             std::span<const photo::PosedPhotograph> photographs,
                                             const IdempotentResponse<MergedPhotographs>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<MergedPhotographs> {
    STRATA_TRY(lock_model(connection, model_id));
    const SizeOfOriginal before = STRATA_TRY(existing(connection, model_id));
    MergedPhotographs merged;
    std::unordered_set<std::string_view> seen;
    std::vector<const photo::PosedPhotograph*> accepted;
    for (const photo::PosedPhotograph& photograph : photographs) {
      if (!seen.insert(photograph.name).second) {
        merged.refused.push_back(
            {photograph.name,
             {ErrorCode::invalid, "Name used twice",
              "Another photograph of the export has the same name. Rename one of them in the "
              "program, and export the cameras again."}});
        continue;
      }
      const auto known = before.find(photograph.name);
      if (known != before.end() && known->second)
        if (auto fits = photo::camera_for(photograph.calibration, known->second->width,
                                          known->second->height);
            !fits) {
          merged.refused.push_back({photograph.name, fits.error()});
          continue;
        }
      ++(known == before.end() ? merged.added : merged.updated);
      accepted.push_back(&photograph);
    }
    merged.total = static_cast<std::int64_t>(before.size()) + merged.added;
    if (merged.total > kMaxPhotographs)
      return fail(ErrorCode::conflict, "Too many photographs",
                  "A model can have at most " + std::to_string(kMaxPhotographs) +
                      " photographs. With this export, it would have " +
                      std::to_string(merged.total) + ". Delete photographs first.");
    for (std::size_t i = 0; i < accepted.size(); i += kRowsAtOnce)
      STRATA_TRY(
          upsert(connection, model_id,
                 std::span(accepted).subspan(i, std::min(kRowsAtOnce, accepted.size() - i))));
    return merged;
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<Photographs::Page> Photographs::page(ModelId model_id, const PageRequest& request) {
  const auto add_choice = [&](Params& params) -> Params& {
    const auto& with = request.with_original;
    return params.id(model_id).text(request.text).boolean(!with || *with).boolean(!with || !*with);
  };
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    Params counted, read;
    const auto counts = STRATA_TRY(connection.query(
        sql("SELECT count(*), count(p.sha256) FROM photographs p ", kChosen), add_choice(counted)));
    // Every name is greater than the empty text.
    const auto rows = STRATA_TRY(connection.query(
        sql(kPhotographs, kChosen, "AND p.name > $5 ORDER BY p.name LIMIT $6 OFFSET $7"),
        add_choice(read).text(request.after).integer(request.limit).integer(request.offset)));
    Page page;
    page.total = counts.integer(0, 0);
    page.with_original = counts.integer(0, 1);
    for (int i = 0; i < rows.rows(); ++i) page.photographs.push_back(read_photograph(rows, i));
    return page;
  });
}

Result<std::vector<Photograph>> Photographs::of_model(ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Photograph>> {
    const auto rows = STRATA_TRY(connection.query(
        sql(kPhotographs, "WHERE p.model_id = $1 ORDER BY p.name"), Params().id(model_id)));
    std::vector<Photograph> photographs;
    photographs.reserve(static_cast<std::size_t>(rows.rows()));
    for (int i = 0; i < rows.rows(); ++i) photographs.push_back(read_photograph(rows, i));
    return photographs;
  });
}

Result<std::vector<std::pair<PhotographId, std::string>>> Photographs::names(ModelId model_id) {
  using Names = std::vector<std::pair<PhotographId, std::string>>;
  return pool_.read([&](PgConnection& connection) -> Result<Names> {
    const auto rows = STRATA_TRY(
        connection.query("SELECT id, name FROM photographs WHERE model_id = $1 ORDER BY name",
                         Params().id(model_id)));
    Names names;
    names.reserve(static_cast<std::size_t>(rows.rows()));
    for (int i = 0; i < rows.rows(); ++i)
      names.emplace_back(rows.id<PhotographId>(i, 0), rows.text(i, 1));
    return names;
  });
}

Result<Photograph> Photographs::find(ModelId model_id, PhotographId id) {
  return pool_.read([&](PgConnection& connection) { return find_one(connection, model_id, id); });
}

Result<Photograph> Photographs::set_original(ModelId model_id, PhotographId id,
                                             const NewOriginal& original,
                                             const IdempotentResponse<Photograph>& answer) {
  STRATA_TRY(pool_.write(exclude_older));
  Content content = STRATA_TRY(content_of(original.file, {}));
  STRATA_TRY(blobs_.upload(content));
  const auto work = [&](PgConnection& connection) -> Result<Photograph> {
    // The calibration must not change between the check and the commit.
    const auto former = STRATA_TRY(connection.query(
        "SELECT sha256 FROM photographs WHERE model_id = $1 AND id = $2 FOR NO KEY UPDATE",
        Params().id(model_id).id(id)));
    const Photograph before = STRATA_TRY(find_one(connection, model_id, id));
    STRATA_TRY(photo::camera_for(before.posed.calibration, original.width, original.height));
    STRATA_TRY(keep_blob(connection, content, {}));
    STRATA_TRY(connection.query(
        "UPDATE photographs SET sha256 = $3, media_type = $4, width = $5, height = $6, "
        "version = version + 1 WHERE model_id = $1 AND id = $2",
        Params()
            .id(model_id)
            .id(id)
            .bytes(content.hash)
            .text(original.media_type)
            .integer(original.width)
            .integer(original.height)));
    STRATA_TRY(drop_contents(connection, former));
    return find_one(connection, model_id, id);
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::int64_t> Photographs::set_rights(ModelId model_id, std::span<const PhotographId> ids,
                                             const std::string& rights_uri,
                                             const std::string& rights_holder,
                                             const IdempotentResponse<std::int64_t>& answer) {
  STRATA_TRY(check_text(rights_uri, "rights_uri"));
  STRATA_TRY(check_text(rights_holder, "rights_holder"));
  PgArray chosen(oid::kInt8);
  for (const PhotographId id : ids) chosen.add(id.number());
  const auto work = [&](PgConnection& connection) -> Result<std::int64_t> {
    const auto rows = STRATA_TRY(connection.query(
        "UPDATE photographs SET rights_uri = $3, rights_holder = $4, version = version + 1 "
        "WHERE model_id = $1 AND (id = any($2) OR $5) RETURNING 1",
        Params()
            .id(model_id)
            .array(chosen)
            .text(rights_uri)
            .text(rights_holder)
            .boolean(ids.empty())));
    return std::int64_t{rows.rows()};
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<void> Photographs::remove(ModelId model_id, PhotographId id,
                                 const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    const auto gone = STRATA_TRY(
        connection.query("DELETE FROM photographs WHERE model_id = $1 AND id = $2 RETURNING sha256",
                         Params().id(model_id).id(id)));
    if (gone.rows() == 0) return no_such("photograph", to_string(id));
    return drop_contents(connection, gone);
  });
}

Result<void> Photographs::remove_all(ModelId model_id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<void> {
    const auto gone = STRATA_TRY(connection.query(
        "DELETE FROM photographs WHERE model_id = $1 RETURNING sha256", Params().id(model_id)));
    return drop_contents(connection, gone);
  };
  return change(pool_, answer, work, kBulkLimits);
}

}  // namespace strata::store
