#include "mesh/io/load.h"

#include "core/text/utf8.h"
#include "mesh/io/file_comments.h"
#include "mesh/io/file_nature.h"
#include "mesh/io/join_parts.h"
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

// Parses the chosen scan, and unmaps the files of a single scan before `repair` needs the memory.
Result<LoadedMesh> load_scan(InputFiles& files, Progress& progress, const LoadOptions& options) {
  auto loaded = STRATA_TRY(parse(files, progress));
  if (files.scan_count() == 1) files = {};
  if (loaded.mesh.triangles.empty()) {
    loaded.from_points = STRATA_TRY(
        surface_from_points(loaded.mesh, loaded.point_normals, options.points, progress));
    loaded.point_normals = {};
  }
  STRATA_TRY(repair(loaded, progress, options));
  return loaded;
}

}  // namespace

Result<LoadedMesh> load_mesh(InputFiles files, Progress& progress, const LoadOptions& options) {
  const std::size_t count = files.scan_count();
  if (count == 1) return load_scan(files, progress, options);
  std::vector<LoadedPart> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const Progress::Share share(progress, static_cast<double>(i) / static_cast<double>(count),
                                static_cast<double>(i + 1) / static_cast<double>(count));
    files.choose_scan(i);
    auto loaded = load_scan(files, progress, options);
    if (!loaded && loaded.error().code != ErrorCode::cancelled) {
      Error error = loaded.error();
      error.detail = mended_utf8(files.scan().name) + ": " + error.detail;
      return tl::unexpected(std::move(error));
    }
    if (!loaded) return loaded;
    parts.push_back({files.scan().name, std::move(*loaded)});
  }
  return join_parts(std::move(parts));
}

Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress,
                             const LoadOptions& options) {
  auto opened = STRATA_TRY(InputFiles::open(files, progress, options.parts));
  LoadOptions with_folder = options;
  if (!files.empty()) with_folder.points.folder = scratch_beside(files[0].path);
  return load_mesh(std::move(opened), progress, with_folder);
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
