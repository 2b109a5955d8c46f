#include "app/photographs/undistort.h"

#include <algorithm>
#include <cmath>

#include "domain/people/question.h"

namespace strata::app {
namespace {

constexpr std::size_t kChannels = 4;
constexpr std::uint8_t kOpaque = 255;

std::size_t offset_of(const Picture& picture, int x, int y) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
          static_cast<std::size_t>(x)) *
         kChannels;
}

// Interpolates between the four nearest pixel centers. The borders continue outward.
void sample(const Picture& picture, const glm::dvec2& at, std::uint8_t* out) {
  const double x = std::clamp(at.x - 0.5, 0.0, picture.width - 1.0);
  const double y = std::clamp(at.y - 0.5, 0.0, picture.height - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, picture.width - 1);
  const int bottom = std::min(top + 1, picture.height - 1);
  const double by_x = x - left, by_y = y - top;
  const std::uint8_t* pixels = picture.rgba.data();
  const std::uint8_t* corners[] = {
      pixels + offset_of(picture, left, top), pixels + offset_of(picture, right, top),
      pixels + offset_of(picture, left, bottom), pixels + offset_of(picture, right, bottom)};
  for (std::size_t i = 0; i + 1 < kChannels; ++i) {
    const double above = corners[0][i] + by_x * (corners[1][i] - corners[0][i]);
    const double below = corners[2][i] + by_x * (corners[3][i] - corners[2][i]);
    out[i] = static_cast<std::uint8_t>(std::lround(above + by_y * (below - above)));
  }
}

Picture half_of(const Picture& picture) {
  Picture half;
  half.width = std::max(1, picture.width / 2);
  half.height = std::max(1, picture.height / 2);
  half.rgba.resize(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height) *
                   kChannels);
  const QuestionTurn turn;
  for (int y = 0; y < half.height; ++y) {
    turn.check(static_cast<std::uint64_t>(picture.width) * 2);
    const int bottom = std::min(2 * y + 1, picture.height - 1);
    for (int x = 0; x < half.width; ++x) {
      const int right = std::min(2 * x + 1, picture.width - 1);
      const std::uint8_t* pixels = picture.rgba.data();
      for (std::size_t i = 0; i < kChannels; ++i) {
        const int sum = pixels[offset_of(picture, 2 * x, 2 * y) + i] +
                        pixels[offset_of(picture, right, 2 * y) + i] +
                        pixels[offset_of(picture, 2 * x, bottom) + i] +
                        pixels[offset_of(picture, right, bottom) + i];
        half.rgba[offset_of(half, x, y) + i] = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

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
  const glm::dvec2 to_original(static_cast<double>(original.width) / camera.width,
                               static_cast<double>(original.height) / camera.height);
  const QuestionTurn turn;
  for (int y = 0; y < picture.height; ++y) {
    turn.check(static_cast<std::uint64_t>(width));
    for (int x = 0; x < width; ++x) {
      std::uint8_t* out = picture.rgba.data() + offset_of(picture, x, y);
      out[kChannels - 1] = kOpaque;
      const glm::dvec2 direction = direction_of(pinhole, (glm::dvec2(x, y) + 0.5) * to_pinhole);
      const auto pixel = photo::project(camera, axes, glm::dvec3(direction, 1));
      if (pixel && photo::is_inside(camera, *pixel)) sample(original, *pixel * to_original, out);
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
  while (std::max(picture.width, picture.height) >= 2 * side &&
         std::max(picture.width, picture.height) > 1)
    picture = half_of(picture);
  return picture;
}

}  // namespace strata::app
