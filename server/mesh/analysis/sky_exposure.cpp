#include "mesh/analysis/sky_exposure.h"

#include <limits>
#include <utility>

#include "core/progress.h"
#include "mesh/analysis/ray_scene.h"

namespace strata::mesh {
namespace {

class RaySkyExposure final : public SkyExposure {
 public:
  RaySkyExposure(std::unique_ptr<RayScene> scene, std::vector<SkySector> sectors)
      : scene_(std::move(scene)), sectors_(std::move(sectors)) {}

  Sum at(const glm::vec3& position, const glm::vec3& normal) const override {
    const float length = glm::length(normal);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!(length > 0)) return {kNone, kNone};
    const glm::vec3 up = normal / length;
    Sum sum;
    for (const SkySector& sector : sectors_) {
      const double cosine = glm::dot(glm::dvec3(up), sector.direction);
      if (cosine <= 0 || scene_->is_blocked(position, up, glm::vec3(sector.direction))) continue;
      sum.hours += sector.hours;
      sum.amount += sector.amount * cosine;
    }
    return sum;
  }

 private:
  std::unique_ptr<RayScene> scene_;
  std::vector<SkySector> sectors_;
};

}  // namespace

Result<std::unique_ptr<SkyExposure>> SkyExposure::make(std::shared_ptr<const Geometry> geometry,
                                                       std::vector<SkySector> sectors,
                                                       Progress& progress) {
  auto scene = STRATA_TRY(RayScene::make(std::move(geometry), progress));
  return std::make_unique<RaySkyExposure>(std::move(scene), std::move(sectors));
}

}  // namespace strata::mesh
