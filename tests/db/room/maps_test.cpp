// Maps and measurements are painted over a layer as one edit, with a real database and renderer.
#include <cmath>

#include "room/edit.h"
#include "room/queries.h"
#include "room/surface.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using test::RoomTest;

class RoomMaps : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    layer_ = make_layer(ValueType::u8, 2048, "map");
  }
  Camera view() const { return camera({0.3, -1, 0.4}); }
  query::SurfacePoint pick(double x, double y) {
    return *room()->queries().pick(view(), x, y, {"map"});
  }
  Result<room::EditAnswer> paint(TileMap tiles) {
    return send(request(layer_, room::ImportEdit{std::move(tiles), true}));
  }

  Layer layer_;
};

TEST_F(RoomMaps, readings_are_painted_around_their_places_over_what_is_there) {
  ASSERT_TRUE(send(request(layer_, room::FillEdit{false, 9})));
  const auto before = room()->queries().tiles("map", {});
  const auto a = pick(300, 240), b = pick(360, 260);
  ASSERT_TRUE(a.hit && b.hit);
  const double radius = 3;
  auto tiles =
      room()->surface().point_splats(layer_, {{a.position, 1, 2}, {b.position, 2, 3}}, radius, 0.5);
  ASSERT_TRUE(tiles) << tiles.error().detail;
  const auto answer = paint(*tiles);
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(pick(300, 240).values.at(0).value, 1);
  EXPECT_EQ(pick(360, 260).values.at(0).value, 2);
  EXPECT_EQ(pick(330, 180).values.at(0).value, 9) << "the rest stays";
  const auto statistics = room()->queries().statistics("map");
  const double disc_m2 = 3.14159 * radius * radius * 1e-6;
  for (const double key : {1.0, 2.0})
    EXPECT_NEAR(statistics->keys.at(key).area_m2, disc_m2, 0.25 * disc_m2);
  EXPECT_NEAR(answer->area_m2, statistics->keys.at(1).area_m2 + statistics->keys.at(2).area_m2,
              1e-9);
  ASSERT_TRUE(send(request(layer_, room::UndoEdit{})));
  EXPECT_TRUE(test::equal(room()->queries().tiles("map", {})->tiles, before->tiles));
  ASSERT_TRUE(send(request(layer_, room::RedoEdit{})));
  restart();
  EXPECT_EQ(pick(300, 240).values.at(0).value, 1);
  expect_room_equals_journal(layer_);
}

TEST_F(RoomMaps, a_reading_too_far_from_the_surface_is_refused_with_its_line) {
  const auto a = pick(300, 240);
  const auto tiles = room()->surface().point_splats(
      layer_, {{a.position, 1, 2}, {a.position + glm::dvec3(0, -500, 0), 2, 7}}, 3, 1);
  ASSERT_FALSE(tiles);
  EXPECT_EQ(tiles.error().code, ErrorCode::invalid);
  EXPECT_NE(tiles.error().detail.find("Line 7"), std::string::npos);
}

TEST_F(RoomMaps, a_map_is_painted_on_what_is_seen_first_along_its_direction) {
  const glm::dvec3 middle = (model_.bounds_min + model_.bounds_max) * 0.5;
  const auto east = [&](const glm::dvec3& world) -> std::optional<std::uint32_t> {
    if (world.x < middle.x) return std::nullopt;
    return world.z > middle.z ? 2u : 1u;
  };
  auto tiles = room()->surface().project(layer_, {0, 1, 0}, east);  // viewed from -y
  ASSERT_TRUE(tiles) << tiles.error().detail;
  ASSERT_TRUE(paint(*tiles));
  // Rays in the direction of the projection hit the first visible surface, which has the values of
  // the map. Rays from the opposite side hit a surface without values.
  const double size = glm::length(model_.bounds_max - model_.bounds_min);
  int right = 0, wrong = 0, behind = 0;
  for (int i = 0; i < 400; ++i) {
    const double x = middle.x + size * 0.3 * std::sin(i * 1.7),
                 z = middle.z + size * 0.3 * std::cos(i * 2.3);
    const Camera ray = camera({0, -1, 0.0001}, true);
    const glm::dvec4 clip = ray.projection * ray.view * glm::dvec4(x, middle.y, z, 1);
    const auto seen = room()->queries().pick(ray, (clip.x * 0.5 + 0.5) * ray.width,
                                             (0.5 - clip.y * 0.5) * ray.height, {"map"});
    if (!seen->hit || std::abs(seen->position.x - middle.x) < 0.3 ||
        std::abs(seen->position.z - middle.z) < 0.3)
      continue;
    if (std::abs(seen->normal.y) < 0.4) continue;  // the angle to the surface is small
    const auto expected = east(seen->position);
    const auto& value = seen->values.at(0);
    ++(value.valid == expected.has_value() && (!expected || value.value == *expected) ? right
                                                                                      : wrong);
    const Camera other = camera({0, 1, 0.0001}, true);
    const glm::dvec4 back = other.projection * other.view * glm::dvec4(x, middle.y, z, 1);
    const auto hidden = room()->queries().pick(other, (back.x * 0.5 + 0.5) * other.width,
                                               (0.5 - back.y * 0.5) * other.height, {"map"});
    if (hidden->hit && std::abs(hidden->normal.y) > 0.4) behind += hidden->values.at(0).valid;
  }
  EXPECT_GT(right, 100);
  EXPECT_LE(wrong, right / 100);
  EXPECT_LE(behind, right / 50) << "only where a broken rim lets it be seen from both sides";
}

}  // namespace
}  // namespace strata
