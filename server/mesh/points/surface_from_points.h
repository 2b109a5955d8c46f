#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "core/progress.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

struct PointOptions {
  // The longest edge of the finest triangles, in the unit of the file. 0: about 1.5 × the
  // distance between points. Coarser if the extent is more than 2048 cells.
  double cell = 0;
  // The widest gap between points that the surface closes. 0: 12 × the distance between points.
  double gap = 0;
  // The folder for two temporary files, with room for twice the points. Empty: the system's.
  std::filesystem::path folder{};
};

// More points are thinned to one per cell of a grid. The surface from this number needs about 8 GB.
constexpr std::size_t kMaxMeshedPoints = 4'000'000;
constexpr std::size_t kLeastMeshedPoints = 50;

// Replaces the points in `positions` and `vertex_colors` of the mesh by a surface near them (see
// server/mesher/reconstruct.h). Points with coordinates that are not finite are left out. `normals`
// are those of the file, or empty. They are released.
//
// The program strata-mesher makes the surface. It is killed if the work is cancelled, and uses at
// most half of the machine's memory. Errors: `invalid` if there are too few points or they
// determine no surface; `out_of_memory`, with a coarser cell as advice; `internal` if the program
// is not installed.
Result<SurfaceFromPoints> surface_from_points(TriangleMesh& mesh, std::vector<glm::vec3>& normals,
                                              const PointOptions& options, Progress& progress);

// Thins points to at most `most`: one point remains in each cell of a grid. Returns the indices of
// the remaining points, ascending.
std::vector<std::uint32_t> thinned(const std::vector<glm::dvec3>& positions, std::size_t most);

}  // namespace strata::mesh
