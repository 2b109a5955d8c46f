#include "mesh/analysis/ray_scene.h"

#include <embree3/rtcore.h>

#include <cstddef>
#include <utility>

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

// Larger than the rounding errors of float coordinates and smaller than any measured length.
constexpr float kLift = 2e-6f;  // of the diagonal of the model
constexpr const char* kPreparing = "Preparing rays";

// The ray tracer calls this function while it builds its tree. It returns false to cancel the
// build.
bool goes_on(void* progress, double done) {
  auto& watched = *static_cast<Progress*>(progress);
  watched.report(done, kPreparing);
  return !watched.cancelled();
}

}  // namespace

struct RayScene::Tree {
  std::shared_ptr<const Geometry> geometry;  // the scene reads its arrays
  Device device;
  Scene scene;
  float lift;
};

RayScene::RayScene(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
RayScene::~RayScene() = default;

bool RayScene::is_blocked(const glm::vec3& position, const glm::vec3& normal,
                          const glm::vec3& direction, float distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const glm::vec3 from = position + tree_->lift * normal;
  RTCRay ray{from.x,      from.y, from.z,   0,   direction.x, direction.y,
             direction.z, 0,      distance, ~0u, 0,           0};
  rtcOccluded1(tree_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

std::optional<RayScene::Hit> RayScene::first_hit(const glm::vec3& from, const glm::vec3& direction,
                                                 float least) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found{};
  found.ray = {from.x,      from.y,      from.z,
               least,       direction.x, direction.y,
               direction.z, 0,           std::numeric_limits<float>::infinity(),
               ~0u,         0,           0};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(tree_->scene.get(), &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Geometry& geometry = *tree_->geometry;
  const auto corner = [&](std::size_t k) {
    return geometry.vertices[geometry.indices[3 * std::size_t{found.hit.primID} + k]].position;
  };
  const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
  return Hit{found.hit.primID,
             {1 - found.hit.u - found.hit.v, found.hit.u, found.hit.v},
             found.ray.tfar,
             glm::dot(normal, direction) > 0};
}

Result<std::unique_ptr<RayScene>> RayScene::make(std::shared_ptr<const Geometry> geometry,
                                                 Progress& progress) {
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
  const float lift = glm::length(geometry->box_max - geometry->box_min) * kLift;
  return std::unique_ptr<RayScene>(new RayScene(std::make_unique<Tree>(
      Tree{std::move(geometry), std::move(device), std::move(scene), lift})));
}

}  // namespace strata::mesh
