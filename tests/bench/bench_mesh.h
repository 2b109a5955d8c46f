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

// Meshes go by name: `pot` or `pot:TRIANGLES` (generated here), a file of any format that an import
// takes, or a preset of the data folder's make_big_mesh.py (vessel, excavation, amazon, thai,
// textured10m), made once into `cache`.
struct BenchMesh {
  std::string name;
  std::shared_ptr<const mesh::Geometry> geometry;  // with an atlas
  double area = 0;                                 // unit²
  AtlasReport atlas;
  Standing standing;
  std::string unit;  // empty: the file does not say
};

struct BenchMeshOptions {
  std::filesystem::path cache = "build/bench";
  bool make_always = false;  // never keep the file's own texture coordinates
  std::string up = {};       // where neither the file nor the list of known scans says it; empty: z
};

// Whether it is made in this process, and no file.
bool is_generated(const std::string& name);

// As tables and captions call it: the path within the data folder, or the file's name.
std::string mesh_title(const std::string& name);

// The mesh with the files that it names. Files that end in .xz or .gz are unpacked into `cache`.
// Refused where there is no such file, and where a preset cannot be made.
Result<std::vector<mesh::InputFile>> mesh_files(const std::string& name,
                                                const std::filesystem::path& cache);

// Every mesh of the data folder, and the presets. Some of its folder `nasty` are refused when they
// are read, as they should be.
Result<std::vector<std::string>> all_meshes();

// As the importer reads and repairs it; `pot` among them.
Result<mesh::LoadedMesh> load_named_mesh(const std::string& name,
                                         const std::filesystem::path& cache, Progress& progress);

// With the file's own texture coordinates where they can carry layers, unless `make_always`.
Result<BenchMesh> load_bench_mesh(const std::string& name, const BenchMeshOptions& options = {});

}  // namespace strata::bench
