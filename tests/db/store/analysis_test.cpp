// The views for analysts: names, and positions as well-known text, which GIS programs draw.
#include <gtest/gtest.h>

#include "db/journal_painter.h"
#include "store/content/layers.h"
#include "store/pg/pg.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {
namespace {

class Analysis : public ::testing::Test {
 protected:
  // Returns one value as text, or nothing for NULL.
  std::optional<std::string> ask(const std::string& sql) {
    const auto rows = connection_->query_once("SELECT (" + sql + ")::text");
    EXPECT_TRUE(rows) << sql << ": " << (rows ? "" : rows.error().detail);
    if (!rows || rows->rows() != 1) return "no single row";
    return rows->null(0, 0) ? std::nullopt : std::optional<std::string>(rows->text(0, 0));
  }
  void run(const std::string& sql) { ASSERT_TRUE(connection_->script(sql)) << sql; }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Result<PgConnection> connection_ = PgConnection::connect(dsn_);
  const Model model_ = test::make_model(*store_);
};

Column feature_column(const std::string& name, ColumnKind kind,
                      Visibility visibility = Visibility::everyone) {
  Column column;
  column.name = name;
  column.kind = kind;
  column.visibility = visibility;
  return column;
}

TEST_F(Analysis, an_area_has_its_middle_as_a_point_in_the_models_system) {
  Layer layer;
  layer.model_id = model_.id;
  layer.name = "Cracks";
  layer.palette = default_palette(layer.type, true);
  layer.labels = {{"de", "Risse"}};
  layer = store_->layers().create(layer).value();
  const std::string id = to_string(layer.id);
  run("INSERT INTO tile_sums VALUES (" + id +
      ", 0, 0, '{1,2}', '{4,0}', '{2,0}', '{3,0}', '{5,0}', '{1,0}', '{0,0}', '{0,0}', '{0,0}', '{1,1}', '{1,1}', '{1,1}')");
  run("UPDATE all_models SET origin = '{100,200,300}', crs = 'EPSG:25832'");
  EXPECT_EQ(ask("SELECT geometry_wkt FROM analysis.areas WHERE key = 1"),
            "POINT Z (101.5 202.5 300.5)");
  EXPECT_EQ(ask("SELECT geometry_wkt FROM analysis.areas WHERE key = 2"), std::nullopt)
      << "no area, no middle";
  EXPECT_EQ(ask("SELECT srid FROM analysis.areas WHERE key = 1"), "25832");
  EXPECT_EQ(ask("SELECT srid FROM analysis.models"), "25832");
  run("UPDATE all_models SET crs = ''");
  EXPECT_EQ(ask("SELECT srid FROM analysis.areas WHERE key = 1"), std::nullopt);
  EXPECT_EQ(ask("SELECT labels ->> 'de' FROM analysis.layers"), "Risse");
  EXPECT_EQ(ask("SELECT descriptions::text FROM analysis.layers"), "{}");
}

TEST_F(Analysis, lines_and_points_of_records_are_well_known_text) {
  Table table;
  table.project_id = model_.project_id;
  table.name = "Damage";
  table.columns = {feature_column("Crack", ColumnKind::line),
                   feature_column("Sample", ColumnKind::point),
                   feature_column("Tomb", ColumnKind::point, Visibility::curators),
                   feature_column("Crack (wkt)", ColumnKind::text)};
  table = store_->tables().create(table).value();
  EXPECT_EQ(
      ask("SELECT string_agg(attname, ', ' ORDER BY attnum) FROM pg_attribute WHERE attrelid = "
          "'analysis.\"Damage\"'::regclass AND attnum > 0"),
      "key, Crack, Sample, Crack (wkt), Crack (c" + to_string(table.columns[0].id) +
          ", wkt), Sample (wkt)");
  const std::string model = to_string(model_.id);
  const auto json = [&](const std::string& places) {
    return nlohmann::json::parse("[{\"model\": " + model + ", \"coordinates\": " + places + "}]");
  };
  RecordInput input{1, {}, {}};
  input.values[table.columns[0].id] = json("[[0, 0.5, 1], [2, 3, 4]]");
  input.values[table.columns[0].id].push_back(json("[[5, 5, 5], [6, 6, 6]]")[0]);
  input.values[table.columns[1].id] = json("[[4500000.25, 7, -1]]");
  WriteRecords request;
  request.records = {input, {2, {}, {}}};
  const auto written = store_->records().write(table.id, request, "ana");
  ASSERT_TRUE(written && written->problems.empty());
  const std::string crack = "\"Crack (c" + to_string(table.columns[0].id) + ", wkt)\"";
  EXPECT_EQ(ask("SELECT " + crack + " FROM analysis.\"Damage\" WHERE key = 1"),
            "MULTILINESTRING Z ((0.0 0.5 1.0, 2.0 3.0 4.0), (5.0 5.0 5.0, 6.0 6.0 6.0))");
  EXPECT_EQ(ask("SELECT \"Sample (wkt)\" FROM analysis.\"Damage\" WHERE key = 1"),
            "MULTIPOINT Z ((4500000.25 7.0 -1.0))");
  EXPECT_EQ(ask("SELECT " + crack + " FROM analysis.\"Damage\" WHERE key = 2"), std::nullopt);
  EXPECT_EQ(ask("SELECT analysis.wkt(\"Sample\", " + model +
                " + 1) FROM analysis.\"Damage\" WHERE key = 1"),
            std::nullopt)
      << "of another model";
}

TEST_F(Analysis, systems_that_are_no_epsg_codes_have_no_number) {
  for (const char* crs : {"", "EPSG:", "EPSG:x", "epsg:4", "EPSG:12345678901", "WKT"})
    EXPECT_EQ(ask(std::string("SELECT analysis.srid('") + crs + "')"), std::nullopt) << crs;
}

}  // namespace
}  // namespace strata::store
