// Rollouts of shapes with formulas, with atlases that are cut in other places than the rollout.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>
#include <random>

#include "mesh/analysis/tangent_frame.h"
#include "mesh/rollout/trace_rollout.h"
#include "support/cut_shapes.h"

namespace strata::mesh {
namespace {

using test::Cuts;
using test::Shape;
using test::Surface;
constexpr double kPi = std::numbers::pi;
constexpr int kResolution = 512;
constexpr Cuts kCuts[] = {{1, 1, 0.4, 1}, {3, 4, 0.7, 0.75}, {7, 5, 1.1, 0.6}};
const glm::dvec3 kAxis = glm::normalize(glm::dvec3(0.3, -0.2, 1));
const glm::dvec3 kCenter(120, -40, 15);

// A place around the tilted axis, with a radius of `radius`.
glm::dvec3 around(double angle, double radius, double along) {
  const TangentFrame frame(kAxis);
  return kCenter + radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) + along * kAxis;
}

// A part of a cone with the slope tan(half angle), or of a cylinder with the slope 0. It covers
// `share` of the turn. `inward` turns its faces to the axis.
Shape wall(double radius, double slope, double height, double share = 1, bool inward = false) {
  Shape shape;
  shape.columns = 512;
  shape.rows = 64;
  shape.position = [=](double s, double t) {
    const double along = (t - 0.5) * height;
    return around((inward ? -s : s) * share * 2 * kPi, radius + slope * along, along);
  };
  shape.flat = [=](double s, double t) {
    return glm::dvec2(s * share * 2 * kPi * radius, t * height * std::hypot(1.0, slope));
  };
  return shape;
}

struct Rollout {
  DevelopedFit fit;
  RolloutSheet sheet;
};
Rollout roll_out(const Geometry& geometry, const FitRequest& request = {},
                 const std::optional<double>& cut = {}) {
  const auto fit = fit_developed_surface(geometry, request);
  EXPECT_TRUE(fit) << fit.error().detail;
  if (!fit) return {};
  const auto sheet = plan_rollout(geometry, *fit, cut);
  EXPECT_TRUE(sheet) << sheet.error().detail;
  return sheet ? Rollout{*fit, *sheet} : Rollout{*fit, {}};
}

struct Pixel {
  int column = 0, row = 0;
  RolloutHit hit;
};
std::vector<Pixel> pixels_of(const Geometry& geometry, const RolloutSheet& sheet,
                             const RolloutWindow& window) {
  const SearchTree tree(std::make_shared<Geometry>(geometry));
  std::vector<Pixel> all;
  std::mutex mutex;
  Progress progress;
  const auto traced = trace_rollout(
      tree, geometry, sheet, window,
      [&](int row, std::span<const std::optional<RolloutHit>> pixels) {
        const std::lock_guard lock(mutex);
        for (int column = 0; column < window.width; ++column)
          if (pixels[column]) all.push_back({column, row, *pixels[column]});
      },
      progress);
  EXPECT_TRUE(traced);
  return all;
}

// Returns the area of the texels where `is_painted`, as in the statistics of a layer.
double painted_area(const Surface& surface, const std::function<bool(glm::dvec3)>& is_painted) {
  double area = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 place =
        surface.geometry.origin +
        glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
    if (is_painted(place)) area += surface.map.area[texel];
  });
  return area;
}

double area_on_sheet(const Surface& surface, const RolloutSheet& sheet, double units_per_pixel,
                     const std::function<bool(glm::dvec3)>& is_painted) {
  double pixels = 0;
  for (const Pixel& pixel : pixels_of(surface.geometry, sheet, window_of(sheet, units_per_pixel)))
    pixels += is_painted(surface.geometry.origin + glm::dvec3(pixel.hit.hit.position)) ? 1 : 0;
  return pixels * units_per_pixel * units_per_pixel;
}

TEST(Rollout, the_axis_and_radius_of_a_cylinder_are_found) {
  for (const Cuts& cuts : kCuts) {
    const Surface surface = test::cut_surface(wall(20, 0, 60), cuts, 256);
    const auto [fit, sheet] = roll_out(surface.geometry);
    EXPECT_GT(glm::dot(fit.surface.axis, kAxis), 1 - 1e-9);
    EXPECT_FALSE(fit.surface.is_cone());
    EXPECT_EQ(fit.side, RolloutSide::outside);
    EXPECT_NEAR(fit.surface.radius, 20, 20 * 1e-4);
    EXPECT_LT(glm::length(glm::cross(fit.surface.point - kCenter, kAxis)), 1e-4);
    EXPECT_LT(fit.deviation, 1e-3);
    // The lengths of the sheet are those of the cylinder.
    EXPECT_NEAR(sheet.max.x - sheet.min.x, 2 * kPi * 20, 2 * kPi * 20 * 1e-3);
    EXPECT_NEAR(sheet.max.y - sheet.min.y, 60, 60 * 1e-3);
  }
}

TEST(Rollout, lengths_on_the_sheet_are_those_along_a_cylinder) {
  const Surface surface = test::cut_surface(wall(20, 0, 60), kCuts[1], 256);
  const RolloutSheet sheet = roll_out(surface.geometry).sheet;
  const auto on_sheet = [&](double angle, double along) {
    auto place = sheet.surface.place_of(around(angle, 20, along));
    while (place.angle < sheet.from) place.angle += 2 * kPi;
    while (place.angle > sheet.to) place.angle -= 2 * kPi;
    return sheet.on_sheet({place.angle, place.slant});
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double angle = 2 * kPi * any(random), turn = any(random) - 0.5;
    const double from = 60 * (any(random) - 0.5), to = 60 * (any(random) - 0.5);
    const glm::dvec2 a = on_sheet(angle, from), b = on_sheet(angle + turn, to);
    if (std::abs(a.x - b.x) > 20) continue;  // the cut is between the points
    const double length = std::hypot(20 * turn, to - from);
    EXPECT_NEAR(glm::distance(a, b), length, 1e-3 * length + 1e-6);
  }
}

TEST(Rollout, lengths_on_the_sheet_are_those_along_a_cone) {
  for (const double slope : {-0.5, 0.5}) {
    const Surface surface = test::cut_surface(wall(30, slope, 40), kCuts[1], 256);
    const auto [fit, sheet] = roll_out(surface.geometry);
    ASSERT_TRUE(fit.surface.is_cone());
    EXPECT_NEAR(fit.surface.half_angle, std::atan(slope), 1e-4);
    const double middle = sheet.middle();
    for (const double turn : {0.3, 1.0, 2.0})
      for (const double along : {-20.0, 5.0, 20.0}) {
        // The shortest way between the points, by the law of cosines in the plane of the cone.
        const auto place = [&](double angle, double height) {
          return DevelopedSurface::Place{angle, height * std::hypot(1.0, slope), 0};
        };
        const auto from = place(middle - turn / 2, -20), to = place(middle + turn / 2, along);
        const double sine = std::abs(slope) / std::hypot(1.0, slope);
        const double a = (30 + slope * -20) / sine, b = (30 + slope * along) / sine;
        const double length = std::sqrt(a * a + b * b - 2 * a * b * std::cos(turn * sine));
        const double on_sheet = glm::distance(sheet.on_sheet({from.angle, from.slant}),
                                              sheet.on_sheet({to.angle, to.slant}));
        EXPECT_NEAR(on_sheet, length, 1e-3 * length) << slope << " " << turn << " " << along;
      }
  }
}

TEST(Rollout, areas_on_the_sheet_are_those_of_the_statistics) {
  const auto is_painted = [](const glm::dvec3& place) {
    return glm::distance(place, around(2.8, 25, 4)) < 14 ||
           glm::distance(place, around(0.3, 25, -6)) < 9;
  };
  for (const double slope : {0.0, 0.4, -0.7})
    for (const Cuts& cuts : kCuts) {
      const Surface surface = test::cut_surface(wall(25, slope, 40), cuts, kResolution);
      const RolloutSheet sheet = roll_out(surface.geometry).sheet;
      const double expected = painted_area(surface, is_painted);
      ASSERT_GT(expected, 500);
      EXPECT_NEAR(area_on_sheet(surface, sheet, 0.2, is_painted), expected, 0.01 * expected)
          << slope << " " << cuts.columns;
      const auto all = [](const glm::dvec3&) { return true; };
      const double total = painted_area(surface, all);
      EXPECT_NEAR(area_on_sheet(surface, sheet, 0.2, all), total, 0.01 * total);
    }
}

TEST(Rollout, a_pixel_shows_the_point_at_its_place_in_the_atlas) {
  const Surface surface = test::cut_surface(wall(25, 0.4, 40), kCuts[2], 256);
  const Geometry& geometry = surface.geometry;
  const RolloutSheet sheet = roll_out(geometry).sheet;
  const RolloutWindow window = window_of(sheet, 1);
  const auto pixels = pixels_of(geometry, sheet, window);
  ASSERT_GT(pixels.size(), 5000u);
  for (const Pixel& pixel : pixels) {
    const auto place = sheet.on_surface(window.center_of(pixel.column, pixel.row));
    ASSERT_TRUE(place);
    const SearchTree::Hit& hit = pixel.hit.hit;
    const glm::dvec3 position = geometry.origin + glm::dvec3(hit.position);
    EXPECT_LT(glm::distance(position, sheet.surface.at(place->angle, place->slant)), 0.01);
    glm::vec2 uv(0);
    for (int k = 0; k < 3; ++k)
      uv += hit.barycentric[k] * geometry.vertices[geometry.indices[3 * hit.triangle + k]].uv;
    EXPECT_LT(glm::distance(uv, hit.uv), 1e-5f);
  }
}

TEST(Rollout, right_on_the_sheet_is_right_for_the_viewer) {
  // The viewer of the outside is at the angle of the middle, with the axis upward.
  const Surface outer = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  const RolloutSheet outside = roll_out(outer.geometry).sheet;
  const Surface inner = test::cut_surface(wall(20, 0, 40, 1, true), kCuts[0], 256);
  const RolloutSheet inside = roll_out(inner.geometry).sheet;
  EXPECT_EQ(inside.side, RolloutSide::inside);
  for (const RolloutSheet* sheet : {&outside, &inside}) {
    const auto at = [&](double x) {
      const auto place = *sheet->on_surface({x, (sheet->min.y + sheet->max.y) / 2});
      return sheet->surface.at(place.angle, place.slant);
    };
    const glm::dvec3 to_surface =
        glm::normalize(at(0) - sheet->surface.point) * (sheet == &outside ? -1.0 : 1.0);
    const glm::dvec3 right = glm::cross(to_surface, sheet->surface.axis);
    EXPECT_GT(glm::dot(at(1) - at(0), right), 0.99);
    const auto middle = *sheet->on_surface({0, sheet->min.y});
    EXPECT_GT(glm::dot(sheet->in_world(middle, {1, 0}, 0), right), 0.99);
    EXPECT_LT(glm::dot(sheet->in_world(middle, {0, 0}, 1), to_surface), -0.99);
  }
}

TEST(Rollout, directions_on_the_sheet_are_differences_of_places) {
  for (const double slope : {-0.5, 0.0, 0.5}) {
    const Surface surface = test::cut_surface(wall(30, slope, 40), kCuts[0], 256);
    const RolloutSheet sheet = roll_out(surface.geometry).sheet;
    const auto at = [&](const glm::dvec2& on_sheet) {
      const auto place = *sheet.on_surface(on_sheet);
      return sheet.surface.at(place.angle, place.slant);
    };
    for (const double share : {0.2, 0.5, 0.9}) {
      const RolloutSheet::SurfacePlace place{sheet.from + share * (sheet.to - sheet.from), 0};
      const glm::dvec2 center = sheet.on_sheet(place);
      for (const glm::dvec2 step : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(0.6, -0.8)}) {
        const glm::dvec3 expected = (at(center + 1e-4 * step) - at(center - 1e-4 * step)) / 2e-4;
        EXPECT_LT(glm::distance(sheet.in_world(place, step, 0), expected), 1e-3);
      }
    }
  }
}

TEST(Rollout, a_barrel_vault_is_cut_in_its_gap) {
  const Surface surface = test::cut_surface(wall(300, 0, 900, 0.45, true), kCuts[1], 256);
  const auto [fit, sheet] = roll_out(surface.geometry);
  EXPECT_EQ(fit.side, RolloutSide::inside);
  EXPECT_NEAR(fit.surface.radius, 300, 0.3);
  EXPECT_NEAR(sheet.max.x - sheet.min.x, 0.45 * 2 * kPi * 300, 1);
  EXPECT_NEAR(sheet.max.y - sheet.min.y, 900, 1);
  // Almost all pixels show the vault.
  const RolloutWindow window = window_of(sheet, 5);
  const double share = static_cast<double>(pixels_of(surface.geometry, sheet, window).size()) /
                       (window.width * window.height);
  EXPECT_GT(share, 0.98);
}

TEST(Rollout, the_ends_of_a_wall_can_be_its_cut) {
  for (const double share : {0.3, 0.45, 0.8}) {
    const Surface surface = test::cut_surface(wall(30, 0, 40, share), kCuts[1], 256);
    const RolloutSheet sheet = roll_out(surface.geometry).sheet;
    for (const double cut : {sheet.from, sheet.to, sheet.middle() + kPi}) {
      const RolloutSheet again = roll_out(surface.geometry, {}, cut).sheet;
      EXPECT_NEAR(again.from, sheet.from, 1e-6) << share;
      EXPECT_NEAR(again.to, sheet.to, 1e-6) << share;
    }
  }
}

TEST(Rollout, the_caller_chooses_the_cut) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[1], 256);
  for (const double cut : {-3.0, 0.0, 1.5, 4.0}) {
    const RolloutSheet sheet = roll_out(surface.geometry, {}, cut).sheet;
    EXPECT_NEAR(std::remainder(sheet.from - cut, 2 * kPi), 0, 1e-9);
    EXPECT_NEAR(sheet.to - sheet.from, 2 * kPi, 1e-9);
  }
  const RolloutSheet sheet = roll_out(surface.geometry).sheet;
  EXPECT_NEAR(sheet.middle(), 0, 1e-9);
}

// A pot with a floor, a wall of thickness 3 and a belly.
TriangleMesh pot() {
  TriangleMesh mesh;
  constexpr int kAround = 96;
  std::vector<glm::dvec2> profile;  // radius and height, from the middle of the floor outside
  const auto belly = [](double h) { return 30 + 8 * std::sin(h / 80 * kPi); };
  profile.emplace_back(0.01, 0);
  for (int i = 0; i <= 40; ++i) profile.emplace_back(belly(2.0 * i), 2.0 * i);
  for (int i = 40; i >= 2; --i) profile.emplace_back(belly(2.0 * i) - 3, 2.0 * i);
  profile.emplace_back(0.01, 4);
  for (const glm::dvec2& point : profile)
    for (int j = 0; j < kAround; ++j)
      mesh.positions.push_back(around(2 * kPi * j / kAround, point.x, point.y));
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t next = (j + 1) % kAround, row = i * kAround, above = row + kAround;
      for (const std::uint32_t index :
           {row + j, row + next, above + next, row + j, above + next, above + j})
        mesh.triangles.push_back(index);
    }
  return mesh;
}

TEST(Rollout, both_sides_of_a_vessel_with_a_floor_can_be_unrolled) {
  Atlas atlas;
  const TriangleMesh mesh = pot();
  const Geometry geometry = build_geometry(mesh, atlas);
  FitRequest request;
  for (const RolloutSide side : {RolloutSide::outside, RolloutSide::inside}) {
    request.side = side;
    const auto [fit, sheet] = roll_out(geometry, request);
    EXPECT_GT(glm::dot(fit.surface.axis, kAxis), 1 - 1e-6);
    const double mean = side == RolloutSide::outside ? 35.1 : 32.2;
    EXPECT_NEAR(fit.surface.radius, mean, 1);
    const auto pixels = pixels_of(geometry, sheet, window_of(sheet, 1));
    ASSERT_GT(pixels.size(), 10000u);
    for (const Pixel& pixel : pixels) {
      const glm::dvec3 place = geometry.origin + glm::dvec3(pixel.hit.hit.position) - kCenter;
      const double along = glm::dot(place, kAxis);
      const double radius = glm::length(place - along * kAxis);
      const double outer = 30 + 8 * std::sin(along / 80 * kPi);
      EXPECT_NEAR(radius, side == RolloutSide::outside ? outer : outer - 3, 0.1) << along;
    }
  }
}

TEST(Rollout, a_handle_moves_the_axis_only_a_little) {
  TriangleMesh mesh = pot();
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  constexpr std::uint32_t kAlong = 24, kAround = 12;
  for (std::uint32_t i = 0; i <= kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const double along = kPi * i / kAlong, turn = 2 * kPi * j / kAround;
      const double out = 25 + 4 * std::cos(turn);
      mesh.positions.push_back(around(0.5 + 0.1 * std::sin(turn), 34 + out * std::sin(along),
                                      45 + out * std::cos(along)));
    }
  for (std::uint32_t i = 0; i < kAlong; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t next = (j + 1) % kAround, row = first + i * kAround;
      for (const std::uint32_t index : {row + j, row + next, row + kAround + next, row + j,
                                        row + kAround + next, row + kAround + j})
        mesh.triangles.push_back(index);
    }
  const DevelopedSurface found = roll_out(build_geometry(mesh, {})).fit.surface;
  EXPECT_LT(glm::degrees(std::acos(std::min(1.0, glm::dot(found.axis, kAxis)))), 1);
  EXPECT_LT(glm::length(glm::cross(found.point - kCenter, found.axis)), 1);
}

TEST(Rollout, the_automatic_side_has_the_larger_area) {
  EXPECT_EQ(roll_out(build_geometry(pot(), {})).fit.side, RolloutSide::outside);
}

TEST(Rollout, noise_moves_the_axis_only_a_little) {
  TriangleMesh mesh;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.2);
  constexpr std::uint32_t kAround = 200, kRows = 100;
  for (std::uint32_t i = 0; i <= kRows; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j)
      mesh.positions.push_back(around(2 * kPi * j / kAround, 40 + noise(random), 0.8 * i));
  for (std::uint32_t i = 0; i < kRows; ++i)
    for (std::uint32_t j = 0; j < kAround; ++j) {
      const std::uint32_t next = (j + 1) % kAround, row = i * kAround, above = row + kAround;
      for (const std::uint32_t index :
           {row + j, row + next, above + next, row + j, above + next, above + j})
        mesh.triangles.push_back(index);
    }
  const auto fit = fit_developed_surface(build_geometry(mesh, {}), {});
  ASSERT_TRUE(fit) << fit.error().detail;
  EXPECT_LT(glm::degrees(std::acos(std::min(1.0, glm::dot(fit->surface.axis, kAxis)))), 0.3);
  EXPECT_NEAR(fit->surface.radius, 40, 0.05);
}

TEST(Rollout, the_callers_axis_and_radius_are_used_exactly) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  FitRequest request;
  request.axis = {kCenter + 3.0 * kAxis, 2.0 * kAxis};
  request.radius = 22;
  request.half_angle = 0.1;
  const auto fit = fit_developed_surface(surface.geometry, request);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->surface.point, kCenter + 3.0 * kAxis);
  EXPECT_LT(glm::distance(fit->surface.axis, kAxis), 1e-12);
  EXPECT_EQ(fit->surface.radius, 22);
  EXPECT_NEAR(fit->surface.half_angle, 0.1, 1e-12);
}

TEST(Rollout, the_deviation_is_that_from_the_callers_surface) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  FitRequest request;
  request.axis = {kCenter, kAxis};
  const auto deviation = [&](double radius, double half_angle) {
    request.radius = radius;
    request.half_angle = half_angle;
    return fit_developed_surface(surface.geometry, request)->deviation;
  };
  EXPECT_LT(deviation(20, 0), 0.01);
  EXPECT_NEAR(deviation(26, 0), 6, 0.01);
  // The distances from a cone through the middle grow linearly with the height from −20 to 20.
  EXPECT_NEAR(deviation(20, 0.1), 20 * std::sin(0.1) / std::sqrt(3.0), 0.01);
}

// A sphere as a grid of latitudes and longitudes.
Shape sphere() {
  Shape shape;
  shape.columns = 96;
  shape.rows = 48;
  shape.position = [](double s, double t) {
    return around(2 * kPi * s, 20 * std::sin(kPi * t), -20 * std::cos(kPi * t));
  };
  shape.flat = [](double s, double t) { return glm::dvec2(s, t); };
  return shape;
}

Shape sheet_with(double wave) {
  Shape shape;
  shape.columns = shape.rows = 64;
  shape.position = [wave](double s, double t) {
    return glm::dvec3(100 * s, 80 * t, wave * (std::sin(9 * s) + std::cos(11 * t)));
  };
  shape.flat = [](double s, double t) { return glm::dvec2(100 * s, 80 * t); };
  return shape;
}

// A cube with `cells`² squares on each face.
TriangleMesh cube(std::uint32_t cells) {
  TriangleMesh mesh;
  for (int face = 0; face < 6; ++face) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t i = 0; i <= cells; ++i)
      for (std::uint32_t j = 0; j <= cells; ++j) {
        glm::dvec3 place;
        place[face / 2] = face % 2;
        place[(face / 2 + 1) % 3] = double(face % 2 ? i : j) / cells;
        place[(face / 2 + 2) % 3] = double(face % 2 ? j : i) / cells;
        mesh.positions.push_back(place);
      }
    for (std::uint32_t i = 0; i < cells; ++i)
      for (std::uint32_t j = 0; j < cells; ++j) {
        const std::uint32_t a = first + i * (cells + 1) + j, b = a + cells + 1;
        for (const std::uint32_t index : {a, b, b + 1, a, b + 1, a + 1})
          mesh.triangles.push_back(index);
      }
  }
  return mesh;
}

TEST(Rollout, shapes_without_an_axis_are_refused_with_advice) {
  Geometry one_point;
  one_point.positions = {{1, 2, 3}};
  one_point.vertices = {{{1, 2, 3}, 0, {0, 0}, 0, 0}};
  one_point.indices = {0, 0, 0};
  for (const Geometry& geometry :
       {test::cut_surface(sphere(), kCuts[0], 256).geometry,
        test::cut_surface(sheet_with(0), kCuts[0], 256).geometry,
        test::cut_surface(sheet_with(1), kCuts[0], 256).geometry, build_geometry(cube(1), {}),
        build_geometry(cube(20), {}), Geometry{}, one_point}) {
    const auto fit = fit_developed_surface(geometry, {});
    ASSERT_FALSE(fit) << geometry.triangle_count();
    EXPECT_EQ(fit.error().code, ErrorCode::invalid);
    EXPECT_EQ(fit.error().field, "axis");
    EXPECT_NE(fit.error().detail.find("Set the axis"), std::string::npos);
  }
}

TEST(Rollout, a_sphere_is_unrolled_around_the_callers_axis) {
  const Surface surface = test::cut_surface(sphere(), kCuts[0], 256);
  FitRequest request;
  request.axis = {kCenter, kAxis};
  request.radius = 20;
  const RolloutSheet sheet = roll_out(surface.geometry, request).sheet;
  EXPECT_NEAR(sheet.max.x - sheet.min.x, 2 * kPi * 20, 1e-6);
}

TEST(Rollout, a_side_without_a_wall_is_refused) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  FitRequest request;
  request.side = RolloutSide::inside;
  const auto fit = fit_developed_surface(surface.geometry, request);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().field, "side");
}

TEST(Rollout, a_cancelled_rollout_stops) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  const RolloutSheet sheet = roll_out(surface.geometry).sheet;
  const SearchTree tree(std::make_shared<Geometry>(surface.geometry));
  Progress progress;
  std::atomic<int> rows{0};
  const auto traced = trace_rollout(
      tree, surface.geometry, sheet, window_of(sheet, 0.1),
      [&](int, auto) {
        ++rows;
        progress.cancel();
      },
      progress);
  ASSERT_FALSE(traced);
  EXPECT_EQ(traced.error().code, ErrorCode::cancelled);
  EXPECT_LT(rows, 100);
}

TEST(Rollout, the_size_of_a_picture_is_known_before_it_is_made) {
  const Surface surface = test::cut_surface(wall(20, 0, 40), kCuts[0], 256);
  const RolloutSheet sheet = roll_out(surface.geometry).sheet;
  const RolloutWindow window = window_of(sheet, 0.5);
  EXPECT_EQ(window.width, 252);
  EXPECT_EQ(window.height, 80);
  EXPECT_EQ(pixels_of(sheet, 0.5), 252 * 80);
  EXPECT_GT(pixels_of(sheet, 1e-12), 1e20);
  EXPECT_EQ(window_of(sheet, 1e9).width, 1);
}

}  // namespace
}  // namespace strata::mesh
