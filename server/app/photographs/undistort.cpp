#include "app/photographs/undistort.h"

#include <algorithm>
#include <cmath>

#include "domain/people/question.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::app {
namespace {

constexpr std::size_t kChannels = 4;
constexpr std::uint8_t kOpaque = 255;

}  // namespace

Picture undistorted(const Picture& original, const photo::Camera& camera, const Pinhole& pinhole,
                    int width) {
  const photo::Pose axes;
  Picture picture;
  picture.width = width;
  picture.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(width) *
                                                            pinhole.height / pinhole.width)));
  picture.rgba.resize(static_cast<std::size_t>(picture.width) *
                      static_cast<std::size_t>(picture.height) * kChannels);
  const glm::dvec2 to_pinhole(static_cast<double>(pinhole.width) / picture.width,
                              static_cast<double>(pinhole.height) / picture.height);
  const mesh::TextureSampler sampler(original);
  const auto color_at = [&](const glm::dvec2& pixel) {  // of the original; its borders continue
    const glm::dvec2 uv{pixel.x / camera.width, 1 - pixel.y / camera.height};
    return glm::round(sampler.sample(uv, mesh::Wrap::clamp, mesh::Wrap::clamp));
  };
  const QuestionTurn turn;
  for (int y = 0; y < picture.height; ++y) {
    turn.check(static_cast<std::uint64_t>(width));
    for (int x = 0; x < width; ++x) {
      std::uint8_t* out =
          picture.rgba.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(x)) *
                                    kChannels;
      out[kChannels - 1] = kOpaque;
      const glm::dvec2 direction = direction_of(pinhole, (glm::dvec2(x, y) + 0.5) * to_pinhole);
      const auto pixel = photo::project(camera, axes, glm::dvec3(direction, 1));
      if (!pixel || !photo::is_inside(camera, *pixel)) continue;
      const glm::vec3 color = color_at(*pixel);
      for (glm::length_t i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>(color[i]);
    }
  }
  return picture;
}

int side_for(const photo::Camera& camera, const Pinhole& pinhole, int width) {
  // Near the axis, the pinhole has this many pixels for each pixel of the photograph.
  const double scale =
      width / ((pinhole.right - pinhole.left) * std::sqrt(camera.focal.x * camera.focal.y));
  const int longest = std::max(camera.width, camera.height);
  return std::clamp(static_cast<int>(std::ceil(longest * std::min(scale, 1.0))), 1, longest);
}

Picture halved_to(Picture picture, int side) {
  const QuestionTurn turn;
  while (std::max(picture.width, picture.height) >= 2 * side &&
         std::max(picture.width, picture.height) > 1) {
    turn.check(static_cast<std::uint64_t>(picture.width) *
               static_cast<std::uint64_t>(picture.height));
    picture = mesh::halve(picture);
  }
  return picture;
}

}  // namespace strata::app
