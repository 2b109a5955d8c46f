#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "mesh/io/load.h"

namespace strata::mesh {

// The steps of `load_mesh`, for use by its own files only. The parsers return unwelded triangles in
// file order with indices in range, and note ignored content. `repair` converts the triangles to
// the result that `load_mesh` promises.
Result<LoadedMesh> parse_ply(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_obj(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_stl(const InputFiles& files, Progress& progress,
                             std::size_t max_triangles = kMaxTriangles);
Result<LoadedMesh> parse_gltf(const InputFiles& files, Progress& progress,
                              std::size_t max_triangles = kMaxTriangles);
// Reads the points of a LAS file (ASPRS LAS 1.0 to 1.4, formats 0 to 10) with their colors. Leaves
// out points that the file marks as withheld or as noise. Takes the coordinate system from GeoTIFF
// keys or from WKT, and the unit m if the system is projected in meters. Refuses LAZ, because no
// library for it is available, and coordinates in degrees.
Result<LoadedMesh> parse_las(const InputFiles& files, Progress& progress);
Result<void> repair(LoadedMesh& loaded, Progress& progress, const LoadOptions& options = {});

// Parsers report progress up to this share of the whole. `repair` reports the rest.
constexpr double kParsedShare = 0.6;

// Returns the error `invalid` with the common title of all faults in a mesh file.
inline tl::unexpected<Error> refuse_file(std::string detail) {
  return fail(ErrorCode::invalid, "Mesh file refused", std::move(detail), "file");
}

// Adds a line to the report if `count` is positive.
inline void note(std::vector<Repair>& repairs, std::string what, std::uint64_t count) {
  if (count > 0) repairs.push_back({std::move(what), count});
}

}  // namespace strata::mesh
