#include "domain/scene/camera.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace strata {
namespace {

TEST(Camera, of_some_rows_sees_there_what_the_whole_one_sees) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.projection = glm::dmat4(1.5, 0, 0, 0, 0, 2, 0, 0, 0.1, 0.2, -1.02, -1, 0, 0, -0.2, 0);
  camera.view[3] = glm::dvec4(0.1, -0.3, -5, 1);
  for (const auto& [top, rows] :
       {std::pair(0, 480), std::pair(0, 32), std::pair(100, 7), std::pair(448, 32)}) {
    const Camera part = camera_of_rows(camera, top, rows);
    EXPECT_EQ(part.height, rows);
    for (const double y : {0.0, 0.5, 6.25}) {
      const Ray whole = ray_through_pixel(camera, 123.5, top + y),
                own = ray_through_pixel(part, 123.5, y);
      EXPECT_LT(glm::distance(whole.origin, own.origin), 1e-9);
      EXPECT_LT(glm::distance(whole.direction, own.direction), 1e-9);
    }
  }
}

}  // namespace
}  // namespace strata
