#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/points/point_file.h"

namespace strata::mesher {

struct Points {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<float, 3>> normals;        // empty, or one per point, not normalized
  std::vector<std::array<std::uint8_t, 4>> colors;  // empty, or one per point
};

struct Settings {
  // The longest edge of the finest cells, in the unit of the positions. 0: about 1.5 × the
  // distance between neighboring points. Cells are larger if the points extend over more than 2048
  // cells.
  double cell = 0;
  // The widest gap between points that the surface closes. 0: 12 × the distance between points.
  double gap = 0;
};

struct Surface {
  mesh::SurfaceFileHeader facts;
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<std::uint8_t, 4>> colors;  // empty, or one per vertex
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// Makes a surface by screened Poisson reconstruction (Kazhdan and Hoppe 2013, of Open3D). Normals
// that the points lack are estimated from neighbors, and all point to the same side. Places without
// points that are wider than the gap are left out, so that the sides that were not scanned stay
// open. Returns false if the points do not determine a surface. Throws std::bad_alloc.
bool reconstruct(const Points& points, const Settings& settings,
                 const std::function<void(double fraction, const char* stage)>& report,
                 Surface& surface);

}  // namespace strata::mesher
