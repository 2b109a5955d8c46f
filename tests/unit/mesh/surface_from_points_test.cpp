#include "mesh/points/surface_from_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <random>
#include <set>

#include "mesh/io/load.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using mesh::PointOptions;
using mesh::TriangleMesh;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double kPi = std::numbers::pi;

// Evenly spread points on the sphere with radius 1 (a Fibonacci lattice).
std::vector<glm::dvec3> sphere(int count) {
  std::vector<glm::dvec3> points;
  const double golden = kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    points.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return points;
}

double signed_volume(const TriangleMesh& mesh, const glm::dvec3& center) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](int k) { return mesh.positions[mesh.triangles[t + k]] - center; };
    sum += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
  }
  return sum;
}

// The number of edges that belong to only one triangle.
std::size_t open_edges(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> open;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    for (int k = 0; k < 3; ++k) {
      const auto a = mesh.triangles[t + k], b = mesh.triangles[t + (k + 1) % 3];
      if (!open.erase({b, a})) open.insert({a, b});
    }
  return open.size();
}

class SurfaceFromPoints : public testing::Test {
 protected:
  SurfaceFromPoints() {
    folder_ = fs::temp_directory_path() / ("points-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    options_.folder = folder_;
  }
  ~SurfaceFromPoints() override {
    EXPECT_TRUE(fs::is_empty(folder_)) << "temporary files remain";
    fs::remove_all(folder_);
    unsetenv("STRATA_MESHER");
  }

  Result<strata::SurfaceFromPoints> make(TriangleMesh& mesh) {
    return mesh::surface_from_points(mesh, normals_, options_, progress_);
  }

  // Starts this script instead of the program.
  void start_instead(const std::string& script) {
    program_ = folder_.string() + ".sh";
    std::ofstream(program_) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program_, fs::perms::owner_all);
    setenv("STRATA_MESHER", program_.c_str(), 1);
  }

  fs::path folder_, program_;
  PointOptions options_;
  std::vector<glm::vec3> normals_;
  Progress progress_;
};

TEST_F(SurfaceFromPoints, a_sphere_is_closed_and_has_its_area_and_volume) {
  TriangleMesh mesh;
  mesh.positions = sphere(20'000);
  const double spacing = std::sqrt(4 * kPi / 20'000);
  const auto facts = make(mesh);
  ASSERT_TRUE(facts) << facts.error().detail;
  EXPECT_EQ(facts->points, 20'000u);
  EXPECT_EQ(facts->used, 20'000u);
  EXPECT_NEAR(facts->point_spacing, spacing, 0.15 * spacing);
  EXPECT_LT(facts->cell, 1.5 * 1.415 * facts->point_spacing);
  EXPECT_LT(facts->distance_median, 0.1 * spacing);
  EXPECT_LT(facts->distance_95, 0.3 * spacing);
  EXPECT_NEAR(surface_area(mesh), 4 * kPi, 0.02 * 4 * kPi);
  EXPECT_NEAR(signed_volume(mesh, {}), 4 * kPi / 3, 0.02 * 4) << "its outside is outside";
  EXPECT_EQ(open_edges(mesh), 0u);
  for (const auto& p : mesh.positions) ASSERT_NEAR(glm::length(p), 1, 0.01);
}

TEST_F(SurfaceFromPoints, the_side_that_was_not_scanned_stays_open) {
  TriangleMesh mesh;
  for (const auto& p : sphere(20'000))
    if (p.z > 0) mesh.positions.push_back(p);
  const auto facts = make(mesh);
  ASSERT_TRUE(facts) << facts.error().detail;
  EXPECT_GT(open_edges(mesh), 50u);
  // The rim extends a little over the last points.
  EXPECT_NEAR(surface_area(mesh), 2 * kPi, 2 * kPi * 4 * facts->point_spacing);
  for (const auto& p : mesh.positions) ASSERT_GT(p.z, -4 * facts->point_spacing);
}

TEST_F(SurfaceFromPoints, a_hole_is_closed_only_up_to_the_gap) {
  const auto with_hole = [] {
    TriangleMesh mesh;
    for (const auto& p : sphere(20'000))
      if (p.z < std::cos(0.2)) mesh.positions.push_back(p);  // the hole is 0.4 wide
    return mesh;
  };
  TriangleMesh open = with_hole(), closed = with_hole();
  options_.gap = 0.2;
  ASSERT_TRUE(make(open));
  options_.gap = 0.6;
  ASSERT_TRUE(make(closed));
  EXPECT_GT(open_edges(open), 10u);
  EXPECT_EQ(open_edges(closed), 0u);
}

TEST_F(SurfaceFromPoints, a_longer_edge_gives_fewer_triangles) {
  TriangleMesh fine, coarse;
  fine.positions = coarse.positions = sphere(20'000);
  ASSERT_TRUE(make(fine));
  options_.cell = 0.15;
  const auto facts = make(coarse);
  ASSERT_TRUE(facts);
  EXPECT_LE(facts->cell, 0.15);
  EXPECT_LT(coarse.triangle_count() * 3, fine.triangle_count());
}

// The coordinates of a survey have 7 digits before the point.
TEST_F(SurfaceFromPoints, coordinates_of_a_survey_keep_their_precision) {
  const glm::dvec3 place(691'000.5, 5'335'000.25, 515);
  TriangleMesh mesh;
  for (const auto& p : sphere(5000)) mesh.positions.push_back(place + p);
  const auto facts = make(mesh);
  ASSERT_TRUE(facts) << facts.error().detail;
  for (const auto& p : mesh.positions) ASSERT_NEAR(glm::length(p - place), 1, 0.02);
  EXPECT_NEAR(signed_volume(mesh, place), 4 * kPi / 3, 0.15);
}

// A plane has no inside. Its upper side is that of a floor or of terrain.
TEST_F(SurfaceFromPoints, terrain_faces_up) {
  TriangleMesh mesh;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 80; ++x)
      mesh.positions.emplace_back(x, y, 4 * std::sin(x / 12.0) * std::cos(y / 15.0));
  ASSERT_TRUE(make(mesh));
  double up = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](int k) { return mesh.positions[mesh.triangles[t + k]]; };
    up += glm::cross(at(1) - at(0), at(2) - at(0)).z / 2;
  }
  EXPECT_NEAR(up, 79 * 79, 4 * 79 * 3.5) << "the rim extends by three points or less";
}

TEST_F(SurfaceFromPoints, normals_of_the_file_decide_the_side) {
  TriangleMesh mesh;
  mesh.positions = sphere(5000);
  for (const auto& p : mesh.positions) normals_.emplace_back(-3.0 * p);  // of a vault, seen inside
  ASSERT_TRUE(make(mesh));
  EXPECT_NEAR(signed_volume(mesh, {}), -4 * kPi / 3, 0.15);
}

TEST_F(SurfaceFromPoints, bad_normals_are_estimated_instead) {
  TriangleMesh mesh;
  mesh.positions = sphere(5000);
  normals_.assign(5000, glm::vec3(0));
  normals_[7] = glm::vec3(NAN, 0, 1);
  ASSERT_TRUE(make(mesh));
  EXPECT_NEAR(signed_volume(mesh, {}), 4 * kPi / 3, 0.15);
}

TEST_F(SurfaceFromPoints, colors_stay_in_their_places) {
  constexpr std::uint32_t kRed = 0xff0000ff, kBlue = 0xffff0000;
  TriangleMesh mesh;
  mesh.positions = sphere(5000);
  for (const auto& p : mesh.positions) mesh.vertex_colors.push_back(p.z > 0 ? kRed : kBlue);
  ASSERT_TRUE(make(mesh));
  ASSERT_EQ(mesh.vertex_colors.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto red = mesh.vertex_colors[i] & 255, blue = mesh.vertex_colors[i] >> 16 & 255;
    const double z = mesh.positions[i].z;
    ASSERT_TRUE(z < 0.2 || (red > 200 && blue < 55)) << red << " " << blue;
    ASSERT_TRUE(z > -0.2 || (red < 55 && blue > 200)) << red << " " << blue;
  }
}

TEST_F(SurfaceFromPoints, points_without_a_place_are_left_out) {
  TriangleMesh mesh;
  mesh.positions = sphere(5000);
  mesh.positions[10].x = NAN;
  mesh.positions[4000].z = INFINITY;
  const auto facts = make(mesh);
  ASSERT_TRUE(facts) << facts.error().detail;
  EXPECT_EQ(facts->points, 5000u);
  EXPECT_EQ(facts->used, 4998u);
}

TEST_F(SurfaceFromPoints, points_without_a_surface_are_refused) {
  TriangleMesh few, line, place;
  few.positions = sphere(49);
  for (int i = 0; i < 200; ++i) line.positions.emplace_back(i, 2 * i, 3 * i);
  place.positions.assign(200, glm::dvec3(1, 2, 3));
  const auto too_few = make(few);
  ASSERT_FALSE(too_few);
  EXPECT_EQ(too_few.error().code, ErrorCode::invalid);
  EXPECT_THAT(too_few.error().detail, HasSubstr("49 vertices but no triangle"));
  const auto one_place = make(place);
  ASSERT_FALSE(one_place);
  EXPECT_EQ(one_place.error().code, ErrorCode::invalid);
  EXPECT_THAT(one_place.error().detail, HasSubstr("no surface could be made"));
  const auto of_line = make(line);  // any result but a crash
  EXPECT_TRUE(of_line || of_line.error().code == ErrorCode::invalid) << of_line.error().detail;
}

TEST_F(SurfaceFromPoints, a_cancel_ends_the_program) {
  class CancelsInTheMiddle : public Progress {
   public:
    bool cancelled() const override { return fraction() > 0.75 || Progress::cancelled(); }
  } progress;
  TriangleMesh mesh;
  mesh.positions = sphere(100'000);
  const auto facts = mesh::surface_from_points(mesh, normals_, options_, progress);
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().code, ErrorCode::cancelled);
}

TEST_F(SurfaceFromPoints, faults_of_the_program_are_named) {
  const std::pair<std::string, std::pair<ErrorCode, std::string>> faults[] = {
      {"exit 4", {ErrorCode::out_of_memory, "cell"}},
      {"exit 5", {ErrorCode::invalid, "no surface could be made"}},
      {"echo the library is missing >&2; exit 127", {ErrorCode::internal, "library is missing"}},
      {"kill -9 $$", {ErrorCode::internal, "ended by the system"}},
      {"exit 0", {ErrorCode::internal, "damaged"}},
      {"head -c 100 /dev/urandom > $2", {ErrorCode::internal, "damaged"}},
      {"printf STRSRF01 > $2; head -c 4000 /dev/zero | tr '\\0' '\\377' >> $2",
       {ErrorCode::internal, "damaged"}}};
  for (const auto& [script, expected] : faults) {
    start_instead(script);
    TriangleMesh mesh;
    mesh.positions = sphere(100);
    const auto facts = make(mesh);
    ASSERT_FALSE(facts) << script;
    EXPECT_EQ(facts.error().code, expected.first) << script;
    EXPECT_THAT(facts.error().detail, HasSubstr(expected.second)) << script;
  }
  fs::remove(program_);
}

TEST_F(SurfaceFromPoints, a_missing_program_is_named) {
  setenv("STRATA_MESHER", "/nowhere/strata-mesher", 1);
  TriangleMesh mesh;
  mesh.positions = sphere(100);
  const auto facts = make(mesh);
  ASSERT_FALSE(facts);
  EXPECT_THAT(facts.error().detail, HasSubstr("/nowhere/strata-mesher"));
}

TEST(ThinnedPoints, one_point_remains_in_each_cell) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<glm::dvec3> points;
  // half of them in a hundredth of the area
  for (int i = 0; i < 100'000; ++i) {
    const double size = i % 2 ? 0.1 : 1;
    points.emplace_back(size * unit(random), size * unit(random), 0);
  }
  const auto kept = mesh::thinned(points, 10'000);
  EXPECT_LE(kept.size(), 10'000u);
  EXPECT_GE(kept.size(), 5000u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  const auto dense = std::count_if(kept.begin(), kept.end(),
                                   [&](auto i) { return points[i].x < 0.1 && points[i].y < 0.1; });
  EXPECT_LT(dense, std::ptrdiff_t(kept.size() / 50)) << "the density is even";
}

TEST(ThinnedPoints, few_points_all_remain) {
  EXPECT_EQ(mesh::thinned(sphere(100), 100).size(), 100u);
  EXPECT_EQ(mesh::thinned(std::vector<glm::dvec3>(500, glm::dvec3(3)), 100).size(), 1u);
}

TEST(PointFiles, a_ply_of_points_becomes_a_mesh) {
  const auto points = sphere(2000);
  for (const auto encoding :
       {test::PlyWriter::Encoding::ascii, test::PlyWriter::Encoding::little}) {
    test::PlyWriter ply(
        encoding,
        "element vertex 2000\nproperty double x\nproperty double y\nproperty double z\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    for (const auto& p : points) {
      ply.put_all({p.x, p.y, p.z}).put_all({float(p.x), float(p.y), float(p.z)});
      ply.put_all({std::uint8_t(200), std::uint8_t(100), std::uint8_t(50)});
    }
    const auto loaded = test::load_text(ply.bytes(), "cloud.ply");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    ASSERT_TRUE(loaded->from_points);
    EXPECT_EQ(loaded->from_points->points, 2000u);
    EXPECT_GT(loaded->mesh.triangle_count(), 2000u);
    EXPECT_EQ(loaded->mesh.vertex_colors.size(), loaded->mesh.positions.size());
    EXPECT_TRUE(loaded->point_normals.empty());
  }
}

}  // namespace
