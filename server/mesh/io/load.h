#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/progress.h"
#include "mesh/io/input_files.h"
#include "mesh/points/surface_from_points.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// A file with more triangles is refused during reading, because strips and polygons make many
// triangles from few bytes. The limit is enough for the densest scans and corresponds to 600 MB of
// indices.
constexpr std::size_t kMaxTriangles = 50'000'000;

struct LoadedMesh {
  TriangleMesh mesh;
  // counts of dropped and joined elements; every change is listed
  std::vector<Repair> repairs;
  // set if the format or a comment states it; glTF is in meters
  std::optional<Unit> unit = {};
  // "y" for glTF, or taken from a comment; empty: not stated
  std::string up = {};
  std::string crs = {};                    // "EPSG:n", if a LAS file states it
  std::vector<std::string> comments = {};  // comments of the file, see file_comments
  // The normals of a file without triangles, one per position, or empty.
  std::vector<glm::vec3> point_normals = {};
  // Set if the file contains points without triangles, from which the surface was made.
  std::optional<SurfaceFromPoints> from_points = {};
  std::vector<ModelPart> parts = {};  // empty: one scan
};

struct LoadOptions {
  double weld_distance = 0;  // in file units; vertices within this distance are also joined
  PointOptions points = {};  // used if the file contains points without triangles
  // The files may contain several scans with common coordinates. See join_parts.
  bool parts = false;
};

// Returns true if this repair means that the file had a fault. Joining equal vertices does not
// indicate a fault, because some formats always repeat vertices.
bool is_fault(const Repair& repair);

// Reads the mesh from the files of one scan, together with the files that the mesh uses. With
// LoadOptions::parts, reads several scans in this way and joins them (join_parts). The extension of
// the mesh's name determines the format:
//
// - PLY: ASCII and binary with both byte orders, any scalar types and any order of elements; colors
//   of vertices or faces in 8 or 16 bits or as real numbers; texture coordinates of vertices or
//   corners; `TextureFile` comments with `texnumber`; triangle strips
// - OBJ with MTL: polygons, negative indices, continued lines, `v x y z r g b`; map_Kd with its
//   options; UDIM tiles
// - STL: binary, including headers that begin with "solid"; ASCII in upper or lower case, with
//   comments
// - LAS 1.0 to 1.4 without compression (see parse_las)
// - glTF 2.0 and GLB: scenes of nodes with transforms in double precision, EXT_mesh_gpu_instancing,
//   triangles, strips and fans; Draco, meshopt (EXT and KHR), quantized and sparse data; any
//   TEXCOORD set with KHR_texture_transform; COLOR_0; data in the file, in separate files or in
//   data URIs
//
// If a file contains points but no triangle, a surface is made from them (surface_from_points).
//
// Lines of text end with LF, CRLF or CR. A byte order mark is skipped. OBJ, MTL and STL may be
// UTF-16 with a byte order mark.
//
// The mesh is then repaired. `repairs` has a count for each step. Equal vertices are welded, and
// also vertices within weld_distance. Degenerate triangles, duplicate triangles and unused vertices
// are dropped. Then the mesh is made manifold (see make_manifold).
//
// If a file is refused, a message names the fault and its position. The reasons are:
//
// - unreadable or truncated files, and counts that the file cannot hold
// - polygons with more than kMaxPolygonCorners corners, and more than kMaxTriangles triangles
// - indices out of range, and triangles with NaN or infinite coordinates (with their number)
// - no triangles and too few points
// - glTF buffers that were not uploaded, and unsupported required glTF extensions
//
// A missing image is noted, and the mesh is loaded without it.
//
// The memory is at most 4 × the size of the files + 200 MB if coordinates have 4 bytes and faces
// are lists. Strips add at most 12 bytes for each of kMaxTriangles triangles. Can be called on any
// thread.
Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress,
                             const LoadOptions& options = {});

// Variants of the function above for a single file and for files that are already in memory.
Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename,
                             Progress& progress);
Result<LoadedMesh> load_mesh(InputFiles files, Progress& progress, const LoadOptions& options = {});
Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress);

}  // namespace strata::mesh
