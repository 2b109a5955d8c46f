// Outlines of labels: their distance from the grid, their areas, and that they are valid polygons
// with common borders.
#include <geos_c.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "figure/outlines/label_outlines.h"

namespace strata::figure {
namespace {

constexpr double kHalfCell = 0.5;

LabelGrid grid_of(int columns, int rows, const std::function<std::uint32_t(int, int)>& label) {
  LabelGrid grid{columns, rows, {}};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) grid.labels.push_back(label(x, y));
  return grid;
}

// Blobs of random size over noise of a random density, so that there are large areas, thin necks,
// single cells, and areas that touch at corners.
LabelGrid random_grid(std::mt19937& random, int side) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  struct Blob {
    glm::dvec2 at;
    double radius;
    std::uint32_t label;
  };
  std::vector<Blob> blobs;
  const double largest = number(1, side / 2.0);
  for (int i = 0; i < 12; ++i)
    blobs.push_back({{number(0, side), number(0, side)},
                     number(0.5, largest),
                     static_cast<std::uint32_t>(number(0, 4))});
  const double noise = number(0, 1) < 0.5 ? 0 : number(0, 0.5);
  return grid_of(side, side, [&](int x, int y) -> std::uint32_t {
    if (number(0, 1) < noise) return static_cast<std::uint32_t>(number(0, 4));
    for (const Blob& blob : blobs)
      if (glm::distance(glm::dvec2(x + 0.5, y + 0.5), blob.at) < blob.radius) return blob.label;
    return kNoLabel;
  });
}

LabelOutlines outlines_of(const LabelGrid& grid, double tolerance, double smallest = 0) {
  const Progress progress;
  auto found = label_outlines(grid, {tolerance, smallest}, progress);
  EXPECT_TRUE(found.has_value());
  return found ? std::move(*found) : LabelOutlines{};
}

double area_of(const OutlineRing& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice / 2);
}
double area_of(const std::vector<OutlinePolygon>& polygons) {
  double area = 0;
  for (const OutlinePolygon& polygon : polygons)
    for (std::size_t i = 0; i < polygon.rings.size(); ++i)
      area += (i == 0 ? 1 : -1) * area_of(polygon.rings[i]);
  return area;
}
double length_of(const OutlineRing& ring) {
  double length = 0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    length += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
  return length;
}

double distance_to(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double t = std::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(point, a + t * along);
}

struct Side {
  glm::dvec2 a, b;
};
// Returns the sides of cells between two labels, and the frame of labels.
std::vector<Side> sides_of(const LabelGrid& grid) {
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= grid.columns || y >= grid.rows
               ? kNoLabel
               : grid.labels[static_cast<std::size_t>(y * grid.columns + x)];
  };
  std::vector<Side> sides;
  for (int y = 0; y <= grid.rows; ++y)
    for (int x = 0; x <= grid.columns; ++x) {
      if (at(x, y) != at(x - 1, y)) sides.push_back({{x, y}, {x, y + 1}});
      if (at(x, y) != at(x, y - 1)) sides.push_back({{x, y}, {x + 1, y}});
    }
  return sides;
}
double distance_to(const glm::dvec2& point, const std::vector<Side>& sides) {
  double nearest = 1e9;
  for (const Side& side : sides) nearest = std::min(nearest, distance_to(point, side.a, side.b));
  return nearest;
}

bool is_inside(const std::vector<OutlinePolygon>& polygons, const glm::dvec2& point) {
  bool inside = false;
  for (const OutlinePolygon& polygon : polygons)
    for (const OutlineRing& ring : polygon.rings)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.y > point.y) != (b.y > point.y) &&
            point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y))
          inside = !inside;
      }
  return inside;
}

class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  // Returns the reason why a polygon is not a valid simple feature, or an empty text.
  std::string problem_of(const OutlinePolygon& polygon) const {
    std::vector<GEOSGeometry*> rings;
    for (const OutlineRing& ring : polygon.rings) {
      if (ring.size() < 3) return "A ring has fewer than three points";
      GEOSCoordSequence* points =
          GEOSCoordSeq_create_r(handle_, static_cast<unsigned>(ring.size() + 1), 2);
      for (std::size_t i = 0; i <= ring.size(); ++i)
        GEOSCoordSeq_setXY_r(handle_, points, static_cast<unsigned>(i), ring[i % ring.size()].x,
                             ring[i % ring.size()].y);
      rings.push_back(GEOSGeom_createLinearRing_r(handle_, points));
    }
    GEOSGeometry* geometry = GEOSGeom_createPolygon_r(handle_, rings[0], rings.data() + 1,
                                                      static_cast<unsigned>(rings.size() - 1));
    char* reason = GEOSisValidReason_r(handle_, geometry);
    std::string text = reason;
    GEOSFree_r(handle_, reason);
    GEOSGeom_destroy_r(handle_, geometry);
    return text == "Valid Geometry" ? "" : text;
  }

 private:
  GEOSContextHandle_t handle_;
};

TEST(LabelOutlines, RandomGridsGiveValidPolygonsWithinTheTolerance) {
  std::mt19937 random(7);
  const Geos geos;
  double longest = 0;
  std::size_t most_points = 0;
  for (int number = 0; number < 160; ++number) {
    const LabelGrid grid = random_grid(random, 8 + number % 40);
    const double tolerance = std::array{0.3, 1.0, 2.5, 6.0}[static_cast<std::size_t>(number % 4)];
    SCOPED_TRACE("grid " + std::to_string(number));
    const LabelOutlines outlines = outlines_of(grid, tolerance);
    const std::vector<Side> sides = sides_of(grid);
    std::set<std::uint32_t> labels(grid.labels.begin(), grid.labels.end());
    labels.erase(kNoLabel);
    EXPECT_EQ(outlines.areas.size(), labels.size());
    for (const auto& [label, polygons] : outlines.areas)
      for (const OutlinePolygon& polygon : polygons) {
        EXPECT_EQ(geos.problem_of(polygon), "");
        for (const OutlineRing& ring : polygon.rings) {
          most_points = std::max(most_points, ring.size());
          for (std::size_t i = 0; i < ring.size(); ++i)
            for (const double t : {0.0, 0.25, 0.5, 0.75}) {
              const glm::dvec2 point = glm::mix(ring[i], ring[(i + 1) % ring.size()], t);
              longest = std::max(longest, distance_to(point, sides) - tolerance);
            }
        }
      }
    ASSERT_LE(longest, kHalfCell + 1e-9);
    // Each cell is in one area at most, and in its own if it is far enough from a border.
    for (int y = 0; y < grid.rows; ++y)
      for (int x = 0; x < grid.columns; ++x) {
        // Not exactly on a border that is a diagonal of cells.
        const glm::dvec2 middle(x + 0.5 + 1.3e-6, y + 0.5 - 0.7e-6);
        std::vector<std::uint32_t> there;
        for (const auto& [label, polygons] : outlines.areas)
          if (is_inside(polygons, middle)) there.push_back(label);
        ASSERT_LE(there.size(), 1u) << x << " " << y;
        if (distance_to(middle, sides) <= tolerance + kHalfCell + 1e-5) continue;
        const std::uint32_t label = grid.labels[static_cast<std::size_t>(y * grid.columns + x)];
        EXPECT_EQ(there.empty() ? kNoLabel : there[0], label) << x << " " << y;
      }
  }
  EXPECT_GT(longest, -0.3) << "the tolerance is not used";
  EXPECT_GT(most_points, 30u);
}

TEST(LabelOutlines, NeighborsShareTheirBorderExactly) {
  std::mt19937 random(11);
  for (int number = 0; number < 40; ++number) {
    LabelGrid grid = random_grid(random, 40);
    for (std::uint32_t& label : grid.labels) ++label;  // no cell is empty
    double sum = 0;
    for (const auto& [label, polygons] : outlines_of(grid, 2).areas) sum += area_of(polygons);
    EXPECT_NEAR(sum, 40 * 40, 1e-6) << "grid " << number;
  }
}

TEST(LabelOutlines, ADiscHasItsAreaAndLength) {
  for (const double radius : {6.0, 20.0, 60.0, 200.0}) {
    const int side = static_cast<int>(2 * radius) + 9;
    const glm::dvec2 middle(side / 2.0 + 0.21, side / 2.0 - 0.37);
    const LabelOutlines outlines = outlines_of(
        grid_of(side, side,
                [&](int x, int y) -> std::uint32_t {
                  return glm::distance(glm::dvec2(x + 0.5, y + 0.5), middle) < radius ? 5
                                                                                      : kNoLabel;
                }),
        1);
    ASSERT_EQ(outlines.areas.size(), 1u);
    const auto& polygons = outlines.areas.at(5);
    ASSERT_EQ(polygons.size(), 1u);
    ASSERT_EQ(polygons[0].rings.size(), 1u);
    const OutlineRing& ring = polygons[0].rings[0];
    EXPECT_NEAR(area_of(ring), M_PI * radius * radius, 2 * M_PI * radius * 0.15) << radius;
    // The sides of the cells would be 27 % longer.
    EXPECT_NEAR(length_of(ring), 2 * M_PI * radius, 2 * M_PI * radius * 0.01 + 0.2) << radius;
    for (const glm::dvec2& point : ring)
      EXPECT_NEAR(glm::distance(point, middle), radius, 0.6) << radius;
    // The outline is smooth: it turns by a few degrees at each point.
    for (std::size_t i = 0; radius >= 20 && i < ring.size(); ++i) {
      const glm::dvec2 before = ring[(i + 1) % ring.size()] - ring[i],
                       after = ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()];
      EXPECT_GT(glm::dot(glm::normalize(before), glm::normalize(after)), std::cos(0.3)) << radius;
    }
  }
}

TEST(LabelOutlines, AStraightDiagonalIsStraight) {
  for (const double slope : {0.03, 0.1, 0.37, 0.5, 1.0, 1.9}) {
    const int side = 120;
    const auto line = [&](double x) { return 10 + slope * x; };
    const LabelOutlines outlines = outlines_of(
        grid_of(side, side,
                [&](int x, int y) -> std::uint32_t { return y + 0.5 < line(x + 0.5) ? 1 : 2; }),
        1);
    // The points of the common border are those of both areas, except the frame.
    std::set<std::pair<double, double>> border;
    for (const auto& polygon : outlines.areas.at(2))
      for (const auto& ring : polygon.rings)
        for (const glm::dvec2& point : ring)
          if (point.x > 3 && point.x < side - 3 && point.y > 3 && point.y < side - 3)
            border.emplace(point.x, point.y);
    EXPECT_LE(border.size(), 24u) << slope;  // the grid has a corner at each cell
    for (const auto& [x, y] : border)
      EXPECT_LE(std::abs(y - line(x)) / std::hypot(1, slope), 0.75) << slope;
    EXPECT_NEAR(area_of(outlines.areas.at(1)) + area_of(outlines.areas.at(2)), side * side, 1e-6);
  }
}

TEST(LabelOutlines, AreasThatTouchAtACornerStaySeparate) {
  // A ring of cells whose hole touches the outside at a corner of cells.
  const std::vector<std::string> rows{".......", ".####..", ".#..#..",
                                      ".#..#..", ".###...", "......."};
  const LabelOutlines outlines = outlines_of(
      grid_of(7, 6,
              [&](int x, int y) -> std::uint32_t {
                return rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#'
                           ? 1
                           : kNoLabel;
              }),
      1);
  const auto& polygons = outlines.areas.at(1);
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_EQ(polygons[0].rings.size(), 2u);
  EXPECT_EQ(Geos().problem_of(polygons[0]), "");
}

TEST(LabelOutlines, SmallPiecesBecomeAPartOfTheirNeighbor) {
  const auto label = [](int x, int y) -> std::uint32_t {
    if (x == 5 && y == 5) return 3;                        // one cell in an area
    if (x >= 20 && x < 23 && y >= 20 && y < 23) return 4;  // nine cells
    if (x == 30 && y == 10) return kNoLabel;               // a gap of one cell
    return x < 15 ? 1 : 2;
  };
  const LabelOutlines all = outlines_of(grid_of(40, 40, label), 0.5);
  EXPECT_EQ(all.areas.size(), 4u);
  EXPECT_EQ(all.areas.at(2).at(0).rings.size(), 3u);
  EXPECT_EQ(all.dropped_pieces, 0u);
  const LabelOutlines some = outlines_of(grid_of(40, 40, label), 0.5, 4);
  EXPECT_EQ(some.areas.size(), 3u);
  EXPECT_EQ(some.areas.at(1).at(0).rings.size(), 1u);
  EXPECT_EQ(some.areas.at(2).at(0).rings.size(), 2u);
  EXPECT_EQ(some.dropped_pieces, 1u);
  EXPECT_EQ(some.dropped_area, 1);
}

// A large area that has very many small pieces. If each of them filled the whole area, this would
// take hours.
TEST(LabelOutlines, NoiseHasNoSmallPieces) {
  constexpr int kSide = 1500;
  constexpr std::size_t kSmallest = 9;
  std::mt19937 random(7);
  const LabelGrid noise = grid_of(kSide, kSide, [&](int, int) -> std::uint32_t {
    return std::uniform_int_distribution(0, 9)(random) < 7 ? 1 : 2;
  });
  const Progress progress;
  const auto faces = label_faces(noise, kSmallest, progress);
  ASSERT_TRUE(faces.has_value());
  EXPECT_GT(faces->dropped_faces, 100'000u);
  std::vector<std::size_t> sizes(faces->label.size());
  for (const std::uint32_t face : faces->face) ++sizes[face];
  for (std::size_t face = 1; face < sizes.size(); ++face) EXPECT_GE(sizes[face], kSmallest);
}

TEST(LabelOutlines, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  const auto found = label_outlines(grid_of(4, 4, [](int, int) { return 1u; }), {}, progress);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::cancelled);
}

TEST(LabelOutlines, RefusesNoise) {
  OutlineSettings settings;
  settings.most_sides = 1000;
  const auto checks = [](int x, int y) -> std::uint32_t { return (x + y) % 2; };
  EXPECT_TRUE(label_outlines(grid_of(20, 20, checks), settings, Progress()));
  const auto found = label_outlines(grid_of(30, 30, checks), settings, Progress());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::invalid);
}

}  // namespace
}  // namespace strata::figure
