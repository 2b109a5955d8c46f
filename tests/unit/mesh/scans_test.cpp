// Imports every scan next to the source tree without storing it in a database. Each import runs in
// a separate process, to measure its peak memory. Compares the result with figures of a reader
// that shares no code with this one. Prints a table, which docs/reference/formats.md shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "mesh/atlas/atlas.h"
#include "mesh/io/load.h"
#include "mesh/surface/geometry.h"
#include "mesh/texture/base_color.h"
#include "strata_dirs.h"
#include "support/manifold_check.h"
#include "support/openmesh_oracle.h"

namespace {

using namespace strata;
using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kMemoryIsReal = false;  // includes the memory of the sanitizer
#else
constexpr bool kMemoryIsReal = true;
#endif
constexpr int kResolution = 2048;

const fs::path kData = STRATA_TEST_DATA;

const std::string kPoints = "nasty/n22_points_only.ply";  // the vertices of the pot

struct Scan {
  std::string file;  // mesh file
  std::vector<std::string> companions = {};
};

struct Outcome {
  json report;
  double megabytes = 0;  // peak memory
  std::uint64_t bytes = 0;

  bool imported() const { return report.contains("triangles"); }
  std::uint64_t count(const std::string& what) const {
    std::uint64_t sum = 0;
    for (const auto& repair : report["repairs"])
      if (repair["what"].get<std::string>().starts_with(what))
        sum += repair["count"].get<std::uint64_t>();
    return sum;
  }
};

json import_in_child(const std::vector<mesh::InputFile>& files) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress;
  auto loaded = mesh::load_mesh(files, progress);
  if (!loaded) return {{"problem", loaded.error().detail}, {"code", name(loaded.error().code)}};
  json report{
      {"triangles", loaded->mesh.triangle_count()}, {"positions", loaded->mesh.positions.size()},
      {"area", mesh::surface_area(loaded->mesh)},   {"colors", !loaded->mesh.vertex_colors.empty()},
      {"textures", loaded->mesh.textures.size()},   {"materials", loaded->mesh.materials.size()}};
  const auto& first = loaded->mesh.positions[0];
  report["first"] = {first.x, first.y, first.z};
  if (loaded->mesh.triangle_count() < 400'000) {
    const auto faults = test::manifold_faults(loaded->mesh);
    report["faults"] = faults.crowded_edges + faults.disagreements + faults.vertices_of_fans;
    report["boundary"] = faults.boundary_edges;
  }
  report["refused_by_openmesh"] = test::OpenMeshOracle(loaded->mesh).refused.size();
  auto atlas = mesh::keep_uvs(loaded->mesh, kResolution, progress);
  if (!atlas) atlas = mesh::make_atlas(loaded->mesh, kResolution, progress);
  if (!atlas) return {{"problem", atlas.error().detail}, {"code", name(atlas.error().code)}};
  report["atlas"] = atlas->report.source;
  loaded->repairs.insert(loaded->repairs.end(), atlas->repairs.begin(), atlas->repairs.end());
  auto color = mesh::bake_base_color(loaded->mesh, *atlas, loaded->repairs, progress);
  if (!color) return {{"problem", color.error().detail}, {"code", name(color.error().code)}};
  if (*color)
    report["look"] = {{"width", (*color)->width},
                      {"bytes", (*color)->bytes.size()},
                      {"type", media_type((*color)->format)}};
  report["vertices"] = mesh::build_geometry(loaded->mesh, *atlas).vertices.size();
  report["repairs"] = json::array();
  for (const auto& repair : loaded->repairs)
    report["repairs"].push_back({{"what", repair.what}, {"count", repair.count}});
  report["seconds"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

Outcome import_apart(const std::vector<mesh::InputFile>& files) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    const std::string text = import_in_child(files).dump();
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = ::write(ends[1], text.data() + at, text.size() - at);
      if (written <= 0) ::_exit(2);
      at += static_cast<std::size_t>(written);
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text;
  char chunk[4096];
  for (ssize_t read; (read = ::read(ends[0], chunk, sizeof chunk)) > 0;)
    text.append(chunk, static_cast<std::size_t>(read));
  ::close(ends[0]);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the import died";
  Outcome outcome{json::parse(text, nullptr, false), double(usage.ru_maxrss) * 1024 / 1e6, 0};
  for (const auto& file : files) outcome.bytes += fs::file_size(file.path);
  return outcome;
}

class MeshScans : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::ifstream in(kData / "FACTS.json");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    // The area of n05 is NaN, which JSON does not allow.
    for (std::size_t at; (at = text.find(": NaN")) != text.npos;) text.replace(at, 5, ": null");
    facts_ = json::parse(text, nullptr, false);
  }
  void SetUp() override {
    if (!facts_.is_object())
      GTEST_SKIP() << "NO SCANS in " << kData << ": nothing of real files is tested";
  }

  // Unpacks compressed scans first, as users do.
  static Outcome import(const Scan& scan) {
    std::vector<mesh::InputFile> files;
    for (const std::string& name : scan.companions) files.push_back({name, kData / name});
    fs::path path = kData / scan.file;
    std::string name = scan.file;
    const std::string packed = path.extension();
    if (packed == ".xz" || packed == ".gz") {
      name = fs::path(name).stem();
      path = fs::temp_directory_path() / ("strata-scan-" + std::to_string(::getpid()) + "-" + name);
      const std::string command = (packed == ".xz" ? "xz -dc " : "gzip -dc ") +
                                  (kData / scan.file).string() + " > " + path.string();
      EXPECT_EQ(std::system(command.c_str()), 0) << command;
    }
    files.push_back({name, path});
    const Outcome outcome = import_apart(files);
    if (path != kData / scan.file) fs::remove(path);
    print(scan, outcome);
    if (kMemoryIsReal) {
      EXPECT_LE(outcome.megabytes, 4 * double(outcome.bytes) / 1e6 + 200) << scan.file;
    }
    return outcome;
  }

  static void print(const Scan& scan, const Outcome& outcome) {
    const json& report = outcome.report;
    std::string text = "| `" + scan.file + "` | ";
    if (outcome.imported()) {
      text += std::to_string(report["triangles"].get<std::size_t>()) + " | " +
              std::to_string(report["positions"].get<std::size_t>()) + " | " +
              report["atlas"].get<std::string>() + " | ";
      if (report.contains("look"))
        text += std::to_string(report["look"]["width"].get<int>()) + "² " +
                report["look"]["type"].get<std::string>().substr(6);
      else
        text += report["colors"] ? "vertex colours" : "—";
      text += " | ";
      std::string repairs;
      for (const auto& repair : report["repairs"])
        repairs += (repairs.empty() ? "" : "; ") + repair["what"].get<std::string>() + ": " +
                   std::to_string(repair["count"].get<std::uint64_t>());
      text += repairs.empty() ? "—" : repairs;
    } else {
      text += "refused | | | | " + report.value("problem", "died");
    }
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, " | %.2f | %.0f |", report.value("seconds", 0.0),
                  outcome.megabytes);
    std::printf("%s%s\n", text.c_str(), numbers);
  }

  static std::vector<Scan> good() {
    std::vector<Scan> scans{
        {"mask_bali/mask.gltf",
         {"mask_bali/Image_0.jpg", "mask_bali/mask-gltf-2.0_separated-valid.bin"}},
        {"mask_bali/mask.obj", {"mask_bali/mask.mtl", "mask_bali/Image_0.jpg"}},
        {"mask_bali/mask_quantized.glb"},
        {"mask_bali/mask_meshopt.glb"},
        {"nasty/n06_uv_mirrored_overlap.obj", {"nasty/pot.mtl", "nasty/checker.png"}},
        {"nasty/n07_uv_tiling_outside.obj", {"nasty/pot.mtl", "nasty/checker.png"}},
        {"nasty/n08_udim_4tiles_4materials.obj",
         {"nasty/udim.mtl", "nasty/udim.1001.png", "nasty/udim.1002.png", "nasty/udim.1011.png",
          "nasty/udim.1012.png"}},
        {"nasty/n17_wedge_uv_two_textures.ply", {"nasty/udim.1001.png", "nasty/udim.1002.png"}}};
    for (const auto& [name, fact] : facts_.items()) {
      const bool known = std::any_of(scans.begin(), scans.end(),
                                     [&](const Scan& scan) { return scan.file == name; });
      const bool bad = std::any_of(refused().begin(), refused().end(),
                                   [&](const auto& entry) { return entry.first == name; });
      if (!known && !bad && name != kPoints) scans.push_back({name});
    }
    return scans;
  }

  static const std::vector<std::pair<std::string, std::string>>& refused() {
    static const std::vector<std::pair<std::string, std::string>> scans{
        {"nasty/n05_nan_inf_vertices.ply",
         "2 vertices that triangles use have a coordinate that is not a finite number"},
        {"nasty/n10b_utm_float32_ruined.ply", "5312 of 5616 triangles have no area"},
        {"nasty/n18_bad_truncated.ply", "incomplete"},
        {"nasty/n19_bad_header_lies.ply", "4000000000"},
        {"nasty/n20_bad_index.obj", "refers to vertex 5001"},
        {"nasty/n21_empty.ply", "no triangle"},
        {"nasty/n23_bad_index.ply", "Face 5"},
        {"nasty/n24_zero_bytes.glb", "empty"},
        {"nasty/n25_bad_glb_length.glb", "incomplete"}};
    return scans;
  }

  static inline json facts_;
};

TEST_F(MeshScans, good_files_have_the_measured_triangles_positions_and_area) {
  for (const Scan& scan : good()) {
    SCOPED_TRACE(scan.file);
    const Outcome outcome = import(scan);
    if (!outcome.imported()) {
      ADD_FAILURE() << outcome.report.value("problem", "died");
      continue;
    }
    const json& fact = facts_[scan.file];
    const json& measured = fact.value("after_exact_weld", json()).is_null()
                               ? fact["as_indexed"]
                               : fact["after_exact_weld"];
    EXPECT_EQ(outcome.count("dropped degenerate triangles"),
              measured.value("index_degenerate_faces", 0u));
    EXPECT_EQ(outcome.count("dropped duplicate triangles"), measured.value("duplicate_faces", 0u));
    EXPECT_EQ(outcome.report["triangles"].get<std::uint64_t>() +
                  outcome.count("dropped degenerate") + outcome.count("dropped duplicate") +
                  outcome.count("dropped triangles") + outcome.count("dropped slivers"),
              fact["triangles"].get<std::uint64_t>());
    // The figures count both instances of n16 with all vertices of both primitives, although each
    // instance uses half of them.
    const std::uint64_t repeated = scan.file.find("n16") == scan.file.npos
                                       ? fact.value("duplicate_position_vertices", 0u)
                                       : 160;
    EXPECT_EQ(outcome.count("welded vertices at equal positions"), repeated);
    if (outcome.count("cut") == 0) {
      EXPECT_EQ(outcome.report["positions"].get<std::uint64_t>() +
                    outcome.count("dropped unused vertices"),
                fact["distinct_positions"].get<std::uint64_t>());
    }
    EXPECT_EQ(outcome.report.value("faults", 0u), 0u) << "the mesh is a surface now";
    EXPECT_EQ(outcome.report["refused_by_openmesh"], 0) << "the mesh is a surface now";
    // Another decoder measured the Draco files and the quantized files.
    const double tolerance = scan.file.ends_with(".glb") ? 1e-5 : 1e-9;
    // The figures count duplicates twice. A fan over the concave pentagon of n09 overlaps itself.
    if (measured.value("duplicate_faces", 0) == 0 && scan.file.find("n09") == scan.file.npos &&
        !fact["surface_area"].is_null()) {
      const double area = fact["surface_area"];
      EXPECT_NEAR(outcome.report["area"].get<double>(), area, area * tolerance);
    }
    EXPECT_EQ(outcome.count("texture n"), 0u) << "every picture is found and read";
  }
}

TEST_F(MeshScans, bad_files_are_refused_and_the_fault_is_named) {
  for (const auto& [name, says] : refused()) {
    const Outcome outcome = import({name});
    ASSERT_TRUE(outcome.report.contains("problem")) << name;
    EXPECT_EQ(outcome.report["code"], "invalid") << name;
    EXPECT_THAT(outcome.report["problem"].get<std::string>(), HasSubstr(says)) << name;
  }
  const Outcome alone = import({"mask_bali/mask.gltf"});
  ASSERT_TRUE(alone.report.contains("problem"));
  EXPECT_THAT(alone.report["problem"].get<std::string>(),
              HasSubstr("mask-gltf-2.0_separated-valid.bin\", but the upload does not contain"));
}

// The wall of this pot is thinner than the distance between its points, so the surface has only one
// side of it.
TEST_F(MeshScans, points_become_a_surface_without_faults) {
  const Outcome outcome = import({kPoints});
  ASSERT_TRUE(outcome.imported()) << outcome.report.value("problem", "died");
  const double area = facts_["nasty/n14_tristrips.ply"]["surface_area"];
  EXPECT_NEAR(outcome.report["area"].get<double>(), area / 2, 0.05 * area);
  EXPECT_EQ(outcome.report.value("faults", 0u), 0u);
}

TEST_F(MeshScans, the_repairs_of_known_defects_are_counted) {
  const Outcome fins = import({"nasty/n01_nonmanifold_fins_bowtie.ply"});
  EXPECT_EQ(fins.count("cut edges of more than two triangles"), 3u);
  EXPECT_EQ(fins.count("cut vertices"), 7u);
  const Outcome flipped = import({"nasty/n03_flipped_degenerate_duplicate.ply"});
  EXPECT_EQ(flipped.report["triangles"], 5616);
  EXPECT_EQ(flipped.count("dropped triangles without area") + flipped.count("dropped slivers"),
            20u);
  EXPECT_EQ(flipped.count("turned triangles"), 561u);
  EXPECT_EQ(flipped.report["boundary"], 144);
  EXPECT_EQ(import({"nasty/n04_holes_isolated_vertices.ply"}).count("dropped unused vertices"),
            177u);
  const Outcome dragon = import({"dragon_stanford_res4_11k_nonmanifold.ply.gz"});
  EXPECT_EQ(dragon.count("dropped duplicate triangles"), 502u);
  EXPECT_EQ(dragon.count("dropped unused vertices"), 2u);
}

TEST_F(MeshScans, the_same_scan_in_several_formats_is_the_same_model) {
  Progress progress;
  const auto load = [&](const Scan& scan) {
    std::vector<mesh::InputFile> files;
    for (const std::string& name : scan.companions) files.push_back({name, kData / name});
    files.push_back({scan.file, kData / scan.file});
    auto loaded = mesh::load_mesh(files, progress);
    EXPECT_TRUE(loaded) << scan.file << ": " << (loaded ? "" : loaded.error().detail);
    return loaded ? std::move(loaded->mesh) : mesh::TriangleMesh{};
  };
  struct Pair {
    Scan a, b;
    double position, uv;  // largest differences
  };
  const auto all = good();
  const Pair pairs[] = {{all[0], all[1], 1e-7, 1e-6},        // text with 9 digits
                        {all[0], all[2], 2e-5, 1.0 / 2048},  // quantized to 14 and 12 bits
                        {all[2], all[3], 1e-12, 1e-12},
                        {{"whale_cranium.glb"}, {"whale_cranium_draco.glb"}, 5e-5, 1.0 / 1024}};
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.a.file + " = " + pair.b.file);
    const auto a = load(pair.a), b = load(pair.b);
    ASSERT_EQ(a.triangle_count(), b.triangle_count());
    EXPECT_EQ(a.positions.size(), b.positions.size());
    EXPECT_EQ(a.textures.size(), b.textures.size());
    if (!a.textures.empty() && !b.textures.empty()) {
      EXPECT_EQ(a.textures[0].bytes, b.textures[0].bytes);
    }
    // Encoders reorder triangles, so this compares them by position.
    const auto keys = [](const mesh::TriangleMesh& mesh) {
      std::vector<std::array<double, 5>> of_triangles;
      for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        glm::dvec3 middle(0);
        glm::dvec2 uv(0);
        for (int k = 0; k < 3; ++k) {
          middle += mesh.positions[mesh.triangles[i + k]] / 3.0;
          uv += glm::dvec2(mesh.corner_uvs[i + k]) / 3.0;
        }
        of_triangles.push_back({middle.x, middle.y, middle.z, uv.x, uv.y});
      }
      return of_triangles;
    };
    const auto of_a = keys(a), of_b = keys(b);
    // Searches a grid cell and its neighbors for the nearest triangle.
    const double cell = std::max(pair.position * 20, 1e-4);
    std::multimap<std::array<long, 3>, std::size_t> grid;
    const auto cell_of = [&](const std::array<double, 5>& key) {
      return std::array<long, 3>{std::lround(key[0] / cell), std::lround(key[1] / cell),
                                 std::lround(key[2] / cell)};
    };
    for (std::size_t i = 0; i < of_b.size(); ++i) grid.emplace(cell_of(of_b[i]), i);
    double worst_position = 0, worst_uv = 0;  // between each triangle and the nearest one
    for (const auto& key : of_a) {
      double position = 1e300, uv = 1e300;
      const auto at = cell_of(key);
      for (int n = 0; n < 27; ++n) {
        const auto [begin, end] =
            grid.equal_range({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
        for (auto it = begin; it != end; ++it) {
          const auto& other = of_b[it->second];
          const double far = std::max({std::abs(key[0] - other[0]), std::abs(key[1] - other[1]),
                                       std::abs(key[2] - other[2])});
          const double apart = std::max(std::abs(key[3] - other[3]), std::abs(key[4] - other[4]));
          if (far + apart >= position + uv) continue;
          position = far;
          uv = apart;
        }
      }
      worst_position = std::max(worst_position, position);
      worst_uv = std::max(worst_uv, uv);
    }
    EXPECT_LE(worst_position, pair.position);
    EXPECT_LE(worst_uv, pair.uv);
  }
}

TEST_F(MeshScans, one_photograph_on_the_scans_own_coordinates_stays_as_it_is) {
  const Outcome outcome = import({"mask_bali/mask_meshopt.glb"});
  ASSERT_TRUE(outcome.report.contains("look"));
  EXPECT_EQ(outcome.report["atlas"], "file");
  EXPECT_EQ(outcome.report["look"]["bytes"], 2321402) << "bit for bit";
  EXPECT_EQ(outcome.report["look"]["width"], 4096);
}

TEST_F(MeshScans, utm_coordinates_stay_exact_to_the_micrometre) {
  const json exact = import({"nasty/n10a_utm_double.ply"}).report["first"];
  EXPECT_GT(exact[1].get<double>(), 4581234.0);
  for (const char* name : {"nasty/n10c_utm.obj", "nasty/n10d_utm_node_translation.glb"}) {
    const json first = import({name}).report["first"];
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(first[k].get<double>(), exact[k].get<double>(), 1e-6) << name;
  }
}

}  // namespace
