#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/standing.h"
#include "mesh/io/input_files.h"
#include "mesh/io/load.h"
#include "mesh/surface/geometry.h"

namespace strata::bench {

// A named mesh. The name is `pot` or `pot:TRIANGLES`, which this process generates; a file in any
// format that the importer reads; or a preset of the data folder's make_big_mesh.py (vessel,
// excavation, amazon, thai, textured10m), which is generated once, in `cache`.
struct BenchMesh {
  std::string name;
  std::shared_ptr<const mesh::Geometry> geometry;  // with an atlas
  double area = 0;                                 // in unit²
  AtlasReport atlas;
  Standing standing;
  std::string unit;  // empty if the file has no unit
};

struct BenchMeshOptions {
  std::filesystem::path cache = "build/bench";
  bool make_always = false;  // discards the file's own texture coordinates
  bool other_atlas = false;  // shuffles the triangles, so that a made atlas has other charts
  std::string up = {};       // if neither the file nor the known scans have an axis; empty: z
};

// Returns whether this process generates the mesh instead of reading it from a file.
bool is_generated(const std::string& name);

// Returns the name for tables and captions: the path within the data folder, or the file's name.
std::string mesh_title(const std::string& name);

// Returns the mesh file and the files that it refers to. Unpacks files that end in .xz or .gz into
// `cache`. Returns an Error for a missing file, and for a preset that cannot be made.
Result<std::vector<mesh::InputFile>> mesh_files(const std::string& name,
                                                const std::filesystem::path& cache);

// Returns every mesh of the data folder, and the presets. Some files of the folder `nasty` are
// invalid on purpose, and reading them fails.
Result<std::vector<std::string>> all_meshes();

// Reads and repairs the mesh as the importer does. Also generates `pot`.
Result<mesh::LoadedMesh> load_named_mesh(const std::string& name,
                                         const std::filesystem::path& cache, Progress& progress);

// Keeps the file's own texture coordinates if layers can use them and `make_always` is false.
Result<BenchMesh> load_bench_mesh(const std::string& name, const BenchMeshOptions& options = {});

}  // namespace strata::bench
