#include "bench/standing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace strata::bench {
namespace {

// Returns points in a box far from the origin, as in a scan with national coordinates.
mesh::Geometry cloud(const glm::vec3& extent) {
  mesh::Geometry geometry;
  geometry.origin = {433210, 4581234, 612};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-0.5f, 0.5f);
  for (int i = 0; i < 1000; ++i) {
    mesh::Vertex vertex{};
    vertex.position = extent * glm::vec3(anywhere(random), anywhere(random), anywhere(random));
    geometry.vertices.push_back(vertex);
  }
  return geometry;
}

// Returns coordinates within −1…1 of the image and of the depth.
glm::dvec3 projected(const Camera& camera, const glm::dvec3& world) {
  const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(world, 1);
  return glm::dvec3(clip) / clip.w;
}

TEST(Standing, a_model_of_any_shape_fills_its_picture_and_none_of_it_is_cut_off) {
  for (const glm::vec3 extent : {glm::vec3(37, 67, 4.5), glm::vec3(0.2f, 0.5f, 0.3f),
                                 glm::vec3(1, 1, 1000), glm::vec3(1e-7f)})
    for (const char* up : {"x", "y", "z"})
      for (const glm::dvec3 from :
           {glm::dvec3(0.5, 1, 0.45), glm::dvec3(-0.5, -1, 0.45), glm::dvec3(0.15, 0.45, 1)}) {
        const auto geometry = cloud(extent);
        const Camera camera = fitted_camera(geometry, {up, 20}, from, 480);
        glm::dvec3 most(0);
        for (const auto& vertex : geometry.vertices)
          most = glm::max(
              most, glm::abs(projected(camera, geometry.origin + glm::dvec3(vertex.position))));
        EXPECT_LE(std::max(most.x, most.y), 0.9) << "a margin is left";
        EXPECT_GE(std::max(most.x, most.y), 0.85) << "it fills the picture";
        EXPECT_LT(most.z, 1) << "nothing is before or behind what is drawn";
      }
}

TEST(Standing, what_is_up_in_the_model_is_up_in_the_picture_and_its_front_is_seen_from_before_it) {
  const auto geometry = cloud({1, 1, 1});
  const glm::dvec3 ups[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const glm::dvec3 fronts[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}};
  const char* names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const Camera camera = fitted_camera(geometry, {names[k], 0}, {0.5, 1, 0.45}, 480);
    const auto middle = projected(camera, geometry.origin);
    const auto above = projected(camera, geometry.origin + 0.1 * ups[k]);
    EXPECT_GT(above.y, middle.y + 0.01);
    EXPECT_NEAR(above.x, middle.x, 0.01);
    EXPECT_LT(projected(camera, geometry.origin + 0.1 * fronts[k]).z, middle.z)
        << "the front is nearer";
    // The axes are right-handed. If the camera shows the right side of the model, the front is on
    // the left.
    EXPECT_LT(projected(camera, geometry.origin + 0.1 * fronts[k]).x, middle.x);
    EXPECT_GT(projected(camera, geometry.origin + 0.1 * glm::cross(ups[k], fronts[k])).x, middle.x);
    const Camera turned = fitted_camera(geometry, {names[k], 90}, {0, 1, 0.45}, 480);
    EXPECT_LT(projected(turned, geometry.origin + 0.1 * glm::cross(ups[k], fronts[k])).z,
              projected(turned, geometry.origin).z)
        << "turned to the right";
  }
}

TEST(Standing, what_the_file_says_counts_more_than_what_is_known_of_it) {
  EXPECT_EQ(standing_of("statue_nefertiti_70k.ply", "").up, "y");
  EXPECT_EQ(standing_of("statue_nefertiti_70k.ply", "x").up, "x");
  EXPECT_EQ(standing_of("somebody's.ply", "").up, "z");
  EXPECT_NE(standing_of("bust_manwreath_uv_notexture_31k.glb", "y").turned_degrees, 0);
}

}  // namespace
}  // namespace strata::bench
