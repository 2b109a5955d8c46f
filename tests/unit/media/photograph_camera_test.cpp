#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "media/photographs/camera.h"

namespace strata::photo {
namespace {

using testing::HasSubstr;

Lens lens(LensModel model, std::array<double, 6> radial, std::array<double, 4> tangential = {}) {
  return {model, radial, tangential};
}

glm::dvec2 bent(const Lens& with, double x, double y) { return distort(with, {x, y}).point; }

void expect_near(const glm::dvec2& found, const glm::dvec2& expected, double tolerance) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
}

// A lens of each model, with coefficients like those of real lenses.
std::vector<Lens> real_lenses() {
  return {
      lens(LensModel::pinhole, {}),
      lens(LensModel::brown, {-0.0919367147, -0.0762807468, 0.1162639394, -0.0761413904},
           {-0.0003134847, 0.0001164035, 0, 0}),
      lens(LensModel::brown, {0.12, -0.03}),
      lens(LensModel::brown, {-0.2, 0.05}, {0.01, -0.008, 0.4, -0.2}),
      lens(LensModel::rational, {0.4, -0.1, 0.02, 0.6, 0.05, -0.01}, {0.001, -0.0007}),
      lens(LensModel::fisheye, {-0.03, 0.004, -0.002, 0.0003}),
      lens(LensModel::division, {0.2369}),
      lens(LensModel::division, {-0.15}),
  };
}

Calibration calibration(const Lens& with) {
  Calibration out;
  out.width = 5280;
  out.height = 3956;
  out.focal = {3706.0, 3705.4728792737214};
  out.offset = {11.67, -27.75};
  out.skew = -0.3058334293;
  out.lens = with;
  return out;
}

TEST(Lens, distortions_are_those_calculated_by_hand) {
  expect_near(bent(lens(LensModel::pinhole, {}), 0.3, -0.4), {0.3, -0.4}, 0);
  // r² = 0.25: 1 - 0.1 · 0.25 + 0.2 · 0.0625 = 0.9875
  expect_near(bent(lens(LensModel::brown, {-0.1, 0.2}), 0.3, 0.4), {0.29625, 0.395}, 1e-15);
  // (0.01 (0.25 + 0.18) + 2 · 0.02 · 0.12) (1 + 0.25 · 2) and (0.02 (0.25 + 0.32) + 2 · 0.01 ·
  // 0.12) (1 + 0.25 · 2)
  expect_near(bent(lens(LensModel::brown, {}, {0.01, 0.02, 2, 0}), 0.3, 0.4),
              {0.3 + 0.0091 * 1.5, 0.4 + 0.0138 * 1.5}, 1e-15);
  // (1 + 0.4 · 0.25) / (1 + 0.8 · 0.25)
  expect_near(bent(lens(LensModel::rational, {0.4, 0, 0, 0.8}), 0.3, 0.4),
              glm::dvec2(0.3, 0.4) * (1.1 / 1.2), 1e-15);
  const double eighth = std::numbers::pi / 4;
  expect_near(bent(lens(LensModel::fisheye, {}), 1, 0), {eighth, 0}, 1e-15);
  expect_near(bent(lens(LensModel::fisheye, {0.1}), 0, 1),
              {0, eighth + 0.1 * eighth * eighth * eighth}, 1e-15);
  expect_near(bent(lens(LensModel::division, {0.35}), 1, 0), {1 / 1.35, 0}, 1e-15);
}

TEST(Lens, the_distortion_of_metashape_is_that_of_a_published_calculation) {
  // https://www.agisoft.com/forum/index.php?topic=14708.0, after the appendix of the manual
  const Lens published =
      lens(LensModel::brown, {0.052014, 0.689641, -3.7671}, {-0.00148237, -0.0018401, 0, 0});
  expect_near(bent(published, 0.5, 0.5), {0.36136245, 0.36118359}, 1e-8);
  const Lens radial = lens(LensModel::brown, {0.052014, 0.689641, -3.7671});
  expect_near(bent(radial, 0.5, 0.5), {0.363764875, 0.363764875}, 1e-9);
}

TEST(Lens, the_jacobian_is_the_quotient_of_small_differences) {
  constexpr double kStep = 1e-6;
  for (const Lens& each : real_lenses())
    for (const glm::dvec2 at :
         {glm::dvec2(0), glm::dvec2(3e-5, -2e-5), glm::dvec2(0.3, -0.2), glm::dvec2(-0.45, -0.4)}) {
      const glm::dmat2 jacobian = distort(each, at).jacobian;
      for (int axis = 0; axis < 2; ++axis) {
        glm::dvec2 step(0);
        step[axis] = kStep;
        const glm::dvec2 quotient =
            (distort(each, at + step).point - distort(each, at - step).point) / (2 * kStep);
        expect_near(jacobian[axis], quotient, 1e-9);
      }
    }
}

TEST(Lens, the_valid_radius_ends_where_a_larger_radius_bends_back) {
  // 1 - 3 · 0.3 r² = 0
  EXPECT_NEAR(valid_radius(lens(LensModel::brown, {-0.3})), std::sqrt(1 / 0.9), 1e-8);
  EXPECT_NEAR(valid_radius(lens(LensModel::division, {0.25})), 2, 1e-8);
  EXPECT_NEAR(valid_radius(lens(LensModel::division, {-0.25})), 2, 1e-8);  // a pole
  EXPECT_NEAR(valid_radius(lens(LensModel::rational, {0, 0, 0, 1})), 1, 1e-8);
  EXPECT_NEAR(valid_radius(lens(LensModel::rational, {0, 0, 0, -0.01})), 10, 1e-7);  // a pole
  // 1 - 3 · 0.5 θ² = 0
  EXPECT_NEAR(valid_radius(lens(LensModel::fisheye, {-0.5})), std::tan(std::sqrt(1 / 1.5)), 1e-8);
  for (const LensModel model : {LensModel::pinhole, LensModel::brown, LensModel::fisheye})
    EXPECT_NEAR(valid_radius(lens(model, {})), kMaxRadius, 1e-6);
  // A wave: the first of three turns counts. 1 - 6 s + 11 s² - 6 s³ is 0 at s = 1/3, 1/2 and 1.
  const Lens wave = lens(LensModel::brown, {-6 / 3.0, 11 / 5.0, -6 / 7.0});
  EXPECT_NEAR(valid_radius(wave), std::sqrt(1 / 3.0), 1e-8);
  for (const Lens& each : real_lenses()) {
    double last = 0;
    const double end = std::min(valid_radius(each), 20.0);
    Lens radial = each;
    radial.tangential = {};
    for (int i = 1; i <= 1000; ++i) {
      const double r = bent(radial, end * i / 1000, 0).x;
      EXPECT_GT(r, last) << name(each.model) << " at " << end * i / 1000;
      last = r;
    }
  }
}

TEST(Lens, names_are_read_back) {
  for (const auto each : {LensModel::pinhole, LensModel::brown, LensModel::rational,
                          LensModel::fisheye, LensModel::division})
    EXPECT_EQ(lens_model_named(name(each)), each);
  EXPECT_FALSE(lens_model_named("mirror"));
}

TEST(PhotographCamera, a_pixel_and_its_ray_belong_together) {
  Pose pose;
  pose.camera_from_world = {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}};  // looks along x, with z up
  pose.center = {12, -7, 3};
  for (const Lens& each : real_lenses()) {
    const auto camera = camera_for(calibration(each), 5280, 3956);
    ASSERT_TRUE(camera) << camera.error().detail;
    int rays = 0;
    for (int x = 0; x <= 20; ++x)
      for (int y = 0; y <= 20; ++y) {
        const glm::dvec2 pixel(camera->width * x / 20.0, camera->height * y / 20.0);
        const auto ray = ray_through(*camera, pose, pixel);
        if (!ray) continue;
        ++rays;
        EXPECT_NEAR(glm::length(ray->direction), 1, 1e-15);
        EXPECT_EQ(ray->origin, pose.center);
        const auto back = project(*camera, pose, ray->origin + 5.0 * ray->direction);
        ASSERT_TRUE(back);
        EXPECT_LE(glm::length(*back - pixel), kMaxRayError) << name(each.model);
      }
    EXPECT_EQ(rays, 21 * 21) << name(each.model) << ' ' << each.radial[0];
  }
}

TEST(PhotographCamera, a_point_and_the_ray_of_its_pixel_belong_together) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-0.7, 0.7), far(1, 90);
  Pose pose;
  pose.center = {3'500'000.25, 5'900'000.5, 120};  // coordinates of a map
  for (const Lens& each : real_lenses()) {
    const Camera camera = *camera_for(calibration(each), 5280, 3956);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 local = glm::dvec3(side(random), side(random), 1) * far(random);
      const auto pixel = project(camera, pose, pose.center + local);
      if (!pixel) {
        EXPECT_GT(glm::length(glm::dvec2(local) / local.z), 0.7) << name(each.model);
        continue;
      }
      const auto ray = ray_through(camera, pose, *pixel);
      ASSERT_TRUE(ray) << name(each.model);
      EXPECT_LT(glm::length(glm::cross(ray->direction, glm::normalize(local))), 1e-8);
    }
  }
}

TEST(PhotographCamera, points_that_the_lens_does_not_show_have_no_pixel) {
  const Camera camera = *camera_for(calibration(lens(LensModel::brown, {-0.3})), 5280, 3956);
  const Pose pose;
  EXPECT_TRUE(project(camera, pose, {0, 0, 1}));
  EXPECT_FALSE(project(camera, pose, {0, 0, -1}));
  EXPECT_FALSE(project(camera, pose, {0, 0, 0}));
  EXPECT_FALSE(project(camera, pose, {1, 0, 0}));
  EXPECT_TRUE(project(camera, pose, {1.05, 0, 1}));
  // r = 1.5 would have the pixel of r = 0.4875, because the polynomial bends back.
  EXPECT_FALSE(project(camera, pose, {1.5, 0, 1}));
  EXPECT_FALSE(project(camera, pose, {std::numeric_limits<double>::quiet_NaN(), 0, 1}));
  // The largest distorted radius is 2/3 of the valid radius.
  const double edge = 3706 * std::sqrt(1 / 0.9) * 2 / 3;
  EXPECT_TRUE(ray_through(camera, pose, camera.principal_point + glm::dvec2(edge - 1e-3, 0)));
  EXPECT_FALSE(ray_through(camera, pose, camera.principal_point + glm::dvec2(edge + 1, 0)));
  EXPECT_FALSE(ray_through(camera, pose, glm::dvec2(std::numeric_limits<double>::infinity(), 0)));
}

TEST(PhotographCamera, the_center_of_a_photograph_is_half_its_size) {
  Calibration centered = calibration({});
  centered.offset = {0, 0};
  centered.skew = 0;
  const Camera camera = *camera_for(centered, 5280, 3956);
  expect_near(*project(camera, {}, {0, 0, 7}), {2640, 1978}, 1e-12);
  EXPECT_GT(project(camera, {}, {0, 1, 7})->y, 1978);  // y points down
  EXPECT_TRUE(is_inside(camera, {0, 0}));
  EXPECT_FALSE(is_inside(camera, {5280, 0}));
  EXPECT_FALSE(is_inside(camera, {5, -0.001}));
}

TEST(PhotographCamera, a_smaller_copy_shows_the_same) {
  const Calibration whole = calibration(real_lenses()[1]);
  const Camera large = *camera_for(whole, 5280, 3956), small = *camera_for(whole, 1320, 989);
  const glm::dvec3 point(1, -0.5, 3);
  expect_near(*project(small, {}, point), *project(large, {}, point) / 4.0, 1e-9);
  const auto rounded = camera_for(whole, 1000, 749);  // 749.24
  ASSERT_TRUE(rounded);
  for (const auto& [width, height] : {std::pair(3956, 5280), std::pair(5280, 3000)}) {
    const auto turned = camera_for(whole, width, height);
    ASSERT_FALSE(turned);
    EXPECT_EQ(turned.error().code, ErrorCode::invalid);
    EXPECT_THAT(turned.error().detail, HasSubstr("neither cropped nor turned"));
  }
}

TEST(PhotographCamera, lengths_in_sides_become_pixels_of_the_longest_side) {
  Calibration sides;
  sides.unit = CalibrationUnit::longest_side;
  sides.focal = glm::dvec2(0.5);
  sides.offset = {0.01, -0.02};
  for (const auto& [width, height] : {std::pair(4000, 3000), std::pair(3000, 4000)}) {
    const Camera camera = *camera_for(sides, width, height);
    expect_near(camera.focal, {2000, 2000}, 1e-9);
    expect_near(camera.principal_point, {width / 2.0 + 40, height / 2.0 - 80}, 1e-9);
  }
}

TEST(PhotographCamera, impossible_calibrations_are_refused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Calibration> wrong(7, calibration({}));
  wrong[0].focal.x = 0;
  wrong[1].focal.y = nan;
  wrong[2].offset.x = nan;
  wrong[3].skew = 1e300;
  wrong[4].lens.radial[2] = nan;
  wrong[5].width = -1;
  wrong[6].height = kMaxPhotographSide + 1;
  for (const Calibration& each : wrong) {
    const auto good = check(each);
    ASSERT_FALSE(good);
    EXPECT_EQ(good.error().code, ErrorCode::invalid);
    EXPECT_FALSE(camera_for(each, 100, 100));
  }
  EXPECT_TRUE(check(calibration({})));
  EXPECT_FALSE(camera_for(calibration({}), 0, 10));
}

}  // namespace
}  // namespace strata::photo
