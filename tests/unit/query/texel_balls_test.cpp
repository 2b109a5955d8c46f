// Balls of texels, compared with a search of single texels on surfaces with many seams and on a
// fold.
#include "query/regions/texel_balls.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <vector>

#include "support/cut_shapes.h"

namespace strata::query {
namespace {

using Texels = std::set<std::uint32_t>;

Texels texels_of(std::span<const BlockTexels> blocks) {
  Texels texels;
  for (auto [slot, bits] : blocks)
    for (; bits != 0; bits &= bits - 1) {
      const bool fresh =
          texels.insert(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(bits))).second;
      EXPECT_TRUE(fresh);
    }
  return texels;
}

glm::dvec3 place_of(const test::Surface& surface, std::uint32_t texel) {
  return glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
}

Texels search(const test::Surface& surface, std::uint32_t start, double radius) {
  Texels found{start};
  std::vector<std::uint32_t> open{start};
  while (!open.empty()) {
    const std::uint32_t texel = open.back();
    open.pop_back();
    mesh::for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t other) {
      if (glm::distance(place_of(surface, other), place_of(surface, start)) > radius) return;
      if (found.insert(other).second) open.push_back(other);
    });
  }
  return found;
}

// Paths of steps to 8 neighbors, computed until no length changes.
std::map<std::uint32_t, double> paths(const test::Surface& surface, const Texels& ball,
                                      std::uint32_t start) {
  std::map<std::uint32_t, double> lengths{{start, 0}};
  for (bool changed = true; changed;) {
    changed = false;
    for (const std::uint32_t texel : ball) {
      if (!lengths.contains(texel)) continue;
      const double length = lengths[texel];
      const auto step_to = [&](std::uint32_t other) {
        if (!ball.contains(other)) return;
        const double path =
            length + glm::distance(place_of(surface, texel), place_of(surface, other));
        const auto [known, fresh] = lengths.try_emplace(other, path);
        if (!fresh && path >= known->second - 1e-9) return;
        known->second = path;
        changed = true;
      };
      mesh::for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t beside) {
        step_to(beside);
        mesh::for_each_neighbour(surface.map, surface.graph, beside, step_to);
      });
    }
  }
  return lengths;
}

// A sheet that is folded like a hairpin: two sides with a gap of 2, each 40 long.
test::Surface hairpin(const test::Cuts& cuts) {
  constexpr double kBend = std::numbers::pi, kLength = 80 + kBend;
  const test::Shape shape{128, 32,
                          [](double s, double t) {
                            const double at = s * kLength;
                            if (at < 40) return glm::dvec3(at, 60 * t, 0);
                            if (at > 40 + kBend)
                              return glm::dvec3(40 - (at - 40 - kBend), 60 * t, 2);
                            return glm::dvec3(40 + std::sin(at - 40), 60 * t,
                                              1 - std::cos(at - 40));
                          },
                          [](double s, double t) { return glm::dvec2(s * kLength, 60 * t); }};
  return test::cut_surface(shape, cuts, 256);
}

constexpr test::Cuts kHairpins[] = {{1, 1, 0, 1}, {3, 2, 0.7, 0.75}, {16, 8, 0.3, 0.6}};

TEST(TexelBalls, equal_a_search_of_texels) {
  for (const test::Cuts& cuts : kHairpins)
    for (const double radius : {0.5, 3.0, 9.0}) {
      const test::Surface surface = hairpin(cuts);
      TexelBalls balls(surface.map, surface.graph, radius, 100'000);
      std::size_t several_blocks = 0, number = 0;
      test::for_each_surface_texel(surface.map, [&](std::uint32_t start) {
        if (++number % 97 != 0) return;
        const auto blocks = balls.around(start);
        several_blocks += blocks.size() > 1 ? 1 : 0;
        const Texels found = texels_of(blocks);
        const Texels expected = search(surface, start, radius);
        // Texels at the rim differ by rounding.
        for (const std::uint32_t texel : expected)
          ASSERT_TRUE(found.contains(texel) ||
                      glm::distance(place_of(surface, texel), place_of(surface, start)) >
                          radius * 0.9999)
              << cuts.columns << ' ' << radius << ' ' << start;
        for (const std::uint32_t texel : found)
          ASSERT_LE(glm::distance(place_of(surface, texel), place_of(surface, start)),
                    radius * 1.0001);
        ASSERT_NEAR(static_cast<double>(found.size()), static_cast<double>(expected.size()), 4);
      });
      EXPECT_GT(several_blocks, 0u);
    }
}

TEST(TexelBalls, follow_paths_around_a_fold) {
  constexpr double kRadius = 9;
  for (const test::Cuts& cuts : kHairpins) {
    const test::Surface surface = hairpin(cuts);
    TexelBalls balls(surface.map, surface.graph, kRadius, 100'000);
    std::size_t number = 0, shorter = 0;
    test::for_each_surface_texel(surface.map, [&](std::uint32_t start) {
      if (++number % 1499 != 0) return;
      const Texels found = texels_of(balls.on_paths(start));
      const Texels ball = search(surface, start, kRadius);
      const auto lengths = paths(surface, ball, start);
      for (const auto& [texel, length] : lengths) {
        ASSERT_TRUE(found.contains(texel) || length > 1.0823 * kRadius) << length;
        ASSERT_TRUE(!found.contains(texel) || length < 1.0825 * kRadius) << length;
      }
      shorter += found.size() < ball.size() ? 1 : 0;
    });
    EXPECT_GT(shorter, 0u);
  }
}

TEST(TexelBalls, end_after_the_greatest_number_of_texels) {
  const test::Surface surface = hairpin({3, 2, 0.7, 0.75});
  TexelBalls balls(surface.map, surface.graph, 1000, 500);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t start) {
    if (start % 997 != 0) return;
    const Texels found = texels_of(balls.around(start));
    EXPECT_TRUE(found.contains(start));
    EXPECT_LE(found.size(), 500u + 64u);
  });
}

}  // namespace
}  // namespace strata::query
