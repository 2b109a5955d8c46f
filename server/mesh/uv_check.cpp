#include <cmath>
#include <cstdio>
#include <string>

#include "mesh/atlas.h"
#include "mesh/atlas_report.h"
#include "mesh/uv_islands.h"

namespace strata::mesh {
namespace {

constexpr double kMostOverlap = 0.005;           // of covered texels
constexpr double kMostAreaWithoutUv = 0.001;     // of the surface
constexpr float kRoundingOutside = 1.f / 65536;  // writers round 1 up to a little more

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
  return text;
}

Result<Atlas> refuse(const std::string& reason) {
  return fail(422, "Texture coordinates not usable", reason + " An atlas of its own is made for this model instead.",
              "texture_coordinates");
}

}  // namespace

Result<Atlas> keep_uvs(const TriangleMesh& mesh, int lowest_resolution, Progress& progress) {
  if (mesh.corner_uvs.empty()) return refuse("The file has no texture coordinates.");
  if (mesh.corner_uvs.size() != mesh.triangles.size())
    return refuse("Only some triangles of the file have texture coordinates.");
  progress.report(0, "Checking the file's texture coordinates");
  Atlas atlas;
  atlas.corner_uvs.reserve(mesh.corner_uvs.size());
  std::size_t outside = 0, not_numbers = 0;
  for (const glm::vec2 uv : mesh.corner_uvs) {
    const bool is_number = std::isfinite(uv.x) && std::isfinite(uv.y);
    const glm::vec2 inside = glm::clamp(uv, glm::vec2(0), glm::vec2(1));
    if (!is_number)
      ++not_numbers;
    else if (std::abs(uv.x - inside.x) > kRoundingOutside || std::abs(uv.y - inside.y) > kRoundingOutside)
      ++outside;
    atlas.corner_uvs.push_back(inside);
  }
  const auto of_corners = [&](std::size_t count) {
    return std::to_string(count) + " of " + std::to_string(mesh.corner_uvs.size()) + " triangle corners";
  };
  if (not_numbers > 0) return refuse("Texture coordinates of " + of_corners(not_numbers) + " are not finite numbers.");
  if (outside > 0)
    return refuse("Texture coordinates of " + of_corners(outside) +
                  " lie outside the unit square (a repeating texture, or several tiles).");
  if (progress.cancelled()) return cancelled_problem();

  const auto owners = count_owners(mesh, atlas.corner_uvs, lowest_resolution);
  if (owners.covered == 0) return refuse("The texture coordinates cover no texel.");
  const double shared = static_cast<double>(owners.shared) / static_cast<double>(owners.covered);
  if (shared > kMostOverlap)
    return refuse("Triangles overlap in the texture: " + percent(shared) + " of the covered texels at " +
                  std::to_string(lowest_resolution) + " have more than one owner; " + percent(kMostOverlap) + " may.");
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.5, "Measuring the file's texture coordinates");
  const auto measure = measure_areas(mesh, atlas.corner_uvs);
  if (measure.area_without_uv > kMostAreaWithoutUv * measure.area)
    return refuse("Triangles with " + percent(measure.area_without_uv / measure.area) +
                  " of the surface have no area in the texture; " + percent(kMostAreaWithoutUv) + " may.");

  std::vector<std::uint32_t> indices;
  const auto vertices = weld_corners(mesh.triangles, atlas.corner_uvs, mesh.positions.size(), indices);
  atlas.report = make_report(mesh, atlas.corner_uvs, lowest_resolution, owners, measure);
  atlas.report.source = "file";
  atlas.report.charts = static_cast<int>(find_islands(indices, vertices).count);
  progress.report(1, "Texture coordinates kept");
  return atlas;
}

}  // namespace strata::mesh
