#include "mesh/load.h"

#include "mesh/load_formats.h"

namespace strata::mesh {
namespace {

Result<LoadedMesh> parse(const InputFiles& files, Progress& progress) {
  const auto bytes = files.scan().bytes;
  if (bytes.empty()) return refuse_file("The file is empty.");
  auto loaded = [&]() -> Result<LoadedMesh> {
    switch (input_kind(files.scan().name)) {
      case InputKind::ply: return parse_ply(bytes, progress);
      case InputKind::obj: return parse_obj(bytes, progress);
      default: return fail(415, "Format not taken", "PLY and OBJ files are read.", "filename");
    }
  }();
  if (!loaded) return loaded;
  if (loaded->mesh.triangles.empty()) {
    return refuse_file(
        loaded->mesh.positions.empty()
            ? "The file holds no triangle: it is empty."
            : "The file holds " + std::to_string(loaded->mesh.positions.size()) +
                  " vertices but no triangle: a point cloud cannot carry layers. Mesh it before importing it.");
  }
  return loaded;
}

// Takes the files, so that they are unmapped before `repair` needs the memory.
Result<LoadedMesh> load(Result<InputFiles> files, Progress& progress) {
  if (!files) return tl::unexpected(files.error());
  auto loaded = [&] {
    const InputFiles opened = std::move(*files);
    return parse(opened, progress);
  }();
  if (!loaded) return loaded;
  if (auto repaired = repair(*loaded, progress); !repaired) return tl::unexpected(repaired.error());
  return loaded;
}

}  // namespace

Result<LoadedMesh> load_mesh(std::span<const InputFile> files, Progress& progress) {
  return load(InputFiles::open(files), progress);
}

Result<LoadedMesh> load_mesh(const std::filesystem::path& file, const std::string& filename, Progress& progress) {
  const InputFile one{filename, file};
  return load_mesh(std::span(&one, 1), progress);
}

Result<LoadedMesh> load_mesh_bytes(std::span<const std::uint8_t> bytes, const std::string& filename,
                                   Progress& progress) {
  std::vector<InputFiles::Entry> entries;
  entries.push_back({filename, bytes, std::nullopt});
  return load(InputFiles::of(std::move(entries)), progress);
}

}  // namespace strata::mesh
