#include "mesh/io/load.h"

#include "mesh/io/file_comments.h"
#include "mesh/io/file_nature.h"
#include "mesh/io/load_formats.h"
#include "mesh/io/texture_loader.h"

namespace strata::mesh {
namespace {

Result<LoadedMesh> parse(const InputFiles& files, Progress& progress) {
  const auto bytes = files.scan().bytes;
  if (bytes.empty()) return refuse_file("The file is empty.");
  const InputKind kind = input_kind(files.scan().name);
  auto loaded = [&]() -> Result<LoadedMesh> {
    switch (kind) {
      case InputKind::ply: return parse_ply(files, progress);
      case InputKind::obj: return parse_obj(files, progress);
      case InputKind::stl: return parse_stl(files, progress);
      case InputKind::las: return parse_las(files, progress);
      default: return parse_gltf(files, progress);
    }
  }();
  if (!loaded) {
    // The parser's message does not help the user with a file of another format.
    if (const auto other = other_nature(bytes, kind);
        other && loaded.error().code == ErrorCode::invalid)
      return refuse_file(*other);
    return loaded;
  }
  loaded->comments = file_comments(files);
  if (const auto unit = stated_unit(loaded->comments); unit && !loaded->unit)
    loaded->unit = unit->value;
  if (const auto up = stated_up(loaded->comments); up && loaded->up.empty()) loaded->up = up->value;
  adopt_lone_picture(files, loaded->mesh, loaded->repairs);
  if (loaded->mesh.triangles.empty() && loaded->mesh.positions.empty())
    return refuse_file("The file contains no triangle and no point: it is empty.");
  return loaded;
}

}  // namespace

// Takes ownership of the files and unmaps them before `repair` needs the memory.
Result<LoadedMesh> load_mesh(InputFiles files, Progress& progress, const LoadOptions& options) {
  auto loaded = STRATA_TRY([&] {
    const InputFiles opened = std::move(files);
    return parse(opened, progress);
  }());
  if (loaded.mesh.triangles.empty()) {
    loaded.from_points = STRATA_TRY(
        surface_from_points(loaded.mesh, loaded.point_normals, options.points, progress));
    loaded.point_normals = {};
  }
  STRATA_TRY(repair(loaded, progress, options));
  return loaded;
}

Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress,
                             const LoadOptions& options) {
  auto opened = STRATA_TRY(InputFiles::open(files, progress));
  return load_mesh(std::move(opened), progress, options);
}

Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename,
                             Progress& progress) {
  const InputFile one{filename, file};
  return load_mesh(std::span(&one, 1), progress);
}

Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress) {
  std::vector<InputFiles::Entry> entries;
  entries.push_back({filename, bytes, std::nullopt});
  auto opened =
      InputFiles::of(std::move(entries), std::filesystem::temp_directory_path(), progress);
  if (!opened) return tl::unexpected(opened.error());
  return load_mesh(std::move(*opened), progress);
}

}  // namespace strata::mesh
