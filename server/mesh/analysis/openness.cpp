#include "mesh/analysis/openness.h"

#include <embree3/rtcore.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/analysis/tangent_frame.h"

namespace strata::mesh {
namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Scene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

// Returns directions that are evenly distributed over the hemisphere with cosine-weighted density:
// a golden-angle spiral on the disc, projected up to the hemisphere (Malley's method).
std::vector<glm::vec3> cosine_directions(int count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<glm::vec3> directions(count);
  for (int i = 0; i < count; ++i) {
    const double squared = (i + 0.5) / count, radius = std::sqrt(squared), angle = golden * i;
    directions[i] =
        glm::vec3(radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - squared));
  }
  return directions;
}

// Returns a number from 0 to 1 that depends on the position only.
float turn_of(const glm::vec3& p) {
  std::uint32_t h = 2166136261u;
  for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint32_t>(p[k])) * 16777619u;
  h ^= h >> 15;
  h *= 2246822519u;
  h ^= h >> 13;
  return static_cast<float>(h >> 8) / 16777216.0f;
}

class RayOpenness final : public Openness {
 public:
  RayOpenness(std::shared_ptr<const Geometry> geometry, Device device, Scene scene, float distance,
              int rays)
      : geometry_(std::move(geometry)),
        device_(std::move(device)),
        scene_(std::move(scene)),
        distance_(distance),
        // Larger than the rounding errors of float coordinates and smaller than any measured
        // length.
        lift_(glm::length(geometry_->box_max - geometry_->box_min) * 2e-6f),
        directions_(cosine_directions(rays)) {}

  float at(const glm::vec3& position, const glm::vec3& normal) const override {
    const float length = glm::length(normal);
    if (!(length > 0)) return std::nanf("");
    const TangentFrame frame(normal / length);
    const float turn = 2 * std::numbers::pi_v<float> * turn_of(position), c = std::cos(turn),
                s = std::sin(turn);
    const glm::vec3 along = c * glm::vec3(frame.x) + s * glm::vec3(frame.y),
                    across = c * glm::vec3(frame.y) - s * glm::vec3(frame.x), up(frame.z);
    const glm::vec3 from = position + lift_ * up;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    int open = 0;
    for (const glm::vec3& d : directions_) {
      const glm::vec3 direction = d.x * along + d.y * across + d.z * up;
      RTCRay ray{from.x,      from.y, from.z,    0,   direction.x, direction.y,
                 direction.z, 0,      distance_, ~0u, 0,           0};
      rtcOccluded1(scene_.get(), &context, &ray);
      if (ray.tfar >= 0) ++open;
    }
    return static_cast<float>(open) / static_cast<float>(directions_.size());
  }

 private:
  std::shared_ptr<const Geometry> geometry_;  // the scene reads its arrays
  Device device_;
  Scene scene_;
  float distance_, lift_;
  std::vector<glm::vec3> directions_;
};

constexpr const char* kPreparing = "Preparing rays";

// The ray tracer calls this function while it builds its tree. It returns false to cancel the
// build.
bool goes_on(void* progress, double done) {
  auto& watched = *static_cast<Progress*>(progress);
  watched.report(done, kPreparing);
  return !watched.cancelled();
}

}  // namespace

Result<std::unique_ptr<Openness>> Openness::make(std::shared_ptr<const Geometry> geometry,
                                                 float distance, int rays, Progress& progress) {
  const auto refused = [] {
    return fail(ErrorCode::out_of_memory, "Not enough memory",
                "The server does not have enough memory to trace rays on a model of this size. "
                "Import a smaller mesh.");
  };
  Device device(rtcNewDevice(nullptr));
  if (!device) return refused();
  Scene scene(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  RTCGeometry triangles = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             geometry->vertices.data(), offsetof(Vertex, position), sizeof(Vertex),
                             geometry->vertices.size());
  rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             geometry->indices.data(), 0, 3 * sizeof(std::uint32_t),
                             geometry->triangle_count());
  rtcCommitGeometry(triangles);
  rtcAttachGeometry(scene.get(), triangles);
  rtcReleaseGeometry(triangles);
  progress.report(0, kPreparing);
  rtcSetSceneProgressMonitorFunction(scene.get(), goes_on, &progress);
  rtcCommitScene(scene.get());
  if (progress.cancelled()) return cancelled_problem();
  rtcSetSceneProgressMonitorFunction(scene.get(), nullptr, nullptr);
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) return refused();
  return std::make_unique<RayOpenness>(std::move(geometry), std::move(device), std::move(scene),
                                       distance, rays);
}

}  // namespace strata::mesh
