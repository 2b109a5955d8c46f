#include "app/figures/rollout.h"

#include <algorithm>
#include <cmath>

#include "app/layers/drawn_layers.h"
#include "domain/scene/model.h"
#include "mesh/surface/surface_normals.h"
#include "room/surface.h"

namespace strata::app {
namespace {

// The light of relief comes from the upper left of the sheet, in the directions right, up and
// toward the viewer.
const glm::dvec3 kLight = glm::normalize(glm::dvec3(-1, 1, 1.4));
constexpr double kAmbient = 0.35;

// Returns the brightness of a point: 1 where it has the normal of the fitted surface.
double relief_at(const mesh::RolloutSheet& sheet, const mesh::RolloutHit& pixel,
                 const mesh::SurfaceNormals& normals) {
  const glm::dvec3 light = sheet.in_world(pixel.place, glm::dvec2(kLight), kLight.z);
  const glm::dvec3 normal(normals.at(pixel.hit.triangle, pixel.hit.barycentric));
  return kAmbient + (1 - kAmbient) * std::max(0.0, glm::dot(normal, light)) / kLight.z;
}

}  // namespace

Result<mesh::FittedSheet> plan_rollout(const RolloutRequest& request) {
  const auto sheet = STRATA_TRY(request.room->surface().sheet(request.fit, request.cut));
  return *sheet;
}

Result<void> draw_rollout(const Services& services, const RolloutRequest& request,
                          const mesh::FittedSheet& plan, const mesh::RolloutWindow& window,
                          const TakeRolloutRow& take, Progress& progress) {
  const auto geometry = request.room->surface().geometry();
  const auto tree = request.room->surface().search_tree();
  const ComposedSurface surface = STRATA_TRY(compose_surface(
      services, *request.room, request.role, request.layers, request.shown, request.at));
  std::optional<mesh::SurfaceNormals> normals;
  if (request.relief) normals.emplace(geometry);
  const auto draw_row = [&](int row, std::span<const std::optional<mesh::RolloutHit>> pixels) {
    std::vector<std::uint8_t> line(4 * pixels.size(), 0);
    std::uint8_t* rgba = line.data();
    for (const auto& pixel : pixels) {
      if (pixel) {
        const double brightness = normals ? relief_at(plan.sheet, *pixel, *normals) : 1;
        const glm::dvec3 color = brightness * surface.colors.at(pixel->hit);
        for (int i = 0; i < 3; ++i)
          rgba[i] = static_cast<std::uint8_t>(std::lround(std::clamp(color[i], 0.0, 255.0)));
        rgba[3] = 255;
      }
      rgba += 4;
    }
    take(row, line);
  };
  return mesh::trace_rollout(*tree, *geometry, plan.sheet, window, draw_row, progress);
}

Result<Picture> draw_rollout(const Services& services, const RolloutRequest& request,
                             const mesh::FittedSheet& plan, const mesh::RolloutWindow& window,
                             Progress& progress) {
  Picture picture{window.width, window.height, {}};
  picture.rgba.resize(std::size_t{4} * static_cast<std::size_t>(window.width) *
                      static_cast<std::size_t>(window.height));
  const auto take = [&](int row, std::span<const std::uint8_t> rgba) {
    std::ranges::copy(rgba, picture.rgba.begin() + static_cast<std::ptrdiff_t>(rgba.size()) * row);
  };
  STRATA_TRY(draw_rollout(services, request, plan, window, take, progress));
  return picture;
}

}  // namespace strata::app
