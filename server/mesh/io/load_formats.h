#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "mesh/io/load.h"

namespace strata::mesh {

// The steps of `load_mesh`, for its own files only. The parsers return triangles whose indices are
// in range, in file order, unwelded, with notes on ignored content; `repair` converts them to the
// form that `load_mesh` promises.
Result<LoadedMesh> parse_ply(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_obj(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_stl(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_gltf(const InputFiles& files, Progress& progress,
                              std::size_t max_triangles = kMaxTriangles);
Result<void> repair(LoadedMesh& loaded, Progress& progress, const LoadOptions& options = {});

// Parsers report progress up to this share of the whole, `repair` from there on.
constexpr double kParsedShare = 0.6;

// invalid, with the common title of all faults in a mesh file.
inline tl::unexpected<Error> refuse_file(std::string detail) {
  return fail(ErrorCode::invalid, "Mesh file refused", std::move(detail), "file");
}

// Adds a line to the report when there is something to report.
inline void note(std::vector<Repair>& repairs, std::string what, std::uint64_t count) {
  if (count > 0) repairs.push_back({std::move(what), count});
}

}  // namespace strata::mesh
