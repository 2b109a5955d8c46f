#include "mesh/rollout/trace_rollout.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

constexpr int kRowsAtOnce = 64;  // between two reports

// Casts the rays of one side of a sheet.
class Rays {
 public:
  Rays(const SearchTree& tree, const Geometry& geometry, const RolloutSheet& sheet)
      : tree_(tree), origin_(geometry.origin), sheet_(sheet) {
    // The rays from the outside begin beyond the corners of the model's box.
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 place(corner & 1 ? geometry.box_max.x : geometry.box_min.x,
                             corner & 2 ? geometry.box_max.y : geometry.box_min.y,
                             corner & 4 ? geometry.box_max.z : geometry.box_min.z);
      reach_ = std::max(reach_, glm::distance(origin_ + place, sheet.surface.point));
    }
  }

  std::optional<RolloutHit> cast(const glm::dvec2& on_sheet) const {
    const auto place = sheet_.on_surface(on_sheet);
    if (!place) return std::nullopt;
    const DevelopedSurface& surface = sheet_.surface;
    const bool is_outside = sheet_.side == RolloutSide::outside;
    const glm::dvec3 normal = surface.normal(place->angle);
    const double to_axis = surface.radius_at(place->slant) / std::cos(surface.half_angle);
    const glm::dvec3 on_axis = surface.at(place->angle, place->slant) - to_axis * normal - origin_;
    // A point of the box is at most this far from each point of the axis in its extent.
    const double length = 2 * reach_ + to_axis;
    const glm::dvec3 start = is_outside ? on_axis + length * normal : on_axis;
    const glm::dvec3 direction = is_outside ? -normal : normal;
    const auto hit = tree_.first_hit(glm::vec3(start), glm::vec3(direction));
    if (!hit || hit->distance > length || glm::dot(glm::dvec3(hit->normal), direction) >= 0)
      return std::nullopt;
    return RolloutHit{*place, *hit};
  }

 private:
  const SearchTree& tree_;
  const glm::dvec3 origin_;
  const RolloutSheet& sheet_;
  double reach_ = 0;
};

// Returns the size in whole pixels. A border narrower than a hundredth of a pixel gets no pixels,
// so a rounding error adds no empty row.
glm::dvec2 size_of(const RolloutSheet& sheet, double units_per_pixel) {
  constexpr double kNoPixel = 0.01;
  return glm::max(glm::ceil((sheet.max - sheet.min) / units_per_pixel - kNoPixel), 1.0);
}

}  // namespace

double pixels_of(const RolloutSheet& sheet, double units_per_pixel) {
  const glm::dvec2 size = size_of(sheet, units_per_pixel);
  return size.x * size.y;
}

RolloutWindow window_of(const RolloutSheet& sheet, double units_per_pixel) {
  const glm::dvec2 size = size_of(sheet, units_per_pixel);
  return {{sheet.min.x, sheet.max.y},
          units_per_pixel,
          static_cast<int>(size.x),
          static_cast<int>(size.y)};
}

Result<void> trace_rollout(const SearchTree& tree, const Geometry& geometry,
                           const RolloutSheet& sheet, const RolloutWindow& window,
                           const SeeRolloutRow& see, Progress& progress) {
  const Rays rays(tree, geometry, sheet);
  for (int first = 0; first < window.height; first += kRowsAtOnce) {
    if (progress.cancelled()) return cancelled_problem();
    parallel_for(background_threads(), std::min(kRowsAtOnce, window.height - first), [&](int i) {
      const int row = first + i;
      std::vector<std::optional<RolloutHit>> pixels(static_cast<std::size_t>(window.width));
      for (int column = 0; column < window.width; ++column)
        pixels[static_cast<std::size_t>(column)] = rays.cast(window.center_of(column, row));
      see(row, pixels);
    });
    progress.report(std::min(1.0, static_cast<double>(first + kRowsAtOnce) / window.height),
                    "Unrolling the surface");
  }
  return {};
}

}  // namespace strata::mesh
