#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/digest.h"
#include "core/text/hex.h"
#include "jobs/import_job.h"
#include "media/picture.h"
#include "mesh/io/load.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/content/surface_images.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"
#include "strata_dirs.h"
#include "support/test_cluster.h"
#include "support/zip_files.h"

namespace strata::jobs {
namespace {

const std::filesystem::path kData = STRATA_TEST_DATA;

std::vector<std::uint8_t> read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Import : public ::testing::Test {
 protected:
  ImportRequest request(const std::string& filename, const std::string& content) {
    const auto path = folder_.path() / "upload";
    std::ofstream(path, std::ios::binary) << content;
    ImportRequest request;
    request.files = {{filename, path}};
    return request;
  }
  std::int64_t count(const std::string& table) {
    return store::PgConnection::connect(dsn_)
        ->query(("SELECT count(*) FROM " + table).c_str())
        ->integer(0, 0);
  }
  void expect_nothing_left() {
    for (const char* table : {"models", "model_sources", "blobs", "blob_chunks"})
      EXPECT_EQ(count(table), 0) << table;
  }

  test::TemporaryFolder folder_;
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<store::Store> store_ = test::open_store(dsn_);
  Progress progress_;
};

// Returns two adjacent squares. `second_square` contains the second square's texture coordinates.
std::string obj_with_uvs(const std::string& second_square) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
         "vt 0.05 0.05\nvt 0.45 0.05\nvt 0.45 0.45\nvt 0.05 0.45\n" +
         second_square + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 2/5 5/6 6/7\nf 2/5 6/7 3/8\n";
}
const std::string kApart = "vt 0.55 0.55\nvt 0.95 0.55\nvt 0.95 0.95\nvt 0.55 0.95\n";
const std::string kOnTop = "vt 0.05 0.05\nvt 0.45 0.05\nvt 0.45 0.45\nvt 0.05 0.45\n";

TEST_F(Import, a_real_scan_becomes_a_model_that_holds_all_of_it) {
  const auto file = kData / "gargoyle_3dhop_50k_colour_normals.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "SKIPPED: no scan at " << file;
  ImportRequest request;
  request.files = {{"C:\\scans\\Gárgola 7.PLY", file}};
  request.unit = Unit::mm;
  request.up = "y";
  request.crs = "EPSG:25830";
  request.resolution = 4096;
  const auto model = import_model(*store_, request, progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(progress_.fraction(), 1);

  Progress other;
  const auto loaded = mesh::load_mesh(file, "x.ply", other);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(model->name, "Gárgola 7");
  EXPECT_EQ(model->triangles, loaded->mesh.triangle_count());
  EXPECT_NEAR(model->area, mesh::surface_area(loaded->mesh), 1e-9 * model->area);
  EXPECT_EQ(model->unit, Unit::mm);
  EXPECT_FALSE(model->unit_assumed);
  EXPECT_EQ(model->up, "y");
  EXPECT_EQ(model->crs, "EPSG:25830");
  EXPECT_EQ(model->default_resolution, 4096);
  EXPECT_EQ(model->atlas.source, "made");
  EXPECT_EQ(model->atlas.lowest_resolution, 2048);
  EXPECT_GT(model->atlas.coverage, 0.2);
  glm::dvec3 low(1e300), high(-1e300);
  for (const auto& p : loaded->mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_EQ(model->bounds_min, low);
  EXPECT_EQ(model->bounds_max, high);

  const auto stored = store_->models().geometry(model->id);
  ASSERT_TRUE(stored);
  const auto geometry = mesh::decode_geometry(*stored);
  ASSERT_TRUE(geometry);
  EXPECT_EQ(geometry->triangle_count(), model->triangles);
  EXPECT_EQ(geometry->positions.size(), model->vertices);
  EXPECT_EQ(geometry->origin, model->origin);

  ASSERT_EQ(model->source_files.size(), 1u);
  EXPECT_EQ(model->source_files[0].name, "Gárgola 7.PLY");
  EXPECT_EQ(model->source_files[0].sha256, to_hex(sha256(read_file(file))));
}

TEST_F(Import, texture_coordinates_that_can_carry_layers_are_kept) {
  const auto model = import_model(*store_, request("two.obj", obj_with_uvs(kApart)), progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(model->atlas.source, "file");
  EXPECT_TRUE(model->repairs.empty());
  // Two adjacent squares have one rim, of 2 × 1.
  ASSERT_TRUE(model->open_edges);
  EXPECT_EQ(model->open_edges->loops, 1u);
  EXPECT_DOUBLE_EQ(model->open_edges->length, 6);
  EXPECT_EQ(model->open_edges->longest, std::vector<double>{6});
  EXPECT_TRUE(model->unit_assumed);
  EXPECT_EQ(model->unit, Unit::m);
  EXPECT_EQ(model->up, "z");
  EXPECT_EQ(model->default_resolution, 2048);
}

TEST_F(Import, texture_coordinates_that_overlap_are_replaced_and_the_report_says_why) {
  const auto model = import_model(*store_, request("two.obj", obj_with_uvs(kOnTop)), progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(model->atlas.source, "made");
  ASSERT_EQ(model->repairs.size(), 1u);
  EXPECT_THAT(model->repairs[0].what, ::testing::StartsWith("texture coordinates not kept: "));
  EXPECT_EQ(model->repairs[0].count, 4u);
}

TEST_F(Import, a_textured_scan_keeps_its_files_and_its_picture_becomes_the_first_look) {
  auto import_request = request("pot.obj", "mtllib pot.mtl\nusemtl skin\n" + obj_with_uvs(kApart));
  const std::vector<std::uint8_t> rgba(64 * 64 * 4, 200);
  const auto png = encode_png(rgba, 64, 64);
  const auto add = [&](const std::string& name, const std::string& content) {
    const auto path = folder_.path() / std::filesystem::path(name).filename();
    std::ofstream(path, std::ios::binary) << content;
    import_request.files.push_back({name, path});
  };
  add("pot.mtl", "newmtl skin\nmap_Kd a\\skin.png\n");
  add("a/skin.png", {png.begin(), png.end()});
  import_request.strict = true;
  const auto model = import_model(*store_, import_request, progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(model->name, "pot");
  ASSERT_EQ(model->source_files.size(), 3u);
  EXPECT_EQ(model->source_files[2].name, "skin.png");
  EXPECT_EQ(model->source_files[2].sha256, to_hex(sha256(png)));
  const auto images = store_->surface_images().of_model(model->id);
  ASSERT_TRUE(images);
  ASSERT_EQ(images->size(), 1u);
  EXPECT_EQ((*images)[0].name, "Base colour");
  EXPECT_EQ((*images)[0].media_type, "image/png");
  EXPECT_EQ((*images)[0].width, 64);
  EXPECT_EQ((*images)[0].sha256, to_hex(sha256(png))) << "byte for byte";
}

TEST_F(Import, a_zip_is_kept_as_it_is_and_what_is_in_it_is_imported) {
  const std::string zip = test::zip_of(
      {{"scan/pot.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}, {"readme.txt", "hello"}});
  const auto model = import_model(*store_, request("excavation.zip", zip), progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(model->name, "excavation");
  ASSERT_EQ(model->source_files.size(), 1u);
  EXPECT_EQ(model->source_files[0].name, "excavation.zip");
  EXPECT_EQ(model->source_files[0].bytes, zip.size());
  EXPECT_FALSE(import_model(*store_, request("empty.zip", test::zip_of({{"readme.txt", "hello"}})),
                            progress_));
}

TEST_F(Import, vertices_within_the_weld_distance_are_joined) {
  auto import_request = request(
      "gap.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.01 0 0\nv 1 1 0\nv 0 1.01 0\nf 1 2 3\nf 4 5 6\n");
  import_request.weld_distance = 0.05;
  import_request.strict = true;  // a weld is not a fault
  const auto model = import_model(*store_, import_request, progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_EQ(model->vertices, 4u);
  import_request.weld_distance = -1;
  EXPECT_EQ(import_model(*store_, import_request, progress_).error().field, "weld");
}

TEST_F(Import, a_bad_file_is_refused_and_leaves_nothing_behind) {
  const std::string cut =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n";
  for (const auto& [filename, content] :
       std::vector<std::pair<std::string, std::string>>{{"cut.ply", cut},
                                                        {"empty.ply", ""},
                                                        {"text.obj", "v 0 0 0\nf 1 2 3\n"},
                                                        {"picture.jpg", "JFIF"}}) {
    const auto model = import_model(*store_, request(filename, content), progress_);
    ASSERT_FALSE(model) << filename;
    EXPECT_GE(model.error().code, ErrorCode::malformed) << filename;
    EXPECT_LT(model.error().code, ErrorCode::internal) << filename;
    EXPECT_FALSE(model.error().detail.empty()) << filename;
  }
  expect_nothing_left();
}

TEST_F(Import, a_file_that_is_not_there_is_refused) {
  ImportRequest missing;
  missing.files = {{"scan.ply", folder_.path() / "nowhere"}};
  EXPECT_FALSE(import_model(*store_, missing, progress_));
  expect_nothing_left();
}

TEST_F(Import, strict_refuses_a_file_that_needs_repair_and_says_which) {
  auto import_request =
      request("twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 2 2\n");
  import_request.strict = true;
  const auto refused = import_model(*store_, import_request, progress_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_THAT(refused.error().detail, ::testing::HasSubstr("degenerate"));
  expect_nothing_left();
  import_request.strict = false;
  const auto model = import_model(*store_, import_request, progress_);
  ASSERT_TRUE(model) << model.error().detail;
  EXPECT_FALSE(model->repairs.empty());
}

TEST_F(Import, options_that_mean_nothing_are_refused_with_their_field) {
  const auto good = request("two.obj", obj_with_uvs(kApart));
  auto field_of = [&](auto change) {
    ImportRequest bad = good;
    change(bad);
    const auto model = import_model(*store_, bad, progress_);
    return model ? std::string("imported") : model.error().field;
  };
  EXPECT_EQ(field_of([](auto& r) { r.up = "w"; }), "up");
  EXPECT_EQ(field_of([](auto& r) { r.crs = "WGS84"; }), "crs");
  EXPECT_EQ(field_of([](auto& r) { r.crs = "EPSG:"; }), "crs");
  EXPECT_EQ(field_of([](auto& r) { r.resolution = 3000; }), "resolution");
  EXPECT_EQ(field_of([](auto& r) { r.resolution = 32768; }), "resolution");
  EXPECT_EQ(field_of([](auto& r) { r.files[0].filename = "folder/"; }), "filename");
  ImportRequest lost = good;
  lost.project = "nowhere";
  EXPECT_EQ(import_model(*store_, lost, progress_).error().code, ErrorCode::not_found);
  expect_nothing_left();
}

TEST_F(Import, a_cancel_at_any_time_leaves_nothing_behind) {
  const auto file = kData / "vessel_lekythos_gigamesh_15k.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "SKIPPED: no scan at " << file;
  ImportRequest scan;
  scan.files = {{"lekythos.ply", file}};
  for (const double from : {0.0, 0.1, 0.2, 0.5, 0.8, 0.9}) {
    Progress progress;
    std::atomic<bool> over{false};
    std::thread canceller([&] {
      while (!over && progress.fraction() < from)
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      progress.cancel();
    });
    const auto model = import_model(*store_, scan, progress);
    over = true;
    canceller.join();
    // A late cancel may have no effect. Then the model is complete.
    if (model) {
      EXPECT_GE(from, 0.8);
      EXPECT_TRUE(store_->models().remove(model->id));
      continue;
    }
    EXPECT_EQ(model.error().code, ErrorCode::cancelled);
    EXPECT_EQ(count("models"), 0);
    EXPECT_EQ(count("model_sources"), 0);
  }
}

TEST_F(Import, the_demo_has_its_two_layers_and_asking_twice_makes_one) {
  const auto demo = make_demo(*store_, progress_, 0.1);
  ASSERT_TRUE(demo) << demo.error().detail;
  EXPECT_EQ(demo->name, "Demo pot");
  EXPECT_EQ(demo->unit, Unit::mm);
  EXPECT_TRUE(demo->scale_verified);
  const auto project = store_->projects().find("demo");
  ASSERT_TRUE(project);
  EXPECT_EQ(demo->project_id, project->id);
  EXPECT_EQ(demo->sequence, 2);

  const auto layers = store_->layers().of_model(demo->id, Role::owner);
  ASSERT_TRUE(layers);
  ASSERT_EQ(layers->size(), 2u);
  EXPECT_EQ((*layers)[0].slug, "pieces");
  EXPECT_EQ((*layers)[1].slug, "cracks");
  Progress baking;
  const auto geometry = mesh::decode_geometry(*store_->models().geometry(demo->id));
  ASSERT_TRUE(geometry);
  const auto map = mesh::bake_surface_map(*geometry, 2048, baking);
  ASSERT_TRUE(map);
  const auto pieces = store_->journal().load_tiles((*layers)[0]),
             cracks = store_->journal().load_tiles((*layers)[1]);
  ASSERT_TRUE(pieces && cracks);
  std::uint64_t covered = 0, cracked = 0;
  for (const auto& [address, tile] : pieces->tiles) {
    const TileMask owned = map->owned_in_tile(address);
    EXPECT_TRUE(tile->valid == owned) << "the gutter holds what its owners hold";
    const TileMask surface = map->surface_in_tile(address);
    for (int i = 0; i < kMaskWords; ++i)
      covered += std::popcount(surface.words[i] & tile->valid.words[i]);
  }
  for (const auto& [address, tile] : cracks->tiles) cracked += tile->valid.count();
  EXPECT_EQ(covered, map->surface_texels) << "the sherds cover the whole pot";
  EXPECT_GT(cracked, map->surface_texels / 100);
  EXPECT_LT(cracked, map->surface_texels / 4);

  const auto history = store_->journal().history((*layers)[0].id, 10, 0);
  ASSERT_TRUE(history);
  ASSERT_EQ(history->rows.size(), 1u);
  EXPECT_EQ(history->rows[0].op, "fill");
  EXPECT_EQ(history->rows[0].record["rule"], "sherds of the demo pot");
  EXPECT_NEAR(history->rows[0].answer["area_m2"].get<double>(), demo->area_m2(),
              1e-3 * demo->area_m2());

  const auto again = make_demo(*store_, progress_, 0.1);
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(again->id, demo->id);
  EXPECT_EQ(again->sequence, 2);
  EXPECT_EQ(count("models"), 1);
  EXPECT_EQ(count("layers"), 2);
  EXPECT_EQ(count("edits"), 2);
}

}  // namespace
}  // namespace strata::jobs
