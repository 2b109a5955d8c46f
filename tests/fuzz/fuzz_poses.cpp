// Fuzzes the cameras of photographs. The first byte selects the names of the files. A line of two
// percent signs is between the first file and the second. Poses must be rotations, calibrations
// must be valid, and the ray of each pixel must lead back to it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "core/text/utf8.h"
#include "media/photographs/posed_photographs.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_pose(const photo::Pose& pose) {
  const glm::dmat3 product = glm::transpose(pose.camera_from_world) * pose.camera_from_world;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      demand(std::abs(product[column][row] - (column == row)) < 1e-12);
  demand(glm::determinant(pose.camera_from_world) > 0);
  for (int axis = 0; axis < 3; ++axis) demand(std::isfinite(pose.center[axis]));
}

void check_camera(const photo::Camera& camera, const photo::Pose& pose) {
  const photo::Pose here{pose.camera_from_world, glm::dvec3(0)};
  for (const double x : {0.0, 0.3, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 0.8}) {
      const glm::dvec2 pixel(x * camera.width, y * camera.height);
      const auto ray = photo::ray_through(camera, here, pixel);
      if (!ray) continue;
      const auto back = photo::project(camera, here, ray->direction);
      demand(back && glm::length(*back - pixel) <= photo::kMaxRayError);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const bool is_binary = data[0] == 1;
  const std::span<const std::uint8_t> bytes{data + 1, size - 1};
  const std::string_view text{reinterpret_cast<const char*>(data) + 1, size - 1};
  constexpr std::string_view kBetween = "\n%%\n";
  const auto middle = text.find(kBetween);
  std::vector<photo::PoseFile> files{
      {is_binary ? "cameras.bin" : "one", bytes.first(std::min(middle, bytes.size()))}};
  if (middle != std::string_view::npos)
    files.push_back({is_binary ? "images.bin" : "two", bytes.subspan(middle + kBetween.size())});
  const auto read = photo::read_poses(files);
  if (!read) {
    demand(!is_server_failure(read.error().code) && is_utf8(read.error().detail));
    return 0;
  }
  demand(!read->photographs.empty());
  for (const auto& [name, calibration, pose] : read->photographs) {
    demand(!name.empty() && name.size() <= photo::kMaxPhotographName && is_utf8(name));
    demand(photo::check(calibration).has_value());
    check_pose(pose);
    const bool has_size = calibration.width > 0;
    const auto camera = photo::camera_for(calibration, has_size ? calibration.width : 400,
                                          has_size ? calibration.height : 300);
    demand(camera.has_value());
    check_camera(*camera, pose);
  }
  return 0;
}
