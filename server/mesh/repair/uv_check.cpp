#include <cmath>
#include <cstdio>
#include <string>

#include "mesh/atlas/atlas.h"
#include "mesh/atlas/atlas_limits.h"
#include "mesh/atlas/atlas_report.h"
#include "mesh/atlas/uv_move.h"
#include "mesh/io/load_formats.h"
#include "mesh/repair/uv_faults.h"
#include "mesh/surface/uv_islands.h"

namespace strata::mesh {
namespace {

constexpr double kMaxOverlap = 0.005;        // of covered texels
constexpr double kMaxAreaWithoutUv = 0.001;  // of the surface
constexpr double kMaxMoved = 0.1;            // of the surface
constexpr const char* kTitle = "Texture coordinates not usable";

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
  return text;
}

Result<Atlas> refuse(const std::string& reason) {
  return fail(ErrorCode::invalid, kTitle,
              reason + " The server creates a new atlas for this model instead.",
              "texture_coordinates");
}

bool has_surface(const TriangleMesh& mesh, std::size_t t) {
  const auto a = mesh.positions[mesh.triangles[3 * t]];
  return glm::cross(mesh.positions[mesh.triangles[3 * t + 1]] - a,
                    mesh.positions[mesh.triangles[3 * t + 2]] - a) != glm::dvec3(0);
}

UvFaults no_faults(const TriangleMesh& mesh) {
  UvFaults faults;
  faults.of_triangle.assign(mesh.triangle_count(), UvFault::none);
  return faults;
}

// Reports the most frequent fault as the reason why too many triangles cannot stay.
Result<Atlas> refuse_faults(const TriangleMesh& mesh, const UvFaults& faults) {
  int worst = 1;
  for (int fault = 2; fault < kUvFaults; ++fault)
    if (faults.count[fault] > faults.count[worst]) worst = fault;
  const auto fault = static_cast<UvFault>(worst);
  return refuse("Texture coordinates of " + std::to_string(faults.count[worst]) + " of " +
                std::to_string(mesh.triangle_count()) + " triangles " +
                std::string(words_of(fault)) +
                (fault == UvFault::outside ? " (a repeating texture, or several tiles)." : "."));
}

std::vector<std::uint32_t> numbers_of(const UvFaults& faults) {
  std::vector<std::uint32_t> numbers;
  for (std::size_t t = 0; t < faults.of_triangle.size(); ++t)
    if (faults.of_triangle[t] != UvFault::none) numbers.push_back(static_cast<std::uint32_t>(t));
  return numbers;
}

void note_moved(const UvFaults& faults, float scale, std::vector<Repair>& repairs) {
  for (int fault = 1; fault < kUvFaults; ++fault)
    note(repairs,
         "moved to free places of the texture, as their texture coordinates " +
             std::string(words_of(static_cast<UvFault>(fault))) + ": triangles",
         faults.count[fault]);
  if (scale < 1)
    note(repairs,
         "texture coordinates made smaller to make room for them: by " + percent(1 - scale), 1);
}

// Moves the triangles that cannot stay.
Result<void> move_faults(const TriangleMesh& mesh, UvFaults& faults, int lowest_resolution,
                         Progress& progress, Atlas& atlas) {
  // Triangles without area need no texels.
  for (std::size_t t = 0; t < faults.of_triangle.size(); ++t) {
    if (faults.of_triangle[t] == UvFault::none || has_surface(mesh, t)) continue;
    --faults.count[static_cast<std::size_t>(faults.of_triangle[t])];
    faults.of_triangle[t] = UvFault::none;
    for (std::size_t k = 0; k < 3; ++k) atlas.corner_uvs[3 * t + k] = glm::vec2(0);
  }
  atlas.moved = numbers_of(faults);
  if (atlas.moved.empty()) return {};
  progress.report(0.3, "Moving triangles that cannot stay");
  auto found = move_triangles(mesh, atlas.corner_uvs, atlas.moved, lowest_resolution, progress);
  if (progress.cancelled()) return cancelled_problem();
  if (!found) return fail(ErrorCode::invalid, kTitle, "no room");
  atlas.corner_uvs = std::move(found->corner_uvs);
  atlas.kept_scale = found->scale;
  note_moved(faults, found->scale, atlas.repairs);
  return {};
}

}  // namespace

Result<Atlas> keep_uvs(const TriangleMesh& mesh, int lowest_resolution, Progress& progress) {
  if (mesh.corner_uvs.empty()) return refuse("The file has no texture coordinates.");
  if (mesh.corner_uvs.size() != mesh.triangles.size())
    return refuse("Only some triangles of the file have texture coordinates.");
  progress.report(0, "Checking the file's texture coordinates");
  Atlas atlas;
  atlas.corner_uvs.reserve(mesh.corner_uvs.size());
  UvFaults faults = find_single_faults(mesh, mesh.corner_uvs);
  const double surface = surface_area(mesh);
  const auto too_many = [&] { return faults.area > kMaxMoved * surface; };
  // Accepts a small area without texels, because moving its triangles would change the texture.
  const bool only_without_area = faults.count[static_cast<int>(UvFault::not_finite)] == 0 &&
                                 faults.count[static_cast<int>(UvFault::outside)] == 0;
  if (only_without_area && faults.area <= kMaxAreaWithoutUv * surface) faults = no_faults(mesh);
  if (too_many()) return refuse_faults(mesh, faults);
  for (std::size_t corner = 0; corner < mesh.corner_uvs.size(); ++corner) {
    const bool stays = faults.of_triangle[corner / 3] == UvFault::none;
    atlas.corner_uvs.push_back(
        stays ? glm::clamp(mesh.corner_uvs[corner], glm::vec2(0), glm::vec2(1)) : glm::vec2(0));
  }
  if (progress.cancelled()) return cancelled_problem();

  auto owners = count_owners(mesh, atlas.corner_uvs, lowest_resolution);
  if (owners.covered == 0) return refuse("The texture coordinates cover no texel.");
  const auto shared = [&] {
    return static_cast<double>(owners.shared) / static_cast<double>(owners.covered);
  };
  if (const double before = shared(); before > kMaxOverlap) {
    find_overlaps(mesh, atlas.corner_uvs, lowest_resolution, faults);
    if (too_many())
      return refuse("Triangles overlap in the texture: " + percent(before) +
                    " of the covered texels at " + std::to_string(lowest_resolution) +
                    " have more than one owner. The limit is " + percent(kMaxOverlap) + ".");
  }
  if (progress.cancelled()) return cancelled_problem();
  if (faults.area > 0 || !numbers_of(faults).empty()) {
    if (auto done = move_faults(mesh, faults, lowest_resolution, progress, atlas); !done) {
      if (progress.cancelled()) return tl::unexpected(done.error());
      return refuse_faults(mesh, faults);
    }
    owners = count_owners(mesh, atlas.corner_uvs, lowest_resolution);
    if (shared() > kMaxOverlap) return refuse_faults(mesh, faults);
  }
  progress.report(0.5, "Measuring the file's texture coordinates");
  const auto measure = measure_areas(mesh, atlas.corner_uvs);

  std::vector<std::uint32_t> indices;
  const auto vertices =
      weld_corners(mesh.triangles, atlas.corner_uvs, mesh.positions.size(), indices);
  atlas.report = make_report(mesh, atlas.corner_uvs, lowest_resolution, owners, measure);
  atlas.report.source = "file";
  atlas.report.limits = limits_of_file(atlas.report.coverage);
  atlas.report.charts = static_cast<int>(find_islands(indices, vertices).count);
  progress.report(1, "Texture coordinates kept");
  return atlas;
}

}  // namespace strata::mesh
