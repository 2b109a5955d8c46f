#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "app/photographs/photograph_cameras.h"
#include "app/photographs/pinhole.h"
#include "app/photographs/seeing.h"
#include "app/photographs/undistort.h"
#include "mesh/surface/search_tree.h"
#include "support/meshes.h"
#include "support/solids.h"

namespace strata::app {
namespace {

photo::Calibration calibration(int width, int height, double focal, photo::Lens lens = {}) {
  photo::Calibration out;
  out.width = width;
  out.height = height;
  out.focal = {focal, focal * 1.01};
  out.offset = {7, -4};
  out.lens = lens;
  return out;
}

const photo::Lens kBarrel{photo::LensModel::brown, {-0.2, 0.05}, {0.003, -0.002}};

// A camera at `center` that looks at `target`.
photo::Pose looking(const glm::dvec3& center, const glm::dvec3& target) {
  const glm::dvec3 z = glm::normalize(target - center);
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.1, 0.2, 1)));
  const glm::dvec3 y = glm::cross(z, x);
  return {glm::transpose(glm::dmat3(x, y, z)), center};
}

glm::dvec2 window_pixel(const Camera& camera, const glm::dvec3& world) {
  const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(world, 1);
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  EXPECT_TRUE(clip.w > 0 && std::abs(ndc.z) <= 1) << "between the near and far planes";
  return {(ndc.x + 1) / 2 * camera.width, (1 - ndc.y) / 2 * camera.height};
}

// --- the pinhole camera

TEST(Pinhole, without_distortion_it_shows_the_same_pixels) {
  const auto camera = photo::camera_for(calibration(800, 600, 700), 800, 600).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  EXPECT_NEAR(pinhole.width, 800, 5);  // the pixels of the photograph are not square
  EXPECT_NEAR(pinhole.height, 600, 5);
  for (const glm::dvec2 pixel : {glm::dvec2(0, 0), glm::dvec2(800, 600), glm::dvec2(123, 456)}) {
    const auto ray = photo::ray_through(camera, {}, pixel).value();
    const glm::dvec2 shown = pixel_of(pinhole, glm::dvec2(ray.direction) / ray.direction.z);
    EXPECT_NEAR(shown.x / pinhole.width, pixel.x / 800, 1e-9);
    EXPECT_NEAR(shown.y / pinhole.height, pixel.y / 600, 1e-9);
  }
}

TEST(Pinhole, it_contains_the_whole_photograph_and_has_a_limit) {
  const auto camera = photo::camera_for(calibration(9000, 6000, 6000, kBarrel), 9000, 6000).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  EXPECT_EQ(std::max(pinhole.width, pinhole.height), kMaxUndistortedSide);
  for (int i = 0; i <= 97; ++i) {
    const auto ray = photo::ray_through(camera, {}, {9000 * i / 97.0, 0}).value();
    const glm::dvec2 pixel = pixel_of(pinhole, glm::dvec2(ray.direction) / ray.direction.z);
    EXPECT_GE(pixel.x, -1);
    EXPECT_GE(pixel.y, -1);
    EXPECT_LE(pixel.x, pinhole.width + 1);
  }
  const photo::Lens fisheye{photo::LensModel::fisheye, {}, {}};
  const auto wide = photo::camera_for(calibration(3000, 3000, 900, fisheye), 3000, 3000).value();
  const Pinhole cut = pinhole_of(wide).value();
  EXPECT_NEAR(cut.left, -kMaxPinholeTangent, 1e-3);
  EXPECT_NEAR(cut.bottom, kMaxPinholeTangent, 1e-3);
}

TEST(Pinhole, the_view_shows_points_at_the_pixels_of_the_picture) {
  const auto camera = photo::camera_for(calibration(800, 600, 500, kBarrel), 800, 600).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  const glm::dvec3 low(1000, 2000, 30), high(1004, 2003, 32);
  for (const glm::dvec3& center : {glm::dvec3(1010, 2010, 35), glm::dvec3(1001, 2001, 31)}) {
    const photo::Pose pose = looking(center, {1002, 2002, 31.2});
    const Camera view = view_of(pinhole, pose, low, high);
    ASSERT_TRUE(validate(view));
    const glm::dvec3 point(1002.3, 2001.9, 31.4);
    const glm::dvec3 local = pose.camera_from_world * (point - center);
    const glm::dvec2 expected = pixel_of(pinhole, glm::dvec2(local) / local.z);
    const glm::dvec2 shown = window_pixel(view, point);
    EXPECT_NEAR(shown.x, expected.x, 1e-6);
    EXPECT_NEAR(shown.y, expected.y, 1e-6);
  }
  const photo::Pose away = looking({1010, 2010, 35}, {1020, 2020, 40});
  EXPECT_TRUE(validate(view_of(pinhole, away, low, high))) << "it sees nothing of the model";
}

// --- pictures without distortion

// The pattern in the plane z = 1: squares with a side of `kSquare`.
constexpr double kSquare = 0.13;
bool is_white(const glm::dvec2& direction) {
  const auto cell = glm::floor(direction / kSquare);
  return std::fmod(std::abs(cell.x + cell.y), 2.0) < 0.5;
}

// The photograph of the pattern, with 4 × 4 samples per pixel.
Picture photograph_of_pattern(const photo::Camera& camera) {
  Picture picture{camera.width, camera.height, {}};
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      int white = 0;
      for (int sample = 0; sample < 16; ++sample) {
        const glm::dvec2 pixel(x + (sample % 4 + 0.5) / 4, y + (sample / 4 + 0.5) / 4);
        const auto ray = photo::ray_through(camera, {}, pixel).value();
        white += is_white(glm::dvec2(ray.direction) / ray.direction.z) ? 1 : 0;
      }
      const auto gray = static_cast<std::uint8_t>(white * 255 / 16);
      picture.rgba.insert(picture.rgba.end(), {gray, gray, gray, 255});
    }
  return picture;
}

int gray_at(const Picture& picture, int x, int y) {
  return picture.rgba[4 * static_cast<std::size_t>(y * picture.width + x)];
}

// Returns the largest distance between a border of the pattern in a row of the picture, and the
// place where the pinhole must see it. `borders` counts them.
double largest_error(const Picture& picture, const photo::Camera& camera, const Pinhole& pinhole,
                     int& borders) {
  double largest = 0;
  const double scale = static_cast<double>(pinhole.width) / picture.width;
  for (int y = 5; y < picture.height - 5; y += 3) {
    const double row = direction_of(pinhole, {0, (y + 0.5) * scale}).y / kSquare;
    if (std::abs(row - std::round(row)) < 0.15) continue;  // along a border
    for (int x = 5; x + 5 < picture.width; ++x) {
      const int left = gray_at(picture, x, y), right = gray_at(picture, x + 1, y);
      if ((left < 128) == (right < 128) || std::abs(left - right) < 60) continue;
      bool is_shown = true;  // the border of the photograph is not part of the pattern
      for (const int beside : {-1, 2}) {
        const glm::dvec2 direction =
            direction_of(pinhole, (glm::dvec2(x + beside, y) + 0.5) * scale);
        const auto pixel = photo::project(camera, {}, glm::dvec3(direction, 1));
        is_shown = is_shown && pixel && photo::is_inside(camera, *pixel);
      }
      if (!is_shown) continue;
      const double crossing = x + 0.5 + (127.5 - left) / (right - left);
      const double found = direction_of(pinhole, {crossing * scale, 0}).x / kSquare;
      const double pixels_per_square = kSquare / (pinhole.right - pinhole.left) * picture.width;
      largest = std::max(largest, std::abs(found - std::round(found)) * pixels_per_square);
      ++borders;
    }
  }
  return largest;
}

TEST(Undistort, the_pattern_is_where_the_pinhole_sees_it) {
  const auto camera = photo::camera_for(calibration(300, 200, 210, kBarrel), 300, 200).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  const Picture original = photograph_of_pattern(camera);
  for (const int width : {pinhole.width, 130}) {
    const int side = side_for(camera, pinhole, width);
    const Picture picture = undistorted(halved_to(original, side), camera, pinhole, width);
    EXPECT_EQ(picture.width, width);
    int borders = 0;
    EXPECT_LT(largest_error(picture, camera, pinhole, borders), 0.5) << width;
    EXPECT_GT(borders, 50) << width;
  }
  int borders = 0;
  EXPECT_GT(largest_error(original, camera, pinhole, borders), 2) << "the original is distorted";
}

TEST(Undistort, pixels_outside_the_photograph_are_black) {
  const auto camera = photo::camera_for(calibration(600, 400, 300, kBarrel), 600, 400).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  const Picture white{600, 400, std::vector<std::uint8_t>(600 * 400 * 4, 255)};
  const Picture picture = undistorted(white, camera, pinhole, pinhole.width);
  EXPECT_EQ(gray_at(picture, picture.width / 2, 0), 0) << "the border of the photograph is bent";
  EXPECT_EQ(gray_at(picture, picture.width / 2, picture.height / 2), 255);
  EXPECT_EQ(picture.rgba[3], 255);
}

TEST(Undistort, a_small_picture_needs_a_small_original) {
  const auto camera = photo::camera_for(calibration(6000, 4000, 5000), 6000, 4000).value();
  const Pinhole pinhole = pinhole_of(camera).value();
  EXPECT_NEAR(side_for(camera, pinhole, 600), 600, 10);
  EXPECT_EQ(halved_to({64, 30, std::vector<std::uint8_t>(64 * 30 * 4)}, 16).width, 16);
  EXPECT_EQ(halved_to({64, 30, std::vector<std::uint8_t>(64 * 30 * 4)}, 17).width, 32);
}

// --- photographs that see a place

struct Scene {
  std::shared_ptr<mesh::Geometry> geometry = std::make_shared<mesh::Geometry>(
      test::geometry_of(test::transformed(test::cubes(6), 2, {5000, 4000, 100})));
  mesh::SearchTree tree{geometry};
  glm::dvec3 low{geometry->origin + glm::dvec3(geometry->box_min)};
  glm::dvec3 high{geometry->origin + glm::dvec3(geometry->box_max)};
  double diagonal = glm::distance(low, high);

  std::array<glm::dvec3, 3> corners(std::size_t triangle) const {
    const auto at = [&](std::size_t k) {
      return geometry->origin +
             glm::dvec3(geometry->vertices[geometry->indices[3 * triangle + k]].position);
    };
    return {at(0), at(1), at(2)};
  }
  // The distance to the first triangle by the method of Möller and Trumbore, or infinity.
  double first_triangle(const glm::dvec3& from, const glm::dvec3& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < geometry->triangle_count(); ++i) {
      const auto [a, b, c] = corners(i);
      const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(direction, e2), s = from - a,
                       q = glm::cross(s, e1);
      const double det = glm::dot(e1, p), u = glm::dot(s, p) / det,
                   v = glm::dot(direction, q) / det;
      const double along = glm::dot(e2, q) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && along >= 0) nearest = std::min(nearest, along);
    }
    return nearest;
  }
};

TEST(PhotographsSeeing, a_search_through_all_triangles_gives_the_same) {
  const Scene scene;
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto camera = photo::camera_for(calibration(600, 400, 900), 600, 400).value();
  const glm::dvec3 middle = (scene.low + scene.high) / 2.0;
  std::map<std::string, int> reasons;
  for (int i = 0; i < 30'000; ++i) {
    const auto triangle =
        std::uniform_int_distribution<std::size_t>(0, scene.geometry->triangle_count() - 1)(random);
    const auto [a, b, c] = scene.corners(triangle);
    const double u = between(0.05, 0.9), v = between(0.05, 0.95 - u);
    const SeenPlace place{a + u * (b - a) + v * (c - a), glm::normalize(glm::cross(b - a, c - a))};
    const glm::dvec3 around =
        glm::normalize(glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1)));
    const glm::dvec3 aim = middle + glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1)) *
                                        (scene.diagonal * 0.4);
    const photo::Pose pose = looking(middle + around * scene.diagonal * between(0.05, 1.5), aim);

    const glm::dvec3 local = pose.camera_from_world * (place.position - pose.center);
    const double distance = glm::length(local);
    const glm::dvec3 toward = (place.position - pose.center) / distance;
    const double cos_angle = -glm::dot(toward, place.normal);
    const double first = scene.first_triangle(pose.center, toward);
    const double before = (distance - first) / scene.diagonal;
    if (std::abs(cos_angle) < 1e-3 || (before > 1e-6 && before < 1e-3)) continue;  // borderline
    // 900 and 909 are the focal lengths, (307, 196) is the principal point.
    const glm::dvec2 pixel(900 * local.x / local.z + 307, 909 * local.y / local.z + 196);
    const std::string reason = local.z <= 0    ? "behind"
                               : cos_angle < 0 ? "faces away"
                               : pixel.x < 0 || pixel.x >= 600 || pixel.y < 0 || pixel.y >= 400
                                   ? "outside"
                               : before > 0.5e-3 ? "hidden"
                                                 : "seen";
    ++reasons[reason];
    const auto seen =
        PlaceView(scene.tree, scene.geometry->origin, scene.diagonal, place).in(camera, pose);
    ASSERT_EQ(seen.has_value(), reason == "seen") << reason << " " << i;
    if (!seen) continue;
    EXPECT_NEAR(seen->pixel.x, pixel.x, 1e-6);
    EXPECT_NEAR(seen->pixel.y, pixel.y, 1e-6);
    EXPECT_NEAR(seen->cos_angle, cos_angle, 1e-9);
    EXPECT_NEAR(seen->distance, distance, 1e-9 * distance);
    // Away from the axis, a radian across the direction of view has more pixels: divided by the
    // cosine of the angle from the axis in one direction, and by its square in the other one.
    const double from_axis = local.z / distance;
    EXPECT_NEAR(seen->units_per_pixel,
                local.z / std::sqrt(900.0 * 909.0) * std::pow(from_axis, 0.5),
                1e-4 * seen->units_per_pixel);
  }
  for (const char* reason : {"behind", "faces away", "outside", "hidden", "seen"})
    EXPECT_GT(reasons[reason], 30) << reason;
}

store::Photograph stored(std::int64_t id, const photo::Pose& pose, photo::Calibration calibrated) {
  store::Photograph photograph;
  photograph.id = store::PhotographId(id);
  photograph.posed = {"IMG_" + std::to_string(id), calibrated, pose};
  return photograph;
}

TEST(PhotographsSeeing, the_best_ones_come_first) {
  const auto geometry = std::make_shared<mesh::Geometry>(test::geometry_of(test::open_grid(4, 0)));
  const mesh::SearchTree tree(geometry);
  const glm::dvec3 middle =
      geometry->origin + glm::dvec3(geometry->box_min + geometry->box_max) / 2.0;
  const auto hit = tree.nearest(glm::vec3(middle - geometry->origin), 1).value();
  const glm::dvec3 normal(hit.normal), side(1, 0, 0);
  const PlaceView place(tree, geometry->origin, 1.5, {middle, normal});
  const auto usual = calibration(600, 400, 600);
  auto sizeless = usual;
  sizeless.width = sizeless.height = 0;
  const auto at = [&](const glm::dvec3& offset) { return looking(middle + offset, middle); };
  const std::vector<store::Photograph> photographs{
      stored(1, at(normal * 4.0), usual),                 // far
      stored(2, at(normal * 2.0), usual),                 // near
      stored(3, at((normal + side * 1.8) * 1.0), usual),  // as near, but slanted
      stored(4, at(normal * -2.0), usual),                // behind the surface
      stored(5, at(normal * 2.0), sizeless),              // of unknown size
      stored(6, at(normal * 2.0), usual),                 // like 2
  };
  const auto found = photographs_seeing(place, photographs, 3);
  EXPECT_EQ(found.total, 4u);
  EXPECT_EQ(found.unknown_size, 1u);
  ASSERT_EQ(found.best.size(), 3u);
  EXPECT_EQ(found.best[0].photograph.id, store::PhotographId(2));
  EXPECT_EQ(found.best[1].photograph.id, store::PhotographId(6));
  EXPECT_EQ(found.best[2].photograph.id, store::PhotographId(1));
}

}  // namespace
}  // namespace strata::app
