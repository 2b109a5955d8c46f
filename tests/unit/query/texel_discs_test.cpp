// The neighborhoods of texels do not reach beyond their radius, where texels differ in size.
#include "query/regions/texel_discs.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>

#include "strata_dirs.h"
#include "support/cut_shapes.h"
#include "support/scan_atlas.h"

namespace strata::query {
namespace {

using test::Surface;

// How far neighborhoods reach beyond a texel outside of their radius.
struct Reach {
  double farthest = 0;  // as a part of the radius
  int beyond = 0;       // neighborhoods that reach farther than 1.1 times the radius
  int discs = 0;        // neighborhoods within a chart
};

Reach reach_of(const Surface& surface, double radius, std::uint32_t every) {
  const mesh::SurfaceMap& map = surface.map;
  const TexelDiscs discs(map, surface.graph, radius);
  const double size = mean_texel_size(map);
  const auto place = [&](std::uint32_t texel) {
    return glm::dvec3(map.position(texel / 64, static_cast<int>(texel % 64)));
  };
  Reach reach;
  std::uint32_t number = 0;
  test::for_each_surface_texel(map, [&](std::uint32_t texel) {
    if (number++ % every != 0) return;
    double farthest = 0;
    const bool is_disc = discs.for_each_chord(texel, [&](int y, int x0, int x1) {
      if (y < 0 || x0 < 0 || y >= map.resolution || x1 >= map.resolution) return false;
      std::uint32_t at = texel_in_atlas(map, x0, y);
      for (int x = x0; at != mesh::kNoNeighbour; ++x) {
        farthest = std::max(farthest, glm::distance(place(texel), place(at)));
        if (x == x1) return true;
        at = mesh::neighbour(map, surface.graph, at, mesh::Way::right);
      }
      return false;
    });
    if (!is_disc) return;
    const double part = (farthest - size) / radius;
    reach.discs += 1;
    reach.beyond += part > 1.1;
    reach.farthest = std::max(reach.farthest, part);
  });
  return reach;
}

TEST(TexelDiscs, keep_their_radius_on_scans) {
  for (const char* name : {"statue_nefertiti_70k.ply", "gargoyle_3dhop_50k_colour_normals.ply"}) {
    if (!std::filesystem::exists(std::filesystem::path(STRATA_TEST_DATA) / name))
      GTEST_SKIP() << "NO SCAN at " << STRATA_TEST_DATA << ": radii on scans are not tested";
    const auto& scan = test::scan_with_made_atlas(name);
    ASSERT_TRUE(scan) << scan.error().detail;
    Progress progress;
    Surface surface;
    surface.geometry = mesh::build_geometry(scan->mesh, scan->atlas);
    surface.map = *mesh::bake_surface_map(surface.geometry, 2048, progress);
    surface.graph = *mesh::build_texel_graph(surface.geometry, surface.map, progress);
    for (const double texels : {3.0, 10.0, 20.0}) {
      const Reach reach = reach_of(surface, texels * mean_texel_size(surface.map), 53);
      EXPECT_GT(reach.discs, 10'000);
      EXPECT_LT(reach.beyond, 0.005 * reach.discs) << name << ", " << texels << " texels";
      EXPECT_LT(reach.farthest, 1.3) << name << ", " << texels << " texels";
    }
  }
}

TEST(TexelDiscs, keep_their_radius_in_a_stretched_chart) {
  // The texels at one end are much longer than those at the other end.
  const test::Shape sheet{64, 64, [](double s, double t) { return glm::dvec3(s, t, 0); },
                          [](double s, double t) { return glm::dvec2(s * (0.2 + 2 * s * s), t); }};
  const Surface surface = test::cut_surface(sheet, {1, 1, 0, 1}, 512);
  const Reach reach = reach_of(surface, 20 * mean_texel_size(surface.map), 7);
  EXPECT_GT(reach.discs, 1000);
  EXPECT_LT(reach.farthest, 1.1);
}

}  // namespace
}  // namespace strata::query
