#include "query/sampling/values.h"
#include "domain/scene/camera.h"
#include "mesh/surface/geometry.h"
#include "mesh/surface/search_tree.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "query/sampling/profile.h"

namespace strata::query {
namespace {

constexpr glm::dvec3 kOrigin{4'000'000.0, 500'000.0, 100.0};

// Returns a square of 2 × 2 around the origin at z = 0 that faces +z, with uv from (0,0) to (1,1).
std::shared_ptr<const mesh::Geometry> square() {
  auto geometry = std::make_shared<mesh::Geometry>();
  geometry->origin = kOrigin;
  for (int i = 0; i < 4; ++i) {
    const float u = static_cast<float>(i & 1), v = static_cast<float>(i >> 1);
    mesh::Vertex vertex{};
    vertex.position = {2 * u - 1, 2 * v - 1, 0};
    vertex.uv = {u, v};
    vertex.position_index = static_cast<std::uint32_t>(i);
    geometry->vertices.push_back(vertex);
    geometry->positions.push_back(glm::dvec3(vertex.position) + kOrigin);
  }
  geometry->indices = {0, 1, 3, 0, 3, 2};
  geometry->box_min = {-1, -1, 0};
  geometry->box_max = {1, 1, 0};
  return geometry;
}

LayerView layer_with(ValueType type, int resolution, int x, int y, double value) {
  LayerView view;
  view.layer.slug = "salt";
  view.layer.type = type;
  view.layer.resolution = resolution;
  auto tile = std::make_shared<TileData>(type);
  tile->write(y % kTileSize * kTileSize + x % kTileSize, *encode_value(type, value));
  view.snapshot.tiles[{static_cast<std::uint16_t>(x / kTileSize),
                       static_cast<std::uint16_t>(y / kTileSize)}] = tile;
  return view;
}

TEST(QueryValues, a_texture_coordinate_reads_the_texel_that_holds_it) {
  const LayerView view = layer_with(ValueType::i16, 256, 130, 7, -12);
  const float texel = 1.0f / 256;
  EXPECT_TRUE(value_at(view, {130.01f * texel, 7.01f * texel}).valid);
  const auto value = value_at(view, {130.99f * texel, 7.99f * texel});
  EXPECT_TRUE(value.valid);
  EXPECT_EQ(value.value, -12);
  EXPECT_EQ(value.layer, "salt");
  EXPECT_FALSE(value_at(view, {129.99f * texel, 7.5f * texel}).valid);
  EXPECT_FALSE(value_at(view, {130.5f * texel, 8.01f * texel}).valid);
  EXPECT_FALSE(value_at(view, {0.1f, 0.9f}).valid) << "no tile at all";
}

TEST(QueryValues, the_edges_of_the_texture_belong_to_its_outer_texels) {
  EXPECT_TRUE(value_at(layer_with(ValueType::u8, 256, 255, 255, 1), {1, 1}).valid);
  EXPECT_TRUE(value_at(layer_with(ValueType::u8, 256, 0, 255, 1), {-0.1f, 1.2f}).valid);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(value_at(layer_with(ValueType::u8, 256, 0, 0, 1), {nan, nan}).valid) << "no crash";
}

TEST(QueryValues, the_nearest_point_is_found_in_world_coordinates) {
  const mesh::SearchTree tree(square());
  // uv (0.75, 0.25) is the position (0.5, -0.5).
  const LayerView view = layer_with(ValueType::f32, 256, 192, 64, 0.5);
  const auto point = nearest_point(tree, kOrigin, kOrigin + glm::dvec3(0.504, -0.496, 3), {view});
  ASSERT_TRUE(point.hit);
  EXPECT_NEAR(point.distance, 3, 1e-5);
  EXPECT_LT(glm::distance(point.position, kOrigin + glm::dvec3(0.504, -0.496, 0)), 1e-5);
  EXPECT_NEAR(point.normal.z, 1, 1e-5);
  ASSERT_EQ(point.values.size(), 1u);
  EXPECT_TRUE(point.values[0].valid);
  EXPECT_EQ(point.values[0].value, 0.5);
}

TEST(QueryValues, a_point_that_is_not_a_number_hits_nothing) {
  const mesh::SearchTree tree(square());
  const auto point =
      nearest_point(tree, kOrigin, glm::dvec3(std::numeric_limits<double>::quiet_NaN()),
                    {layer_with(ValueType::u8, 256, 0, 0, 1)});
  EXPECT_FALSE(point.hit);
}

TEST(QueryValues, a_pixel_picks_what_is_under_it) {
  const mesh::SearchTree tree(square());
  Camera camera;
  camera.width = 400;
  camera.height = 400;
  camera.view = glm::lookAt(kOrigin + glm::dvec3(0, 0, 5), kOrigin, glm::dvec3(0, 1, 0));
  camera.projection = glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 100.0);
  const LayerView view = layer_with(ValueType::u8, 256, 192, 192, 9);  // position (0.5, 0.5)
  const auto point = pick(tree, kOrigin, camera, 250.4, 149.6, {view});
  ASSERT_TRUE(point.hit);
  EXPECT_LT(glm::distance(point.position, kOrigin + glm::dvec3(0.504, 0.504, 0)), 1e-4);
  EXPECT_NEAR(point.distance, 4.9, 1e-4) << "from the near plane";
  EXPECT_EQ(point.values[0].value, 9);
  EXPECT_FALSE(pick(tree, kOrigin, camera, 20, 20, {view}).hit) << "beside the square";
  EXPECT_FALSE(pick(tree, kOrigin, camera, -5, 200, {view}).hit) << "outside the window";
}

TEST(QueryValues, a_pick_sees_what_the_section_keeps) {
  auto geometry = std::make_shared<mesh::Geometry>(*square());
  for (int i = 0; i < 4; ++i) {  // a second square below, also facing up
    mesh::Vertex vertex = geometry->vertices[static_cast<std::size_t>(i)];
    vertex.position.z = -1;
    vertex.position_index += 4;
    geometry->vertices.push_back(vertex);
    geometry->positions.push_back(glm::dvec3(vertex.position) + kOrigin);
  }
  for (const std::uint32_t i : {0, 1, 3, 0, 3, 2}) geometry->indices.push_back(4 + i);
  const mesh::SearchTree tree(geometry);
  Camera camera{glm::lookAt(kOrigin + glm::dvec3(0, 0, 5), kOrigin, glm::dvec3(0, 1, 0)),
                glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 20.0), 400, 400};
  const auto height = [&]() -> std::optional<double> {
    const auto point = pick(tree, kOrigin, camera, 250, 150, {});
    return point.hit ? std::optional(point.position.z - kOrigin.z) : std::nullopt;
  };
  EXPECT_NEAR(*height(), 0, 1e-6);
  camera.section = {{0, 0, -3, 3 * (kOrigin.z - 0.5)}};  // keeps the part below -0.5
  EXPECT_NEAR(*height(), -1, 1e-6);
  EXPECT_NEAR(pick(tree, kOrigin, camera, 250, 150, {}).distance, 5.9, 1e-4)
      << "from the near plane, as ever";
  camera.section.push_back({0, 0, 1, -kOrigin.z + 0.7});  // and above -0.7
  EXPECT_FALSE(height());
  camera.section = {{1, 0, 0, -kOrigin.x - 1.5}};  // misses the ray
  EXPECT_FALSE(height());
  // From below, the plane is between the eye and the back of the upper square. The solid between
  // the plane and that square is closed at the plane.
  camera.view = glm::lookAt(kOrigin + glm::dvec3(0, 0, -5), kOrigin, glm::dvec3(0, 1, 0));
  camera.section = {{0, 0, 1, -kOrigin.z + 0.5}};
  EXPECT_FALSE(height());
  camera.section.clear();
  EXPECT_NEAR(*height(), -1, 1e-6) << "uncut surface is picked from both sides";
}

TEST(QueryProfile, a_line_over_a_plane_is_as_long_as_it_was_drawn_and_reads_what_lies_under_it) {
  const mesh::SearchTree tree(square());
  // Only one texel has a value. It extends from the middle of the square to 2/256 in x and y.
  const LayerView view = layer_with(ValueType::u8, 256, 128, 128, 9);
  const std::vector<glm::dvec3> places = {kOrigin + glm::dvec3(-0.5, 0.004, 0.3),
                                          kOrigin + glm::dvec3(0.5, 0.004, 0.3)};
  const auto profile = profile_near(tree, kOrigin, places, 0.001, {view});
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->samples.size(), 1001u);
  EXPECT_NEAR(profile->length, 1, 1e-5);
  EXPECT_NEAR(profile->samples.back().along, 1, 1e-5);
  int inside = 0;
  for (const auto& sample : profile->samples) inside += sample.point.values[0].valid;
  EXPECT_NEAR(inside, 2.0 / 256 / 0.001, 1.5);
  EXPECT_NEAR(profile->samples[503].along, 0.503, 1e-5);
  EXPECT_TRUE(profile->samples[503].point.values[0].valid);
}

TEST(QueryProfile, what_a_line_of_a_view_misses_adds_no_length) {
  const mesh::SearchTree tree(square());
  Camera camera;
  camera.width = camera.height = 400;
  camera.view = glm::lookAt(kOrigin + glm::dvec3(0, 0, 3), kOrigin, glm::dvec3(0, 1, 0));
  camera.projection = glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 10.0);  // 100 pixels a unit
  const std::vector<glm::dvec2> path = {{20, 200}, {380, 200}, {380, 250}, {200, 250}};
  const auto profile = profile_seen(tree, kOrigin, camera, path, {});
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->samples.size(), 360u + 50u + 180u + 1u);
  EXPECT_NEAR(profile->length, 2 + 1, 0.04) << "all of the square, and half of it";
  EXPECT_FALSE(profile->samples.front().point.hit);
  EXPECT_FALSE(profile->samples[400].point.hit);
  EXPECT_TRUE(profile->samples.back().point.hit);
}

TEST(QueryProfile, too_many_samples_are_refused) {
  const mesh::SearchTree tree(square());
  const std::vector<glm::dvec3> places = {kOrigin, kOrigin + glm::dvec3(1, 0, 0)};
  EXPECT_EQ(profile_near(tree, kOrigin, places, 1e-5, {}).error().field, "step_mm");
  EXPECT_EQ(profile_near(tree, kOrigin, places, 1e-300, {}).error().field, "step_mm");
  const std::vector<glm::dvec2> path = {{0, 0}, {1e6, 0}};
  EXPECT_EQ(profile_seen(tree, kOrigin, {}, path, {}).error().field, "path");
}

}  // namespace
}  // namespace strata::query
