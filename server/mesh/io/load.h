#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/progress.h"
#include "mesh/io/input_files.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// A file with more triangles is refused while it is read: strips and polygons make many triangles
// from few bytes. This is enough for the densest scans, and 600 MB of indices.
constexpr std::size_t kMaxTriangles = 50'000'000;

struct LoadedMesh {
  TriangleMesh mesh;
  // dropped and joined elements with counts; every change is listed
  std::vector<Repair> repairs;
  // where the format or a comment states it: glTF is in meters
  std::optional<Unit> unit = {};
  // "y" for glTF, or from a comment; empty: not stated
  std::string up = {};
  std::vector<std::string> comments = {};  // of the file, see file_comments
};

struct LoadOptions {
  double weld_distance = 0;  // in the file's units: vertices nearer than this are joined, too
};

// Whether a file that needed this repair had a fault. Joining equal vertices is not a fault: some
// formats always repeat them.
bool is_fault(const Repair& repair);

// Reads the mesh among the files of one scan, by the ending of its name, with the files that it
// uses:
//
// - PLY: ascii and both endians, any scalar types and order of elements; colors of vertices or
//   faces in 8 or 16 bits or real numbers, texture coordinates of vertices or corners,
//   `TextureFile` comments with `texnumber`, triangle strips
// - OBJ with MTL: polygons, negative indices, continued lines, `v x y z r g b`; map_Kd with its
//   options, UDIM tiles
// - STL: binary, also with a header that begins with "solid", and ascii in letters of any case,
//   with comments
// - glTF 2.0 and GLB: scenes of nodes with transforms in double, EXT_mesh_gpu_instancing,
//   triangles, strips and fans; Draco, meshopt (EXT and KHR), quantized, sparse; any TEXCOORD set
//   with KHR_texture_transform; COLOR_0; data in the file, in separate files or in data URIs
//
// Lines of text end at LF, CRLF or CR. A byte order mark is skipped; OBJ, MTL and STL may be UTF-16
// with a byte order mark.
//
// Then the mesh is repaired, each step with a count in `repairs`: equal vertices are welded, and
// those within weld_distance; degenerate and duplicate triangles and unused vertices are dropped;
// and it is made manifold (see make_manifold).
//
// Refused with a message that names the fault and its place: unreadable or truncated files, counts
// that the file cannot hold, polygons of more than kMaxPolygonCorners, more than kMaxTriangles,
// indices out of range, NaN or infinite coordinates that triangles use (with their number), no
// triangle at all, glTF buffers that were not uploaded, and required glTF extensions that are not
// supported. A missing picture is noted, and the mesh is loaded without it. Memory stays within 4 ×
// the files + 200 MB where coordinates have 4 bytes and faces are lists; strips add at most 12
// bytes for each of kMaxTriangles. Any thread.
Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress,
                             const LoadOptions& options = {});

// The same for one file without companion files, and for files that are already in memory.
Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename,
                             Progress& progress);
Result<LoadedMesh> load_mesh(InputFiles files, Progress& progress, const LoadOptions& options = {});
Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress);

}  // namespace strata::mesh
