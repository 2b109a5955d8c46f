// Places on another model: two sheets with different meshes, atlases and units.
#include "jobs/counterparts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/atlas/atlas.h"
#include "mesh/texels/surface_map.h"
#include "query/regions/surface_values.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::jobs {
namespace {

constexpr int kResolution = 512;
constexpr CounterpartTolerance kTolerance{0.01, 0.5f};

// A square of 1 m with the lower left corner at `left`, in units of `metres`, at the height `z` in
// meters.
struct Sheet {
  test::Surface surface;
  ComparedSide side;

  Sheet(int cells, double left, double z, double metres, bool swaps_uvs = false)
      : surface(make(cells, left, z, metres, swaps_uvs)),
        side(std::make_shared<const mesh::Geometry>(surface.geometry),
             std::make_shared<const mesh::SearchTree>(
                 std::make_shared<const mesh::Geometry>(surface.geometry)),
             metres) {}

  static test::Surface make(int cells, double left, double z, double metres, bool swaps_uvs) {
    mesh::TriangleMesh mesh = test::open_grid(cells, 0);
    mesh::Atlas atlas;
    for (const auto& uv : mesh.corner_uvs)
      atlas.corner_uvs.push_back(swaps_uvs ? glm::vec2(1 - uv.y, uv.x) : glm::vec2(uv));
    for (auto& p : mesh.positions) p = glm::dvec3(p.x + left, p.y, z) / metres;
    Progress progress;
    test::Surface surface;
    surface.geometry = mesh::build_geometry(mesh, atlas);
    surface.map = *mesh::bake_surface_map(surface.geometry, kResolution, progress);
    return surface;
  }
  glm::dvec3 at(std::uint32_t texel) const {  // in meters
    return (surface.geometry.origin +
            glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)))) *
           side.metres;
  }
};

Layer layer_of_columns() {
  Layer layer;
  layer.type = ValueType::u8;
  layer.resolution = kResolution;
  return layer;
}
// The number of the column of a tenth of the sheet, from 1. The last one is not painted.
int column(double x) { return std::min(9, static_cast<int>(std::floor(x * 10)) + 1); }

Counterparts found(const Sheet& here, const Sheet& there,
                   const std::vector<std::uint64_t>* only = nullptr) {
  Progress progress;
  auto result =
      find_counterparts(here.side, there.side, kTolerance, kResolution, progress, 0, 1, only);
  EXPECT_TRUE(result);
  return result ? std::move(*result) : Counterparts{};
}

TEST(Counterparts, give_the_value_at_the_same_place_in_another_atlas_and_unit) {
  const Sheet now(7, 0, 0, 0.001), then(11, 0, 0.004, 1, true);
  const TileMap tiles = test::layer_of(then.surface.map, [&](glm::vec3 p) {
    const double x = (then.surface.geometry.origin + glm::dvec3(p)).x;
    return x < 0.9 ? column(x) : 0;
  });
  const Counterparts places = found(now, then);
  Progress progress;
  const auto values = values_at(places, layer_of_columns(), tiles, progress);
  ASSERT_TRUE(values);
  const auto layer = query::read_surface_values(*values, ValueType::u8, now.surface.map);
  int count = 0;
  test::for_each_surface_texel(now.surface.map, [&](std::uint32_t texel) {
    ASSERT_TRUE(places.has(texel));
    const double x = now.at(texel).x;
    if (std::abs(x * 10 - std::round(x * 10)) < 0.05) return;  // at the border of two columns
    const auto value = layer.of(texel);
    ASSERT_EQ(value.valid, x < 0.9) << x;
    ASSERT_EQ(value.bits, value.valid ? static_cast<std::uint32_t>(column(x)) : 0u) << x;
    ++count;
  });
  EXPECT_GT(count, 100'000);
}

TEST(Counterparts, are_missing_where_the_other_surface_is_absent_or_too_far_away) {
  const Sheet now(7, 0, 0, 1), half(7, 0.5, 0.004, 1), apart(7, 0, 0.02, 1);
  const auto matched = found(now, half).matched();
  test::for_each_surface_texel(now.surface.map, [&](std::uint32_t texel) {
    const double x = now.at(texel).x;
    if (std::abs(x - 0.5) < 0.011) return;
    ASSERT_EQ(matched[texel / 64] >> texel % 64 & 1u, x > 0.5 ? 1u : 0u) << x;
  });
  for (const std::uint64_t bits : found(now, apart).matched()) ASSERT_EQ(bits, 0u);
}

TEST(Counterparts, are_searched_only_for_the_given_texels) {
  const Sheet now(7, 0, 0, 1), then(11, 0, 0, 1);
  std::vector<std::uint64_t> only = now.surface.map.surface_mask;
  for (std::size_t slot = 0; slot < only.size(); slot += 2) only[slot] = 0;
  EXPECT_EQ(found(now, then, &only).matched(), only);
}

TEST(Counterparts, can_be_cancelled) {
  const Sheet now(7, 0, 0, 1);
  Progress progress;
  progress.cancel();
  const auto cancelled =
      find_counterparts(now.side, now.side, kTolerance, kResolution, progress, 0, 1);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::jobs
