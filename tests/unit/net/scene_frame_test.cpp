#include "net/api/linked/scene_frame.h"

#include <gtest/gtest.h>

#include "domain/scene/model.h"

namespace strata::net {
namespace {

Model model_with(const char* up, Unit unit = Unit::mm) {
  Model model;
  model.up = up;
  model.unit = unit;
  model.origin = {1000, 2000, 3000};
  return model;
}

// The directions of each up direction are those of the views (domain/scene/up.h).
TEST(SceneFrame, up_is_y_and_lengths_are_meters_from_the_origin) {
  for (const char* up : {"x", "y", "z", "-x", "-y", "-z"}) {
    const Model model = model_with(up);
    const std::string name = up;
    glm::dvec3 direction(0);
    direction[name.back() - 'x'] = name.front() == '-' ? -1 : 1;
    const glm::dvec3 place = SceneFrame(model).place(model.origin + 250.0 * direction);
    EXPECT_NEAR(glm::distance(place, glm::dvec3(0, 0.25, 0)), 0, 1e-12) << up;
  }
}

TEST(SceneFrame, shapes_are_not_mirrored) {
  for (const char* up : {"x", "y", "z", "-x", "-y", "-z"}) {
    const SceneFrame frame(model_with(up));
    const glm::dvec3 x = frame.direction({1, 0, 0}), y = frame.direction({0, 1, 0}),
                     z = frame.direction({0, 0, 1});
    EXPECT_NEAR(glm::dot(glm::cross(x, y), z), 1, 1e-12) << up;
  }
}

TEST(SceneFrame, the_origin_of_the_world_is_where_a_file_in_world_coordinates_moves) {
  const Model model = model_with("z", Unit::m);
  const SceneFrame frame(model);
  const glm::dvec3 world(1001, 2002, 3003);
  EXPECT_NEAR(glm::distance(frame.direction(world) + frame.world_origin(), frame.place(world)), 0,
              1e-9);
}

TEST(SceneFrame, geometries_are_well_known_text) {
  const SceneFrame frame(model_with("y"));
  app::Feature feature;
  EXPECT_EQ(scene_wkt(feature, app::FeatureKind::areas, frame), "");
  const query::FlatRing ring{{1000, 2000, 3000}, {2000, 2000, 3000}, {2000, 3000.5, 3000}};
  feature.geometry = {{{ring}}};
  EXPECT_EQ(scene_wkt(feature, app::FeatureKind::areas, frame),
            "POLYGON Z ((0 0 0,1 0 0,1 1.0005 0,0 0 0))");
  EXPECT_EQ(scene_wkt(feature, app::FeatureKind::lines, frame),
            "LINESTRING Z (0 0 0,1 0 0,1 1.0005 0)");
  feature.geometry = {{{ring, ring}}, {{ring}}};
  EXPECT_EQ(scene_wkt(feature, app::FeatureKind::areas, frame),
            "MULTIPOLYGON Z (((0 0 0,1 0 0,1 1.0005 0,0 0 0),(0 0 0,1 0 0,1 1.0005 0,0 0 0)),"
            "((0 0 0,1 0 0,1 1.0005 0,0 0 0)))");
  feature.geometry = {{{{{1000, 2000, 2000}}}}};
  EXPECT_EQ(scene_wkt(feature, app::FeatureKind::points, frame), "POINT Z (0 0 -1)");
}

}  // namespace
}  // namespace strata::net
