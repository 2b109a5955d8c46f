#include "mesh/atlas/packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mesh/atlas/canvas.h"
#include "mesh/atlas/chart_mask.h"

namespace strata::mesh {
namespace {

Outline polygon(const std::vector<glm::vec2>& corners) {
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    outline.segments.push_back(corners[i]);
    outline.segments.push_back(corners[(i + 1) % corners.size()]);
    outline.size = glm::max(outline.size, corners[i]);
  }
  return outline;
}

// Returns a square ring with this outer and inner side. The inner rim has the opposite direction.
Outline ring(float outer, float inner) {
  Outline outline = polygon({{0, 0}, {outer, 0}, {outer, outer}, {0, outer}});
  const float a = (outer - inner) / 2, b = a + inner;
  const Outline hole = polygon({{a, a}, {a, b}, {b, b}, {b, a}});
  outline.segments.insert(outline.segments.end(), hole.segments.begin(), hole.segments.end());
  return outline;
}

std::vector<Outline> many_shapes() {
  std::vector<Outline> outlines;
  for (int i = 0; i < 40; ++i) {
    const float size = 0.2f + 0.05f * float(i % 7), slant = 0.05f * float(i % 5);
    outlines.push_back(polygon({{0, 0}, {size, slant}, {size + slant, 2 * size}, {slant, size}}));
  }
  outlines.push_back(ring(1.5f, 1.2f));
  return outlines;
}

std::vector<std::vector<bool>> texels_of(const ChartMask& mask) {
  std::vector<std::vector<bool>> texels(mask.height, std::vector<bool>(mask.width, false));
  for (int y = 0; y < mask.height; ++y)
    for (const auto run : mask.row(y))
      for (int x = run.begin; x < run.end; ++x) texels[y][x] = true;
  return texels;
}

TEST(mesh_packing, a_mask_holds_the_texels_that_the_shape_touches_and_no_hole) {
  const auto shape = make_shape(ring(1, 0.5f), 40.0 - 10 * kNear);
  ASSERT_EQ(shape.box, glm::ivec2(40));
  const auto texels = texels_of(shape.turned[0]);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool in_hole = x >= 10 && x < 29 && y >= 10 && y < 29;
      EXPECT_EQ(texels[y][x], !in_hole) << x << " " << y;
    }
}

// Quarter turns move points on a line between texels to the other side of that line.
TEST(mesh_packing, a_mask_holds_the_texels_of_the_laid_out_shape_in_every_turn) {
  const double density = 16;
  const Outline steps =
      polygon({{0, 0}, {1, 0}, {1, 0.25f}, {0.5f, 0.25f}, {0.5f, 0.75f}, {0, 0.75f}});
  const auto shape = make_shape(steps, density);
  for (int turn = 0; turn < 4; ++turn) {
    const Placement placement{turn, {0, 0}, shape.box};
    const auto texels = texels_of(shape.turned[turn]);
    for (std::size_t i = 0; i < steps.segments.size(); i += 2)
      for (int k = 0; k <= 64; ++k) {
        const auto p =
            glm::mix(glm::dvec2(steps.segments[i]), glm::dvec2(steps.segments[i + 1]), k / 64.0);
        const auto at = placement.to_atlas(p * density + kNear);
        EXPECT_TRUE(texels.at(std::size_t(at.y)).at(std::size_t(at.x)))
            << turn << ": " << at.x << " " << at.y;
      }
  }
}

TEST(mesh_packing, a_turned_mask_holds_where_the_turn_sends_each_texel) {
  const auto shape = make_shape(polygon({{0, 0}, {1, 0.1f}, {0.7f, 0.6f}, {0.1f, 0.5f}}), 53);
  const auto upright = texels_of(shape.turned[0]);
  for (int turn = 1; turn < 4; ++turn) {
    const Placement placement{turn, {0, 0}, shape.box};
    const auto turned = texels_of(shape.turned[turn]);
    for (int y = 0; y < shape.box.y; ++y)
      for (int x = 0; x < shape.box.x; ++x) {
        const auto centre = placement.to_atlas({x + 0.5, y + 0.5});
        EXPECT_EQ(turned.at(int(centre.y)).at(int(centre.x)), upright[y][x])
            << turn << ": " << x << " " << y;
      }
  }
}

TEST(mesh_packing, a_canvas_finds_the_lowest_place_that_a_search_of_all_places_finds) {
  constexpr int kSide = 100, kGap = 2;
  Canvas canvas(kSide, kGap);
  std::vector<std::vector<bool>> taken(kSide, std::vector<bool>(kSide, false));
  for (const Outline& outline : many_shapes()) {
    const auto mask = make_shape(outline, 23).turned[0];
    const auto texels = texels_of(mask);
    const auto is_free = [&](int x0, int y0) {
      for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x)
          if (texels[y][x] && taken[y0 + y][x0 + x]) return false;
      return true;
    };
    Canvas::Spot expected;
    for (int y = 1; y + mask.height < kSide && expected.x < 0; ++y)
      for (int x = 1; x + mask.width < kSide && expected.x < 0; ++x)
        if (is_free(x, y)) expected = {x, y};
    const auto spot = canvas.find(mask, 0, kSide);
    ASSERT_EQ(spot.x, expected.x);
    if (spot.x < 0) continue;
    ASSERT_EQ(spot.y, expected.y);
    canvas.put(mask, spot);
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x)
        for (int dy = -kGap; texels[y][x] && dy <= kGap; ++dy)
          for (int dx = -kGap; dx <= kGap; ++dx) {
            const int ty = spot.y + y + dy, tx = spot.x + x + dx;
            if (tx >= 0 && ty >= 0 && tx < kSide && ty < kSide) taken[ty][tx] = true;
          }
  }
}

TEST(mesh_packing, keeps_the_gap_between_all_charts) {
  constexpr int kSide = 128, kGap = 3;
  const auto outlines = many_shapes();
  const auto packing = pack_densely(outlines, kSide, kGap, Progress{});
  ASSERT_TRUE(packing);
  std::vector<std::vector<int>> owner(kSide, std::vector<int>(kSide, -1));
  for (int c = 0; c < int(outlines.size()); ++c) {
    const auto& placement = packing->placements[c];
    const auto texels = texels_of(
        make_shape(outlines[c], packing->texels_per_unit).turned[placement.quarter_turns]);
    for (int y = 0; y < int(texels.size()); ++y)
      for (int x = 0; x < int(texels[y].size()); ++x)
        if (texels[y][x]) owner.at(placement.corner.y + y).at(placement.corner.x + x) = c;
  }
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int dy = 0; owner[y][x] >= 0 && dy <= kGap && y + dy < kSide; ++dy)
        for (int dx = -kGap; dx <= kGap; ++dx) {
          if (x + dx < 0 || x + dx >= kSide || owner[y + dy][x + dx] < 0) continue;
          ASSERT_EQ(owner[y + dy][x + dx], owner[y][x]) << x << " " << y;
        }
}

TEST(mesh_packing, lays_small_charts_into_the_hole_of_a_large_one) {
  std::vector<Outline> outlines{ring(1.5f, 1.2f)};
  for (int i = 0; i < 4; ++i)
    outlines.push_back(polygon({{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}}));
  const auto packing = pack_densely(outlines, 128, 2, Progress{});
  ASSERT_TRUE(packing);
  EXPECT_GT(packing->texels_per_unit, 128 / (1.5 + 0.5)) << "no denser than beside each other";
}

TEST(mesh_packing, does_not_depend_on_the_number_of_threads) {
  const auto outlines = many_shapes();
  const auto one = pack_densely(outlines, 256, 4, Progress{}, 1),
             two = pack_densely(outlines, 256, 4, Progress{}, 2);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->texels_per_unit, two->texels_per_unit);
  for (std::size_t c = 0; c < outlines.size(); ++c) {
    EXPECT_EQ(one->placements[c].corner, two->placements[c].corner);
    EXPECT_EQ(one->placements[c].quarter_turns, two->placements[c].quarter_turns);
  }
}

// Returns triangles of many sizes, each one different.
std::vector<Outline> many_triangles(int count) {
  std::vector<Outline> outlines;
  for (int i = 0; i < count; ++i) {
    const float width = 1 + 0.61803f * float(i % 89) / 40,
                height = 0.5f + 0.41421f * float(i % 71) / 40;
    outlines.push_back(
        polygon({{0, 0}, {width, 0}, {0.73205f * width * float(i % 13) / 13, height}}));
  }
  return outlines;
}

TEST(mesh_packing, works_little_more_for_each_of_many_charts_than_for_each_of_few) {
  const auto work_of_each = [](int count) {
    const auto packing = pack_densely(many_triangles(count), 1024, 2, Progress{});
    EXPECT_TRUE(packing) << count;
    return packing ? double(packing->work) / count : 0;
  };
  const double of_few = work_of_each(1000), of_many = work_of_each(16'000);
  EXPECT_GT(of_few, 0);
  EXPECT_LT(of_many, 2 * of_few) << "16 times the charts took more than 32 times the work";
}

TEST(mesh_packing, the_first_step_foretells_the_density_of_the_second) {
  const auto outlines = many_triangles(150);
  auto start = begin_packing(outlines, 512, 2, Progress{});
  ASSERT_TRUE(start);
  const double expected = start->expected_density;
  const auto packing = finish_packing(outlines, 512, 2, std::move(*start), Progress{});
  ASSERT_TRUE(packing);
  EXPECT_NEAR(packing->texels_per_unit / expected, 1, 0.08);
}

TEST(mesh_packing, charts_of_a_single_texel_each_are_packed_or_refused_but_not_shrunk_for_ever) {
  // By their area including the gaps, 600 charts would fit. But at most 24 charts fit next to each
  // other between the rims.
  std::vector<Outline> outlines(600);
  for (auto& outline : outlines) {
    outline.segments = {{0, 0}, {1, 1}};
    outline.size = {1, 1};
  }
  EXPECT_FALSE(pack_densely(outlines, 72, 2, Progress{}));
  outlines.resize(400);
  const auto packing = pack_densely(outlines, 72, 2, Progress{});
  ASSERT_TRUE(packing);
  EXPECT_EQ(packing->placements.size(), 400u);
}

}  // namespace
}  // namespace strata::mesh
