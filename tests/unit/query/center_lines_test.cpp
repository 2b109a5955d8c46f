// The lengths and widths of drawn cracks, with and without seams.
#include "query/regions/center_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/progress.h"
#include "query/regions/texel_discs.h"
#include "support/cut_shapes.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::Surface;

constexpr double kPi = std::numbers::pi;
using Path = std::vector<glm::dvec2>;

// A drawing of paths with a round pen.
struct Drawing {
  std::vector<Path> paths;
  double width = 3;

  double length() const {
    double sum = 0;
    for (const Path& path : paths)
      for (std::size_t i = 1; i < path.size(); ++i) sum += glm::distance(path[i - 1], path[i]);
    return sum;
  }
  bool covers(const glm::dvec2& at) const {
    for (const Path& path : paths)
      for (std::size_t i = 1; i < path.size(); ++i) {
        const glm::dvec2 side = path[i] - path[i - 1];
        const double along =
            std::clamp(glm::dot(at - path[i - 1], side) / glm::dot(side, side), 0.0, 1.0);
        if (glm::distance(at, path[i - 1] + along * side) <= width / 2) return true;
      }
    return false;
  }
};

using Covers = std::function<bool(glm::dvec3)>;
Pieces pieces_of(const Surface& surface, const Covers& covers) {
  const std::size_t slots = surface.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (covers(surface.geometry.origin +
               glm::dvec3(surface.map.position(texel / 64, int(texel % 64)))))
      values.set(texel, {1, true});
  });
  Progress progress;
  PieceRequest request;
  request.max_pieces = 1000;
  return *find_pieces(values, request, surface.map, surface.graph, progress);
}
std::vector<LineMeasures> measure(const Surface& surface, const Pieces& pieces, int threads = 2) {
  Progress progress;
  return *measure_lines(pieces, surface.map, surface.graph, progress, threads);
}

const std::vector<Surface>& sheets() {
  static const std::vector<Surface> sheets = [] {
    std::vector<Surface> made;
    for (const test::SheetCuts& cuts : std::vector<test::SheetCuts>{
             {}, {{96}, {64}}, {{40, 96, 104, 152}, {24, 64}}, {{96}, {}, 30}})
      made.push_back(test::cut_sheet(cuts));
    return made;
  }();
  return sheets;
}

// Expects one piece with these measures, in texels.
void expect_line(const Drawing& drawing, double length, const std::string& what,
                 double wider_at_corners = 0) {
  for (std::size_t i = 0; i < sheets().size(); ++i) {
    const Surface& sheet = sheets()[i];
    const Pieces pieces =
        pieces_of(sheet, [&](glm::dvec3 at) { return drawing.covers(glm::dvec2(at)); });
    ASSERT_EQ(pieces.list.size(), 1u) << what << " on sheet " << i;
    const LineMeasures line = measure(sheet, pieces).front();
    EXPECT_NEAR(line.length, length, 0.05 * length) << what << " on sheet " << i;
    EXPECT_NEAR(line.width, drawing.width, std::max(0.1 * drawing.width, 0.5))
        << what << " on sheet " << i;
    EXPECT_GT(line.greatest_width, drawing.width - 1) << what << " on sheet " << i;
    EXPECT_LT(line.greatest_width, drawing.width + wider_at_corners + 1.5)
        << what << " on sheet " << i;
  }
}

Path straight(double angle, double length) {
  const glm::dvec2 center(96.3, 64.2),
      half = length / 2 * glm::dvec2(std::cos(angle), std::sin(angle));
  return {center - half, center + half};
}
Path arc(const glm::dvec2& center, double radius, double from, double to) {
  Path path;
  for (int i = 0; i <= 200; ++i) {
    const double angle = from + (to - from) * i / 200;
    path.push_back(center + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return path;
}

TEST(CenterLines, of_straight_cracks_are_exact_at_all_angles) {
  for (const double width : {2.0, 3.0, 4.0, 7.0})
    for (int i = 0; i < 12; ++i) {
      const Drawing drawing{{straight(i * kPi / 12 + 0.02, 100)}, width};
      expect_line(drawing, 100 + width,
                  "width " + std::to_string(width) + " angle " + std::to_string(i));
    }
}

TEST(CenterLines, of_arcs_zigzags_and_rings_are_exact) {
  for (const double width : {2.0, 3.0, 6.0}) {
    for (const double radius : {15.0, 25.0, 45.0}) {
      const std::string what =
          " radius " + std::to_string(radius) + " width " + std::to_string(width);
      const Drawing half{{arc({95.5, 62}, radius, 0.3, 0.3 + kPi)}, width},
          ring{{arc({95.5, 62}, radius, 0, 2 * kPi)}, width};
      expect_line(half, half.length() + width, "arc" + what);
      expect_line(ring, ring.length(), "ring" + what);
    }
    Path zigzag;
    for (int i = 0; i <= 6; ++i) zigzag.emplace_back(24 + 24 * i, i % 2 == 0 ? 52 : 74);
    const Drawing drawing{{zigzag}, width};
    // The center line passes a corner on its inner side.
    expect_line(drawing, drawing.length() + width, "zigzag width " + std::to_string(width), 1);
  }
}

TEST(CenterLines, count_their_branches) {
  for (const double width : {2.0, 3.0, 5.0}) {
    Drawing fork{{}, width}, cross{{straight(0.3, 100), straight(1.9, 90)}, width};
    for (const double angle : {0.4, 2.3, 4.6})
      fork.paths.push_back(
          {{96, 64}, glm::dvec2(96, 64) + 45.0 * glm::dvec2(std::cos(angle), std::sin(angle))});
    expect_line(fork, 3 * 45 + 1.5 * width, "fork width " + std::to_string(width), 2);
    expect_line(cross, 190 + width, "cross width " + std::to_string(width), 2);
  }
}

TEST(CenterLines, of_adjacent_pieces_are_separate) {
  // Lines of two values next to each other, one texel wide each.
  for (const Surface& sheet : {sheets()[0], sheets()[2]}) {
    const std::size_t slots = sheet.map.block_of_slot.size();
    SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      const glm::ivec2 at = test::sheet_place(sheet, texel);
      if (at.x >= 20 && at.x < 120 && (at.y == 60 || at.y == 61))
        values.set(texel, {at.y == 60 ? 3u : 4u, true});
    });
    Progress progress;
    PieceRequest request;
    request.max_pieces = 10;
    request.connection = Connection::corners;
    const Pieces pieces = *find_pieces(values, request, sheet.map, sheet.graph, progress);
    ASSERT_EQ(pieces.list.size(), 2u);
    for (const LineMeasures& line : measure(sheet, pieces)) {
      EXPECT_NEAR(line.length, 100, 0.5);
      EXPECT_NEAR(line.width, 1, 0.01);
    }
  }
}

TEST(CenterLines, of_thin_diagonal_cracks_are_one_piece) {
  const Surface& sheet = sheets()[1];
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    if (at.x == at.y + 32 && at.y >= 30 && at.y < 100) values.set(texel, {1, true});
  });
  Progress progress;
  PieceRequest request;
  request.max_pieces = 100;
  EXPECT_EQ(find_pieces(values, request, sheet.map, sheet.graph, progress)->list.size(), 70u);
  request.connection = Connection::corners;
  Pieces pieces = *find_pieces(values, request, sheet.map, sheet.graph, progress);
  ASSERT_EQ(pieces.list.size(), 1u);
  EXPECT_NEAR(measure(sheet, pieces).front().length, 70 * std::sqrt(2), 0.05 * 70);
}

TEST(CenterLines, leave_out_bumps_and_holes_of_the_width) {
  const auto covers = [](glm::dvec3 p) {
    const glm::dvec2 at(p);
    const Drawing line{{{{30, 64}, {150, 60}}}, 6};
    const double bump = std::min(glm::distance(at, {80, 67}), glm::distance(at, {120, 58}));
    const bool hole = glm::distance(at, {60, 63}) < 1.2;
    return (line.covers(at) || bump < 3) && !hole;
  };
  for (const Surface& sheet : sheets()) {
    const Pieces pieces = pieces_of(sheet, covers);
    ASSERT_EQ(pieces.list.size(), 1u);
    EXPECT_NEAR(measure(sheet, pieces).front().length, 126, 0.05 * 126);
  }
}

TEST(CenterLines, of_rough_cracks_follow_the_middle) {
  // The border of a hand-drawn crack moves by up to a texel.
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-1, 1);
    std::vector<double> above(200), below(200);
    for (std::size_t i = 0; i < 200; ++i) above[i] = move(random), below[i] = move(random);
    const auto covers = [&](glm::dvec3 p) {
      if (p.x < 20 || p.x > 170) return false;
      const auto column = std::size_t(p.x);
      return p.y < 64 + 0.1 * p.x + 3 + above[column] && p.y > 64 + 0.1 * p.x - 3 - below[column];
    };
    const Pieces pieces = pieces_of(sheets()[0], covers);
    ASSERT_EQ(pieces.list.size(), 1u);
    const LineMeasures line = measure(sheets()[0], pieces).front();
    EXPECT_NEAR(line.length, 150 * std::hypot(1, 0.1), 0.05 * 150);
    EXPECT_NEAR(line.width, 6, 0.6);
  }
}

TEST(CenterLines, of_blobs_are_as_long_as_the_blobs) {
  const Surface& sheet = sheets()[1];
  const Pieces pieces = pieces_of(sheet, [](glm::dvec3 p) {
    const glm::dvec2 at(p);
    return glm::distance(at, {50, 60}) < 15 ||                     // a disc
           (at.x > 85 && at.x < 109 && at.y > 50 && at.y < 74) ||  // a square across seams
           (std::floor(at.x) == 150 && std::floor(at.y) == 30) ||  // one texel
           (at.x > 160 && at.x < 162 && at.y > 30 && at.y < 32);   // four texels
  });
  ASSERT_EQ(pieces.list.size(), 4u);
  const auto lines = measure(sheet, pieces);
  const double right[] = {30, 24, 2, 1};  // the largest piece comes first
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(lines[i].length, right[i], std::max(1.0, 0.15 * right[i])) << i;
    EXPECT_NEAR(lines[i].greatest_width, right[i], std::max(1.6, 0.16 * right[i])) << i;
    EXPECT_NEAR(lines[i].length * lines[i].width, pieces.list[i].area, 1e-6 * pieces.list[i].area);
  }
}

TEST(CenterLines, are_measured_along_a_curved_surface_on_any_atlas) {
  // A line that winds around a tube of radius 1, and across seams.
  const test::Shape tube{
      64, 64,
      [](double s, double t) { return glm::dvec3(std::cos(5 * s), std::sin(5 * s), 4 * t); },
      [](double s, double t) { return glm::dvec2(5 * s, 4 * t); }};
  for (const test::Cuts cuts :
       {test::Cuts{1, 1, 0, 1}, test::Cuts{3, 4}, test::Cuts{2, 2, 1, 0.6}}) {
    const Surface surface = test::cut_surface(tube, cuts, 512);
    const double texel = mean_texel_size(surface.map);
    const Drawing drawing{{{{0.6, 0.5}, {2.5, 3.4}, {4.4, 2.2}}}, 6 * texel};
    const Pieces pieces = pieces_of(surface, [&](glm::dvec3 at) {
      const double angle = std::atan2(at.y, at.x);
      return drawing.covers({angle < 0 ? angle + 2 * kPi : angle, at.z});
    });
    ASSERT_EQ(pieces.list.size(), 1u);
    const LineMeasures line = measure(surface, pieces).front();
    const double right = drawing.length() + drawing.width;
    EXPECT_NEAR(line.length, right, 0.05 * right);
    EXPECT_NEAR(line.width, drawing.width, 0.1 * drawing.width);
    EXPECT_NEAR(line.greatest_width, drawing.width, 2 * texel);
  }
}

TEST(CenterLines, do_not_depend_on_threads_and_can_be_cancelled) {
  const Surface& sheet = sheets()[1];
  const Drawing drawing{{straight(0.3, 100), straight(1.9, 90)}, 5};
  const Pieces pieces =
      pieces_of(sheet, [&](glm::dvec3 at) { return drawing.covers(glm::dvec2(at)); });
  EXPECT_EQ(measure(sheet, pieces, 1).front().length, measure(sheet, pieces, 4).front().length);
  Progress progress;
  progress.cancel();
  EXPECT_EQ(measure_lines(pieces, sheet.map, sheet.graph, progress).error().code,
            ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
