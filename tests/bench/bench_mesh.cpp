#include "bench/bench_mesh.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include "jobs/companions.h"
#include "mesh/demo/demo_pot.h"
#include "strata_dirs.h"

namespace strata::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array kPresets{"vessel", "excavation", "amazon", "thai", "textured10m"};
constexpr int kLowestResolution = 2048;

bool is_preset(const std::string& name) {
  return std::find(kPresets.begin(), kPresets.end(), name) != kPresets.end();
}

mesh::TriangleMesh pot_of(const std::string& name) {
  const auto colon = name.find(':');
  if (colon == std::string::npos) return mesh::make_demo_pot();
  const double target = std::stod(name.substr(colon + 1));
  const double at_one = double(mesh::make_demo_pot().triangle_count());
  return mesh::make_demo_pot(target / at_one);
}

// Runs a command that writes `file`. Removes an incomplete file after a failure.
Result<fs::path> made_by(const std::string& command, const fs::path& file,
                         const std::string& advice) {
  fs::create_directories(file.parent_path());
  if (std::system(command.c_str()) == 0) return file;
  std::error_code ignored;
  fs::remove(file, ignored);
  return fail(ErrorCode::internal, "Mesh not made", advice);
}

std::string plain_name(const fs::path& file) {
  return file.extension() == ".xz" || file.extension() == ".gz" ? file.stem().string()
                                                                : file.filename().string();
}

Result<fs::path> unpacked(const fs::path& file, const fs::path& cache) {
  const std::string ending = file.extension().string();
  if (ending != ".xz" && ending != ".gz") return file;
  const auto plain = cache / plain_name(file);
  if (fs::exists(plain)) return plain;
  return made_by((ending == ".xz" ? "xz" : "gzip") + std::string(" -dc '") + file.string() +
                     "' > '" + plain.string() + "'",
                 plain, "Could not unpack " + file.string() + ".");
}

Result<fs::path> mesh_file(const std::string& name, const fs::path& cache) {
  if (!is_preset(name)) {
    if (fs::exists(name)) return unpacked(name, cache);
    return fail(ErrorCode::not_found, "No such mesh",
                "There is no file or model " + name +
                    " (pot, pot:N, vessel, excavation, amazon, thai, textured10m, or a file).");
  }
  const auto file = cache / (name + ".ply");
  if (fs::exists(file)) return file;
  const fs::path maker = fs::path(STRATA_TEST_DATA) / "make_big_mesh.py";
  if (!fs::exists(maker))
    return fail(
        ErrorCode::not_found, "No such mesh",
        "The preset " + name + " needs " + maker.string() + "; use pot:N or a file instead.");
  return made_by(
      "python3 '" + maker.string() + "' --preset " + name + " -o '" + file.string() + "' >&2", file,
      "Could not make the preset " + name + " (it needs python3 with numpy).");
}

}  // namespace

bool is_generated(const std::string& name) { return name == "pot" || name.starts_with("pot:"); }

std::string mesh_title(const std::string& name) {
  const fs::path file(name);
  std::error_code error;
  const fs::path within = fs::relative(file, STRATA_TEST_DATA, error);
  return error || within.empty() || *within.begin() == ".." ? file.filename().string()
                                                            : within.string();
}

Result<std::vector<mesh::InputFile>> mesh_files(const std::string& name, const fs::path& cache) {
  auto file = mesh_file(name, cache);
  if (!file) return tl::unexpected(file.error());
  return jobs::with_companions(*file);
}

Result<std::vector<std::string>> all_meshes() {
  std::vector<std::string> names;
  const fs::path data = STRATA_TEST_DATA;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(data, error))
    if (entry.is_regular_file() &&
        mesh::input_kind(plain_name(entry.path())) != mesh::InputKind::companion)
      names.push_back(entry.path().string());
  if (error)
    return fail(ErrorCode::not_found, "No data folder",
                "There is no data folder at " + data.string() + ".");
  // Sort into this order: the scans, the presets, the broken files.
  std::sort(names.begin(), names.end());
  const auto nasty = std::stable_partition(names.begin(), names.end(), [](const std::string& name) {
    return name.find("/nasty/") == std::string::npos;
  });
  names.insert(nasty, kPresets.begin(), kPresets.end());
  return names;
}

Result<mesh::LoadedMesh> load_named_mesh(const std::string& name, const fs::path& cache,
                                         Progress& progress) {
  if (is_generated(name)) return mesh::LoadedMesh{pot_of(name), {}, Unit::mm, "z"};
  const auto files = mesh_files(name, cache);
  if (!files) return tl::unexpected(files.error());
  return mesh::load_mesh(*files, progress);
}

namespace {

// Changes the order of the triangles, and drops what belongs to it.
void shuffle(mesh::TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> triangles(mesh.triangle_count());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    std::copy_n(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                triangles[i].begin());
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(1));
  mesh::TriangleMesh shuffled;
  shuffled.positions = std::move(mesh.positions);
  for (const auto& triangle : triangles)
    shuffled.triangles.insert(shuffled.triangles.end(), triangle.begin(), triangle.end());
  mesh = std::move(shuffled);
}

}  // namespace

Result<BenchMesh> load_bench_mesh(const std::string& name, const BenchMeshOptions& options) {
  Progress progress;
  auto loaded = load_named_mesh(name, options.cache, progress);
  if (!loaded) return tl::unexpected(loaded.error());
  mesh::TriangleMesh& mesh = loaded->mesh;
  const bool makes = options.make_always || options.other_atlas || mesh.corner_uvs.empty();
  if (options.other_atlas) shuffle(mesh);
  Result<mesh::Atlas> atlas = fail(ErrorCode::invalid, "", "");
  if (!makes) atlas = mesh::keep_uvs(mesh, kLowestResolution, progress);
  if (!atlas) atlas = mesh::make_atlas(mesh, kLowestResolution, progress);
  if (!atlas) return tl::unexpected(atlas.error());
  BenchMesh bench;
  bench.name = name;
  bench.area = mesh::surface_area(mesh);
  bench.atlas = atlas->report;
  bench.geometry = std::make_shared<const mesh::Geometry>(mesh::build_geometry(mesh, *atlas));
  bench.standing = standing_of(mesh_title(name), !loaded->up.empty() ? loaded->up : options.up);
  if (loaded->unit) bench.unit = strata::name(*loaded->unit);
  return bench;
}

}  // namespace strata::bench
