#include "query/maps/crs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace strata::query {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Returns the length of the meridian of the GRS 80 ellipsoid from the equator to a latitude, as the
// integral of its radius of curvature (Simpson's rule).
double meridian_arc(double latitude) {
  constexpr double kRadius = 6'378'137, kFlattening = 1 / 298.257222101;
  constexpr double kSquare = kFlattening * (2 - kFlattening);
  constexpr int kSteps = 2000;
  const auto curvature = [&](double at) {
    return kRadius * (1 - kSquare) / std::pow(1 - kSquare * std::pow(std::sin(at), 2), 1.5);
  };
  double sum = curvature(0) + curvature(latitude);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 ? 4 : 2) * curvature(latitude * i / kSteps);
  return sum * latitude / (3 * kSteps);
}

TEST(Crs, the_central_meridian_of_a_zone_has_the_length_of_the_ellipsoid) {
  const auto zone = Crs::of_epsg(25833);
  ASSERT_TRUE(zone) << zone.error().detail;
  EXPECT_EQ((*zone)->name(), "ETRS89 / UTM zone 33N");
  EXPECT_FALSE((*zone)->is_north_first());
  for (const double latitude : {10.0, 52.5, 71.0}) {
    const glm::dvec2 place(500'000, 0.9996 * meridian_arc(latitude * kDegree));
    const auto degrees = (*zone)->to_degrees(place);
    ASSERT_TRUE(degrees);
    EXPECT_NEAR(degrees->x, 15, 1e-9);
    EXPECT_NEAR(degrees->y, latitude, 1e-8) << "about a millimeter";
  }
}

TEST(Crs, coordinates_come_back) {
  const auto zone = Crs::of_epsg(25832);
  ASSERT_TRUE(zone);
  for (const glm::dvec2& place : {glm::dvec2(412'345.678, 5'312'345.123), {600'000, 6'000'000}}) {
    const auto degrees = (*zone)->to_degrees(place);
    ASSERT_TRUE(degrees);
    const auto back = (*zone)->from_degrees(*degrees);
    ASSERT_TRUE(back);
    EXPECT_LT(glm::distance(*back, place), 1e-4);
  }
}

TEST(Crs, the_register_decides_which_axis_is_first) {
  const auto new_zealand = Crs::of_epsg(2193);
  ASSERT_TRUE(new_zealand);
  EXPECT_TRUE((*new_zealand)->is_north_first());
  const auto degrees = (*new_zealand)->to_degrees({1'600'000, 5'400'000});
  ASSERT_TRUE(degrees);
  EXPECT_NEAR(degrees->x, 173, 1e-9) << "easting 1 600 000 m is the central meridian";
  EXPECT_LT(degrees->y, 0);
}

TEST(Crs, a_compound_system_counts_by_its_plane_part) {
  const auto dutch = Crs::of_epsg(7415);
  ASSERT_TRUE(dutch) << dutch.error().detail;
  EXPECT_EQ((*dutch)->name(), "Amersfoort / RD New");
  EXPECT_EQ((*dutch)->code(), 28992);
  EXPECT_EQ((*dutch)->wkt().find("PROJCRS"), 0u);
}

TEST(Crs, systems_without_meters_on_a_plane_are_refused) {
  EXPECT_EQ(Crs::of_epsg(999'999).error().code, ErrorCode::not_found);
  EXPECT_EQ(Crs::of_epsg(4326).error().code, ErrorCode::invalid) << "degrees";
  EXPECT_EQ(Crs::of_epsg(2263).error().code, ErrorCode::invalid) << "feet";
  EXPECT_EQ(Crs::of_epsg(5703).error().code, ErrorCode::invalid) << "heights";
  EXPECT_EQ(Crs::of_epsg(2053).error().code, ErrorCode::invalid) << "westing and southing";
  EXPECT_EQ(Crs::of_epsg(3031).error().code, ErrorCode::invalid) << "both axes point to the north";
}

}  // namespace
}  // namespace strata::query
