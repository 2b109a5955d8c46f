#include "mesh/io/join_parts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/text/filename.h"
#include "core/text/utf8.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

constexpr std::size_t kMaxNameBytes = 200, kMaxFolderBytes = 1000, kMaxRepairs = 500;
// The largest distance between two scans, in sums of their diagonals. Farther apart, vertices would
// lose details of the scans, because they are floats.
constexpr double kMaxDistance = 10'000;
constexpr std::uint32_t kStoneGrey = 0xffcfd3d6u, kWhite = 0xffffffffu;

// The folders and the name of a file.
struct FilePath {
  std::vector<std::string> folders;
  std::string name;
};

FilePath path_of(const std::string& filename) {
  FilePath path;
  std::string rest = relative_filename(filename);
  for (std::size_t slash; (slash = rest.find('/')) != std::string::npos;) {
    path.folders.push_back(rest.substr(0, slash));
    rest.erase(0, slash + 1);
  }
  path.name = rest;
  return path;
}

std::size_t common_folders(const std::vector<FilePath>& paths) {
  std::size_t common = paths.front().folders.size();
  for (const FilePath& path : paths) {
    const auto [a, b] = std::ranges::mismatch(path.folders, paths.front().folders);
    common = std::min(common, static_cast<std::size_t>(a - path.folders.begin()));
  }
  return common;
}

// Returns names and folders of the parts. Scans in one folder whose names differ in their extension
// only keep it.
std::vector<ModelPart> name_parts(const std::vector<LoadedPart>& files) {
  std::vector<FilePath> paths;
  for (const LoadedPart& file : files) paths.push_back(path_of(file.filename));
  const std::size_t common = common_folders(paths);
  std::vector<ModelPart> parts;
  for (const FilePath& path : paths) {
    ModelPart& part = parts.emplace_back();
    part.name = filename_stem(path.name);
    for (std::size_t i = common; i < path.folders.size(); ++i)
      part.folder += (part.folder.empty() ? "" : "/") + path.folders[i];
  }
  const std::vector<ModelPart> stems = parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto same = [&](const ModelPart& other) {
      return other.folder == stems[i].folder && other.name == stems[i].name;
    };
    if (std::ranges::count_if(stems, same) > 1) parts[i].name = paths[i].name;
  }
  for (ModelPart& part : parts) {
    part.name = first_bytes(part.name, kMaxNameBytes);
    part.folder = first_bytes(part.folder, kMaxFolderBytes);
  }
  return parts;
}

tl::unexpected<Error> differ(const std::string& what, const std::string& a_file,
                             const std::string& a, const std::string& b_file,
                             const std::string& b) {
  return fail(ErrorCode::invalid, "Scans do not fit together",
              "The parts of a model must have the same " + what + ", but " + mended_utf8(a_file) +
                  " has " + a + " and " + mended_utf8(b_file) + " has " + b +
                  ". Convert one of them, or import the scans one by one.",
              "file");
}

// Sets `to` to the value that the files state. Fails if they state different values.
Result<void> agree(const std::vector<LoadedPart>& files, const std::string& what,
                   std::string LoadedMesh::*member, LoadedMesh& to) {
  const LoadedPart* first = nullptr;
  for (const LoadedPart& file : files) {
    const std::string& stated = file.loaded.*member;
    if (stated.empty()) continue;
    if (first && first->loaded.*member != stated)
      return differ(what, first->filename, first->loaded.*member, file.filename, stated);
    first = first ? first : &file;
  }
  if (first) to.*member = first->loaded.*member;
  return {};
}

std::uint32_t packed(const glm::vec4& color) {
  const glm::uvec3 bytes(glm::round(glm::clamp(glm::vec3(color), 0.0f, 1.0f) * 255.0f));
  return bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u;
}

// Gives a mesh vertex colors that keep its appearance if `tints` is the joined mesh's
// `colors_tint_materials`.
void give_colors(TriangleMesh& mesh, bool tints) {
  // Alone, such a mesh shows only the colors of its vertices.
  if (mesh.textures.empty() && !mesh.vertex_colors.empty() && !mesh.colors_tint_materials) {
    mesh.materials.clear();
    mesh.triangle_materials.clear();
  }
  if (!mesh.textures.empty()) {
    if (mesh.vertex_colors.empty() || (tints && !mesh.colors_tint_materials))
      mesh.vertex_colors.assign(mesh.positions.size(), kWhite);
    return;
  }
  if (!mesh.vertex_colors.empty()) return;
  mesh.vertex_colors.assign(mesh.positions.size(), kStoneGrey);
  for (std::size_t t = 0; t < mesh.triangle_materials.size(); ++t) {
    if (mesh.triangle_materials[t] == kNoMaterial) continue;
    for (std::size_t k = 0; k < 3; ++k)
      mesh.vertex_colors[mesh.triangles[3 * t + k]] =
          tints ? kWhite : packed(mesh.materials[mesh.triangle_materials[t]].color);
  }
}

template <class T>
void move_to(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  from = {};
}

// The optional members that the joined mesh has, because a part has them.
struct Members {
  bool uvs = false, materials = false, colors = false;
};

void append(TriangleMesh mesh, TriangleMesh& all, const Members& has) {
  const auto first_position = static_cast<std::uint32_t>(all.positions.size());
  const auto first_material = static_cast<std::uint16_t>(all.materials.size());
  const auto first_texture = static_cast<int>(all.textures.size());
  for (std::uint32_t& index : mesh.triangles) index += first_position;
  for (Material& material : mesh.materials)
    if (material.texture >= 0) material.texture += first_texture;
  for (std::uint16_t& material : mesh.triangle_materials)
    if (material != kNoMaterial) material = static_cast<std::uint16_t>(material + first_material);
  if (has.uvs) mesh.corner_uvs.resize(mesh.triangles.size(), glm::vec2(0));
  if (has.materials) mesh.triangle_materials.resize(mesh.triangle_count(), kNoMaterial);
  move_to(mesh.positions, all.positions);
  move_to(mesh.triangles, all.triangles);
  move_to(mesh.corner_uvs, all.corner_uvs);
  move_to(mesh.vertex_colors, all.vertex_colors);
  move_to(mesh.triangle_materials, all.triangle_materials);
  move_to(mesh.materials, all.materials);
  move_to(mesh.textures, all.textures);
  all.part_ends.push_back(static_cast<std::uint32_t>(all.triangle_count()));
}

void measure(const TriangleMesh& mesh, ModelPart& part) {
  part.triangles = mesh.triangle_count();
  part.area = surface_area(mesh);
  if (mesh.positions.empty()) return;
  part.bounds_min = glm::dvec3(std::numeric_limits<double>::infinity());
  part.bounds_max = -part.bounds_min;
  for (const glm::dvec3& position : mesh.positions) {
    part.bounds_min = glm::min(part.bounds_min, position);
    part.bounds_max = glm::max(part.bounds_max, position);
  }
}

// Each scan can have many notes, such as one for each missing texture.
void add_repairs(const std::vector<Repair>& from, std::vector<Repair>& to) {
  for (Repair repair : from) {
    if (to.size() >= kMaxRepairs) repair.what = "more changes of other kinds";
    const auto same = std::ranges::find(to, repair.what, &Repair::what);
    if (same == to.end())
      to.push_back(repair);
    else
      same->count += repair.count;
  }
}

// Adds the facts about the surface of another scan. Lengths are those of the coarsest scan.
void add_facts(const SurfaceFromPoints& from, double scale, std::optional<SurfaceFromPoints>& to) {
  if (!to) to.emplace();
  to->points += from.points;
  to->used += from.used;
  for (double SurfaceFromPoints::*length :
       {&SurfaceFromPoints::point_spacing, &SurfaceFromPoints::cell, &SurfaceFromPoints::gap,
        &SurfaceFromPoints::distance_median, &SurfaceFromPoints::distance_95})
    (*to).*length = std::max((*to).*length, from.*length * scale);
}

// Refuses two scans that cannot have common coordinates.
Result<void> check_distance(const std::vector<LoadedPart>& files,
                            const std::vector<ModelPart>& parts, std::size_t a, std::size_t b) {
  const auto center = [&](std::size_t i) {
    return (parts[i].bounds_min + parts[i].bounds_max) / 2.0;
  };
  const auto size = [&](std::size_t i) {
    return glm::distance(parts[i].bounds_min, parts[i].bounds_max);
  };
  if (glm::distance(center(a), center(b)) <= kMaxDistance * (size(a) + size(b))) return {};
  return fail(ErrorCode::invalid, "Scans do not fit together",
              "The parts of a model must have common coordinates, but " +
                  mended_utf8(files[a].filename) + " and " + mended_utf8(files[b].filename) +
                  " are more than 10 000 times their size apart. Export both in one coordinate "
                  "system, or import the scans one by one.",
              "file");
}

Result<void> check_size(const std::vector<LoadedPart>& files) {
  std::size_t triangles = 0, materials = 0, positions = 0;
  for (const LoadedPart& file : files) {
    triangles += file.loaded.mesh.triangle_count();
    materials += file.loaded.mesh.materials.size();
    positions += file.loaded.mesh.positions.size();
  }
  if (triangles > kMaxTriangles || positions > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorCode::invalid, "Too many triangles",
                "The scans have " + std::to_string(triangles) +
                    " triangles together. A model can have at most " +
                    std::to_string(kMaxTriangles) + ".",
                "file");
  if (materials >= kNoMaterial)
    return fail(ErrorCode::invalid, "Too many materials",
                "The scans have " + std::to_string(materials) +
                    " materials together. A model can have at most " +
                    std::to_string(kNoMaterial - 1) + ".",
                "file");
  return {};
}

}  // namespace

Result<LoadedMesh> join_parts(std::vector<LoadedPart> files) {
  STRATA_TRY(check_size(files));
  LoadedMesh joined;
  STRATA_TRY(agree(files, "up direction", &LoadedMesh::up, joined));
  STRATA_TRY(agree(files, "coordinate system", &LoadedMesh::crs, joined));
  std::vector<ModelPart> parts = name_parts(files);
  std::vector<std::size_t> order(files.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) {
    return std::pair<const std::string&, const std::string&>(parts[i].folder, parts[i].name);
  });
  Members has;
  for (const std::size_t i : order) {
    const TriangleMesh& mesh = files[i].loaded.mesh;
    if (!joined.unit) joined.unit = files[i].loaded.unit;
    has.uvs |= !mesh.corner_uvs.empty();
    has.materials |= !mesh.triangle_materials.empty();
    has.colors |= !mesh.vertex_colors.empty();
    joined.mesh.colors_tint_materials |=
        mesh.colors_tint_materials && !mesh.vertex_colors.empty() && !mesh.materials.empty();
  }
  for (const std::size_t i : order) {
    LoadedMesh loaded = std::move(files[i].loaded);
    const double scale = loaded.unit ? metres_per(*loaded.unit) / metres_per(*joined.unit) : 1.0;
    if (scale != 1)
      for (glm::dvec3& position : loaded.mesh.positions) position *= scale;
    if (has.colors) give_colors(loaded.mesh, joined.mesh.colors_tint_materials);
    measure(loaded.mesh, parts[i]);
    append(std::move(loaded.mesh), joined.mesh, has);
    add_repairs(loaded.repairs, joined.repairs);
    for (const std::string& comment : loaded.comments)
      if (std::ranges::find(joined.comments, comment) == joined.comments.end())
        joined.comments.push_back(comment);
    if (loaded.from_points) add_facts(*loaded.from_points, scale, joined.from_points);
    joined.parts.push_back(parts[i]);
    if (i != order.front()) STRATA_TRY(check_distance(files, parts, order.front(), i));
  }
  return joined;
}

}  // namespace strata::mesh
