// Outlines of painted areas on shapes with known areas.
#include "query/maps/plane_outlines.h"
#include "mesh/surface/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "domain/people/question.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::query {
namespace {

using test::Surface;
constexpr double kPi = std::numbers::pi;
constexpr ValueClasses kEach{.each = true};

PlaneOutlines outlines(const Surface& surface, const std::function<int(glm::vec3)>& value_at,
                       const OutlinePlane& plane = {}) {
  LayerView view;
  view.layer.type = ValueType::u8;
  view.layer.resolution = surface.map.resolution;
  view.snapshot.tiles = test::layer_of(surface.map, value_at);
  auto made = plane_outlines(view, surface.geometry, surface.map, kEach, plane);
  EXPECT_TRUE(made) << (made ? "" : made.error().detail);
  return made ? std::move(*made) : PlaneOutlines{};
}

double area_of(const std::vector<FlatPolygon>& polygons) {
  double area = 0;
  for (const FlatPolygon& polygon : polygons)
    for (const FlatRing& ring : polygon.rings) area += ring_area(ring);
  return area;
}

double painted_area(const Surface& surface, const std::function<int(glm::vec3)>& value_at,
                    int value) {
  double area = 0;
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (value_at(surface.map.position(texel / 64, static_cast<int>(texel % 64))) == value)
      area += surface.map.area[texel];
  });
  return area;
}

Surface flat_sheet(const glm::dvec3& offset = glm::dvec3(0)) {
  return test::surface_of("sheet", test::transformed(test::open_grid(24, 0), 1, offset), 1024);
}

// Returns the value at a point in model space. The center of the disc is the center of the sheet.
int disc_with_a_core(glm::vec3 p) {
  const float r = std::hypot(p.x, p.y);
  return r < 0.1f ? 2 : r < 0.3f ? 1 : 0;
}

// Returns only the lower left and the upper right quarter of the sheet, each with a hole. They meet
// at the center vertex, where the first rim begins.
Surface two_lobes() {
  Surface surface = flat_sheet();
  mesh::Geometry& geometry = surface.geometry;
  const auto place = [&](std::uint32_t vertex) {
    return glm::vec2(geometry.vertices[vertex].position);
  };
  const auto is_on_axis = [&](std::uint32_t vertex) {
    return std::abs(place(vertex).x) < 1e-5f || std::abs(place(vertex).y) < 1e-5f;
  };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
    std::array corners{geometry.indices[i], geometry.indices[i + 1], geometry.indices[i + 2]};
    const glm::vec2 middle = place(corners[0]) + place(corners[1]) + place(corners[2]);
    // The argument is the sum over three corners.
    const auto is_hole = [](float sum) { return std::abs(sum) > 0.6f && std::abs(sum) < 0.9f; };
    if (middle.x * middle.y < 0 || (is_hole(middle.x) && is_hole(middle.y))) continue;
    for (int turn = 0; turn < 3; ++turn) {
      std::ranges::rotate(corners, corners.begin() + 1);
      if (glm::length(place(corners[0])) > 1e-5f || !is_on_axis(corners[1])) continue;
      triangles.insert(triangles.begin(), corners);
      break;
    }
    if (triangles.empty() || triangles.front() != corners) triangles.push_back(corners);
  }
  geometry.indices.clear();
  for (const auto& corners : triangles)
    geometry.indices.insert(geometry.indices.end(), corners.begin(), corners.end());
  EXPECT_LT(glm::length(place(geometry.indices.front())), 1e-5f);
  Progress progress;
  surface.map = *mesh::bake_surface_map(geometry, surface.map.resolution, progress);
  return surface;
}

TEST(PlaneOutlines, are_made_of_the_chosen_classes_only) {
  const Surface surface = flat_sheet();
  LayerView view;
  view.layer.type = ValueType::u8;
  view.layer.resolution = surface.map.resolution;
  view.snapshot.tiles = test::layer_of(surface.map, disc_with_a_core);
  const std::set<std::uint32_t> core{2};
  const auto some = plane_outlines(view, surface.geometry, surface.map, kEach, {}, &core);
  const PlaneOutlines all = outlines(surface, disc_with_a_core);
  ASSERT_TRUE(some);
  ASSERT_EQ(some->size(), 1u);
  EXPECT_DOUBLE_EQ(area_of(some->at(2)), area_of(all.at(2)));
}

TEST(PlaneOutlines, lobes_of_a_chart_that_meet_in_one_vertex_are_both_there) {
  const Surface surface = two_lobes();
  const auto everywhere = [](glm::vec3) { return 1; };
  const auto found = outlines(surface, everywhere);
  const double painted = painted_area(surface, everywhere, 1);
  ASSERT_GT(painted, 0);
  EXPECT_NEAR(area_of(found.at(1)), painted, 0.01 * painted);
}

TEST(PlaneOutlines, a_flat_area_has_the_area_of_its_texels_and_its_hole) {
  const glm::dvec3 offset(4'500'000, 700'000, 120);
  const Surface surface = flat_sheet(offset);
  const auto middle = [&](glm::vec3 p) {
    return disc_with_a_core(p - glm::vec3(offset + 0.5 - surface.geometry.origin));
  };
  const PlaneOutlines made = outlines(surface, middle);
  ASSERT_EQ(made.size(), 2u);
  const auto &ring = made.at(1), &core = made.at(2);
  ASSERT_EQ(ring.size(), 1u);
  ASSERT_EQ(ring[0].rings.size(), 2u);
  ASSERT_EQ(core.size(), 1u);
  ASSERT_EQ(core[0].rings.size(), 1u);
  EXPECT_GT(ring_area(ring[0].rings[0]), 0) << "counter-clockwise";
  EXPECT_LT(ring_area(ring[0].rings[1]), 0) << "a hole goes the other way";
  EXPECT_NEAR(area_of(ring) / painted_area(surface, middle, 1), 1, 0.01);
  EXPECT_NEAR(area_of(core) / painted_area(surface, middle, 2), 1, 0.01);
  const double texel = 1.0 / 1024;
  for (const glm::dvec3& corner : core[0].rings[0]) {
    EXPECT_NEAR(std::hypot(corner.x - offset.x - 0.5, corner.y - offset.y - 0.5), 0.1, 2 * texel);
    EXPECT_NEAR(corner.z, offset.z, 1e-5);
  }
  EXPECT_LT(core[0].rings[0].size(), 400u) << "fewer corners than the texels along it";
}

TEST(PlaneOutlines, areas_end_where_the_surface_ends) {
  const Surface surface = flat_sheet();
  const auto everywhere = [](glm::vec3) { return 7; };
  const PlaneOutlines made = outlines(surface, everywhere);
  ASSERT_EQ(made.at(7).size(), 1u);
  ASSERT_EQ(made.at(7)[0].rings.size(), 1u);
  EXPECT_NEAR(area_of(made.at(7)), surface.map.area_total, 1e-4 * surface.map.area_total);
}

TEST(PlaneOutlines, seams_of_the_atlas_are_no_borders) {
  // The whole ball is one chart or many. From any side, its outline must be a disc without holes.
  const Surface ball = test::surface_of("ball", test::sphere(48), 1024);
  const double radius = (ball.geometry.box_max.x - ball.geometry.box_min.x) / 2;
  for (const OutlinePlane plane :
       {OutlinePlane{0, 1, 2}, OutlinePlane{0, 2, 1}, OutlinePlane{1, 2, 0}}) {
    const PlaneOutlines made = outlines(
        ball, [](glm::vec3) { return 1; }, plane);
    ASSERT_EQ(made.at(1).size(), 1u);
    EXPECT_EQ(made.at(1)[0].rings.size(), 1u);
    EXPECT_NEAR(area_of(made.at(1)) / (kPi * radius * radius), 1, 0.01);
  }
  // A cap that extends over several charts.
  const auto cap = [&](glm::vec3 p) { return p.z > 0.6 * radius ? 1 : 0; };
  const PlaneOutlines made = outlines(ball, cap);
  ASSERT_EQ(made.at(1).size(), 1u);
  EXPECT_EQ(made.at(1)[0].rings.size(), 1u);
  EXPECT_NEAR(area_of(made.at(1)) / (kPi * radius * radius * 0.64), 1, 0.02);
}

TEST(PlaneOutlines, every_face_of_a_cube_that_is_a_chart_of_its_own_meets_the_others) {
  const Surface cube = test::surface_of("cube", test::cube_with_face_charts(), 512);
  const double side = cube.geometry.box_max.x - cube.geometry.box_min.x;
  const PlaneOutlines made = outlines(cube, [](glm::vec3) { return 1; });
  ASSERT_EQ(made.at(1).size(), 1u);
  ASSERT_EQ(made.at(1)[0].rings.size(), 1u);
  EXPECT_NEAR(area_of(made.at(1)), side * side, 1e-3 * side * side);
}

TEST(PlaneOutlines, an_area_that_is_seen_edge_on_has_no_polygon) {
  const PlaneOutlines made = outlines(flat_sheet(), [](glm::vec3) { return 1; }, {1, 2, 0});
  ASSERT_EQ(made.size(), 1u);
  EXPECT_TRUE(made.at(1).empty());
}

TEST(PlaneOutlines, where_nothing_is_painted_there_is_no_class) {
  EXPECT_TRUE(outlines(flat_sheet(), [](glm::vec3) { return 0; }).empty());
}

TEST(PlaneOutlines, areas_that_touch_at_a_corner_of_texels_are_valid) {
  const Surface surface = flat_sheet();
  const auto board = [](glm::vec3 p) {
    return std::abs(p.x) < 0.4f && std::abs(p.y) < 0.4f && (p.x > 0) == (p.y > 0) ? 1 : 0;
  };
  const auto shifted = [&](glm::vec3 p) {
    return board(p - glm::vec3(glm::dvec3(0.5, 0.5, 0) - surface.geometry.origin));
  };
  const PlaneOutlines made = outlines(surface, shifted);
  EXPECT_EQ(made.at(1).size(), 2u);
  EXPECT_NEAR(area_of(made.at(1)) / painted_area(surface, shifted, 1), 1, 0.01);
}

TEST(PlaneOutlines, borders_with_too_many_corners_are_refused_before_they_are_laid_on_the_plane) {
  const Surface surface = test::surface_of("sheet", test::open_grid(24, 0), 2048);
  LayerView view;
  view.layer.type = ValueType::u8;
  view.layer.resolution = surface.map.resolution;
  auto board = std::make_shared<TileData>(ValueType::u8);
  for (int i = 0; i < kTexelsPerTile; ++i) board->write(i, 1 + (i / kTileSize + i % kTileSize) % 2);
  for (std::uint16_t y = 0; y < 16; ++y)
    for (std::uint16_t x = 0; x < 16; ++x) view.snapshot.tiles[{x, y}] = board;
  const auto made = plane_outlines(view, surface.geometry, surface.map, kEach, {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::invalid);
}

TEST(PlaneOutlines, they_end_with_their_question) {
  const Surface surface = flat_sheet();
  const auto question = std::make_shared<Question>("ana", QuestionLimits{}, nullptr);
  const Question::Scope scope(question);
  EXPECT_FALSE(outlines(surface, [](glm::vec3) { return 1; }).empty());
  std::vector<FlatArea> discs;
  for (const double x : {0.0, 0.5}) {
    FlatRing ring;
    for (int i = 0; i < 20'000; ++i)
      ring.emplace_back(x + std::cos(i * kPi / 10'000), std::sin(i * kPi / 10'000), 0);
    discs.emplace_back(FlatPolygon{{ring}});
  }
  question->end({ErrorCode::cancelled, "Given up", "Nobody waits any more."});
  EXPECT_THROW(outlines(surface, [](glm::vec3) { return 1; }), QuestionEnded);
  EXPECT_THROW(FlatArea::joined(std::move(discs), 1e-6), QuestionEnded) << "GEOS asks, too";
}

TEST(PlaneOutlines, every_class_of_mesh_has_outlines) {
  for (const test::NamedMesh& named : test::mesh_classes()) {
    SCOPED_TRACE(named.name);
    const Surface surface = test::surface_of(named.name, named.mesh, 512);
    const PlaneOutlines made =
        outlines(surface, [](glm::vec3 p) { return 1 + (std::sin(9 * p.x) > 0); });
    for (const auto& [value, polygons] : made)
      for (const FlatPolygon& polygon : polygons) EXPECT_GT(ring_area(polygon.rings[0]), 0);
  }
}

}  // namespace
}  // namespace strata::query
