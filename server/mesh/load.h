#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/progress.h"
#include "mesh/input_files.h"
#include "mesh/triangle_mesh.h"

namespace strata::mesh {

// More are refused while a file is read: strips and polygons make many triangles of few bytes. Enough for the densest
// scans, and 600 MB of indices.
constexpr std::size_t kMaxTriangles = 50'000'000;

struct LoadedMesh {
  TriangleMesh mesh;
  std::vector<Repair> repairs;  // what was dropped or joined on the way, with counts; never silent
  std::optional<Unit> unit;     // where the format says it: glTF is in metres
  std::string up;               // "y" for glTF; empty: the format does not say
};

// Reads the mesh among the files of one scan: PLY (ascii, little and big endian, any scalar types) or OBJ (geometry, uv,
// `v x y z r g b`), by the ending of its name. Exactly equal positions are welded; degenerate and duplicate triangles and unused vertices are dropped
// and reported. Refused with a message that names the fault and its place: unreadable or truncated files, counts that
// the file cannot hold, polygons of more than kMaxPolygonCorners, more than kMaxTriangles, indices out of range, NaN or
// infinite coordinates (with their number), no triangle at all. Memory stays within 4 × the file + 200 MB where
// coordinates have 4 bytes and faces are lists; strips add at most 12 bytes for each of kMaxTriangles. Thread: any.
Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress);

// The same for one file that needs no others, and for one that is already in memory.
Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename, Progress& progress);
Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress);

}  // namespace strata::mesh
