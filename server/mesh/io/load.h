#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/progress.h"
#include "mesh/io/input_files.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// More are refused while a file is read: strips and polygons make many triangles of few bytes.
// Enough for the densest scans, and 600 MB of indices.
constexpr std::size_t kMaxTriangles = 50'000'000;

struct LoadedMesh {
  TriangleMesh mesh;
  // what was dropped or joined on the way, with counts; never silent
  std::vector<Repair> repairs;
  // where the format or a comment says it: glTF is in metres
  std::optional<Unit> unit = {};
  // "y" for glTF, or as a comment says; empty: nothing does
  std::string up = {};
  std::vector<std::string> comments = {};  // of the file, see file_comments
};

struct LoadOptions {
  double weld_distance = 0;  // in the file's units: vertices that lie nearer are joined, too
};

// Whether a file that needed this had a fault. To join equal vertices is none: some formats repeat
// them always.
bool is_fault(const Repair& repair);

// Reads the mesh among the files of one scan, by the ending of its name, with what it refers to:
//
// - PLY: ascii and both endians, any scalar types and order of elements; colours of vertices or
// faces in 8 or 16 bits or real
//   numbers, texture coordinates of vertices or corners, `TextureFile` comments with `texnumber`,
//   triangle strips
// - OBJ with MTL: polygons, negative indices, continued lines, `v x y z r g b`; map_Kd with its
// options, UDIM tiles
// - STL: binary, also with a header that begins with "solid", and ascii in letters of any case,
// with comments
// - glTF 2.0 and GLB: scenes of nodes with transforms in double, EXT_mesh_gpu_instancing,
// triangles, strips and fans; Draco,
//   meshopt (EXT and KHR), quantised, sparse; any TEXCOORD set with KHR_texture_transform; COLOR_0;
//   data in the file, beside it or in data URIs
//
// Lines of text end at LF, CRLF or CR; a byte order mark is passed over, and that of UTF-16 heeded
// in OBJ, MTL and STL.
//
// Then it is repaired, each step with a count in `repairs`: equal vertices are welded, and those
// within weld_distance; degenerate and duplicate triangles and unused vertices are dropped; and it
// is made manifold (see make_manifold).
//
// Refused with a message that names the fault and its place: unreadable or truncated files, counts
// that the file cannot hold, polygons of more than kMaxPolygonCorners, more than kMaxTriangles,
// indices out of range, NaN or infinite coordinates that triangles use (with their number), no
// triangle at all, glTF buffers that were not sent along and extensions that it requires and that
// are not read. A picture that is missing is noted, and the mesh goes without. Memory stays within
// 4 × the files + 200 MB where coordinates have 4 bytes and faces are lists; strips add at most 12
// bytes for each of kMaxTriangles. Thread: any.
Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress,
                             const LoadOptions& options = {});

// The same for one file that needs no others, and for files that are already in memory.
Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename,
                             Progress& progress);
Result<LoadedMesh> load_mesh(InputFiles files, Progress& progress, const LoadOptions& options = {});
Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress);

}  // namespace strata::mesh
