#include "app/layers/geopackage.h"

#include <sqlite3.h>

#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>

#include "core/log.h"
#include "core/uuid.h"
#include "domain/people/question.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr int kUndefinedCartesian = -1;

// The required layout: OGC 12-128r17, tables 1, 3 and 22, with the rows of requirement 11.
constexpr const char* kLayout = R"(
PRAGMA application_id = 1196444487;
PRAGMA user_version = 10300;
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
BEGIN;
CREATE TABLE gpkg_spatial_ref_sys (
  srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined Cartesian coordinate reference system'),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinate reference system'),
  ('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]',
   'longitude and latitude in degrees on the WGS 84 spheroid');
CREATE TABLE gpkg_contents (
  table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE, description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
  table_name TEXT NOT NULL, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL,
  z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
)";

// Thrown if the file could not be written, for example because the disk is full.
struct NotWritten : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Database {
 public:
  explicit Database(const fs::path& file) {
    const int opened = sqlite3_open_v2(file.c_str(), &handle_,
                                       SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    if (opened == SQLITE_OK) return;
    const std::string why = sqlite3_errmsg(handle_);
    sqlite3_close(handle_);
    throw NotWritten(why);
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  sqlite3* handle() const { return handle_; }
  void run(const std::string& sql) {
    check(sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr));
  }
  void check(int outcome) {
    if (outcome != SQLITE_OK && outcome != SQLITE_DONE) throw NotWritten(sqlite3_errmsg(handle_));
  }

 private:
  sqlite3* handle_ = nullptr;
};

class Statement {
 public:
  Statement(Database& database, const std::string& sql) : database_(database) {
    database.check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle_, nullptr));
  }
  ~Statement() { sqlite3_finalize(handle_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& put(const FeatureValue& value) {
    const int place = ++bound_;
    database_.check(std::visit(
        [&]<class T>(const T& held) {
          if constexpr (std::is_same_v<T, std::monostate>)
            return sqlite3_bind_null(handle_, place);
          else if constexpr (std::is_same_v<T, double>)
            return sqlite3_bind_double(handle_, place, held);
          else if constexpr (std::is_same_v<T, std::string>)
            return sqlite3_bind_text64(handle_, place, held.data(), held.size(), SQLITE_TRANSIENT,
                                       SQLITE_UTF8);
          else
            return sqlite3_bind_int64(handle_, place, held);
        },
        value));
    return *this;
  }
  Statement& put(const std::vector<std::uint8_t>& bytes) {
    database_.check(
        sqlite3_bind_blob64(handle_, ++bound_, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
    return *this;
  }
  void run() {
    database_.check(sqlite3_step(handle_));
    database_.check(sqlite3_reset(handle_));
    bound_ = 0;
  }

 private:
  Database& database_;
  sqlite3_stmt* handle_ = nullptr;
  int bound_ = 0;
};

std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

template <class T>
void append(std::vector<std::uint8_t>& out, const T& value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()},
      high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& place) {
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
};

Box box_of(const Feature& feature) {
  Box box;
  for (const query::FlatPolygon& polygon : feature.geometry)
    for (const query::FlatRing& ring : polygon.rings)
      for (const glm::dvec3& place : ring) box.add(place);
  return box;
}

// Codes of well-known binary (ISO 13249-3). The codes for geometries with z are 1000 higher.
constexpr std::uint32_t kPoint = 1001, kLine = 1002, kPolygon = 1003, kMultiPolygon = 1006;

void append_head(std::vector<std::uint8_t>& out, std::uint32_t type) {
  out.push_back(1);  // little-endian
  append(out, type);
}

void append_path(std::vector<std::uint8_t>& out, const query::FlatRing& ring, bool closed) {
  append(out, static_cast<std::uint32_t>(ring.size() + (closed ? 1 : 0)));
  for (std::size_t i = 0; i < ring.size() + (closed ? 1 : 0); ++i)
    append(out, ring[i % ring.size()]);
}

// Returns a GeoPackageBinary (clause 2.1.3). It consists of a header with the envelope in x, y and
// z, followed by well-known binary.
std::vector<std::uint8_t> blob_of(const Feature& feature, FeatureKind kind, std::int32_t srs) {
  constexpr std::uint8_t kLittleEndian = 1, kEnvelopeOfThree = 2 << 1;
  std::vector<std::uint8_t> out{'G', 'P', 0, kLittleEndian | kEnvelopeOfThree};
  append(out, srs);
  const Box box = box_of(feature);
  for (int axis = 0; axis < 3; ++axis) {
    append(out, box.low[axis]);
    append(out, box.high[axis]);
  }
  if (kind == FeatureKind::areas) {
    append_head(out, kMultiPolygon);
    append(out, static_cast<std::uint32_t>(feature.geometry.size()));
    for (const query::FlatPolygon& polygon : feature.geometry) {
      append_head(out, kPolygon);
      append(out, static_cast<std::uint32_t>(polygon.rings.size()));
      for (const query::FlatRing& ring : polygon.rings) append_path(out, ring, true);
    }
    return out;
  }
  const query::FlatRing& path = feature.geometry.front().rings.front();
  append_head(out, kind == FeatureKind::points ? kPoint : kLine);
  if (kind == FeatureKind::points)
    append(out, path.front());
  else
    append_path(out, path, false);
  return out;
}

const char* type_of(FeatureField::Kind kind) {
  switch (kind) {
    case FeatureField::Kind::boolean: return "BOOLEAN";
    case FeatureField::Kind::integer: return "INTEGER";
    case FeatureField::Kind::real: return "DOUBLE";
    case FeatureField::Kind::text: return "TEXT";
  }
  return "TEXT";
}

const char* geometry_type(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::areas: return "MULTIPOLYGON";
    case FeatureKind::lines: return "LINESTRING";
    case FeatureKind::points: return "POINT";
  }
  return "GEOMETRY";
}

void write_table(Database& database, const FeatureSet& set, const FeatureTable& table, int srs) {
  std::string columns = "CREATE TABLE " + quoted(table.name) +
                        " (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom " +
                        geometry_type(table.kind);
  std::string insert = "INSERT INTO " + quoted(table.name) + " VALUES (NULL, ?";
  for (const FeatureField& field : table.fields) {
    columns += ", " + quoted(field.name) + " " + type_of(field.kind);
    insert += ", ?";
  }
  database.run(columns + ")");
  Statement row(database, insert + ")");
  Box box;
  for (const Feature& feature : table.features) {
    check_question();
    if (feature.geometry.empty()) {
      row.put(FeatureValue{});
    } else {
      row.put(blob_of(feature, table.kind, srs));
      const Box own = box_of(feature);
      box.add(own.low);
      box.add(own.high);
    }
    for (const FeatureValue& value : feature.values) row.put(value);
    row.run();
  }
  const auto side = [&](double value) {
    return box.low.x <= box.high.x ? FeatureValue(value) : FeatureValue{};
  };
  Statement(
      database,
      "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, min_x, min_y, max_x, max_y, "
      "srs_id) VALUES (?, 'features', ?, ?, ?, ?, ?, ?, ?)")
      .put(table.name)
      .put(table.name)
      .put(set.description)
      .put(side(box.low.x))
      .put(side(box.low.y))
      .put(side(box.high.x))
      .put(side(box.high.y))
      .put(std::int64_t{srs})
      .run();
  Statement(database, "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, 1, 0)")
      .put(table.name)
      .put(std::string(geometry_type(table.kind)))
      .put(std::int64_t{srs})
      .run();
}

void write(const FeatureSet& set, const fs::path& file) {
  Database database(file);
  database.run(kLayout);
  const int srs = set.epsg != 0 ? set.epsg : kUndefinedCartesian;
  if (set.epsg != 0) {
    const std::string name = "EPSG:" + std::to_string(set.epsg);
    Statement(database,
              "INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES (?, ?, 'EPSG', ?, 'undefined', ?)")
        .put(name)
        .put(std::int64_t{set.epsg})
        .put(std::int64_t{set.epsg})
        .put(name)
        .run();
  }
  for (const FeatureTable& table : set.tables) write_table(database, set, table, srs);
  database.run("COMMIT");
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> geopackage(const FeatureSet& set,
                                                        const fs::path& folder) {
  auto file = std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".gpkg"));
  file->name = set.name + ".gpkg";
  file->media_type = kGeoPackageType;
  try {
    write(set, file->path);
  } catch (const NotWritten& error) {
    log::error(std::string("a GeoPackage could not be written: ") + error.what());
    return fail(ErrorCode::storage_full, "GeoPackage not written",
                "The server could not write a temporary file; its disk may be full. Request "
                "GeoJSON instead, which needs no temporary file.",
                "f");
  }
  std::error_code ignored;
  file->bytes = fs::file_size(file->path, ignored);
  return file;
}

}  // namespace strata::app
