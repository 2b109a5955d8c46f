#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// The two files by which the server and the program strata-mesher (server/mesher) exchange points
// and a surface. Both run on the same machine, so numbers have its byte order. Each file is a
// header and then arrays without gaps, in the order below.
namespace strata::mesh {

// Then: double[3] per point; float[3] per point if has_normals; uint8[4] (RGBA) per point if
// has_colors.
struct PointFileHeader {
  static constexpr std::array<char, 8> kMagic{'S', 'T', 'R', 'P', 'N', 'T', '0', '1'};
  std::array<char, 8> magic = kMagic;
  std::uint64_t points = 0;
  std::uint32_t has_normals = 0, has_colors = 0;  // 0 or 1
};

// Then: double[3] per vertex; uint8[4] (RGBA) per vertex if has_colors; uint32[3] per triangle.
struct SurfaceFileHeader {
  static constexpr std::array<char, 8> kMagic{'S', 'T', 'R', 'S', 'R', 'F', '0', '1'};
  std::array<char, 8> magic = kMagic;
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t has_colors = 0;
  double point_spacing = 0;  // median distance of a point to the next one
  double cell = 0;           // edge length of the finest cells, about the length of an edge
  double gap = 0;            // the widest gap between points that was closed
  double distance_median = 0, distance_95 = 0;  // of the points to the surface
};
static_assert(sizeof(PointFileHeader) == 24 && sizeof(SurfaceFileHeader) == 72);

// The exit statuses of strata-mesher, apart from 0.
enum class MesherExit : int {
  bad_arguments = 2,
  bad_file = 3,
  out_of_memory = 4,
  no_surface = 5,  // the points are too few, or lie on one place or line
};

}  // namespace strata::mesh
