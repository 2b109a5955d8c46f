// The selection of surface that looks like the surface at one place.
#include "query/conditions/similar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "mesh/texels/texel_owners.h"
#include "query/conditions/flood.h"
#include "query/sampling/texel_appearance.h"
#include "support/color_difference.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace strata::query {
namespace {

using test::for_each_surface_texel;
using test::layer_of;
using test::Surface;
using test::surface_of;

constexpr int kResolution = 512;
constexpr std::uint32_t kOpaque = 0xff000000u;

bool is_in(const TexelSelection& selection, std::uint32_t texel) {
  return ((selection[texel / 64] >> (texel % 64)) & 1u) != 0;
}

glm::vec3 position(const mesh::SurfaceMap& map, std::uint32_t texel) {
  return map.position(texel / 64, static_cast<int>(texel % 64));
}

const Surface& ball() {  // of radius 1
  static const Surface surface = surface_of("sphere", test::sphere(48), kResolution);
  return surface;
}

// Returns the surface texel that is nearest to a position.
std::uint32_t texel_near(const mesh::SurfaceMap& map, const glm::vec3& place) {
  std::uint32_t nearest = 0;
  float least = INFINITY;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const float distance = glm::distance(position(map, texel), place);
    if (distance < least) least = distance, nearest = texel;
  });
  return nearest;
}

// Returns the result of `color_at` for the position of each texel. It may be random.
template <class ColorAt>
TexelAppearance appearance_of(const mesh::SurfaceMap& map, ColorAt color_at) {
  TexelAppearance colors(map.block_of_slot.size() * 64);
  for_each_surface_texel(
      map, [&](std::uint32_t texel) { colors[texel] = color_at(position(map, texel)); });
  return colors;
}

Similarity around(const mesh::SurfaceMap& map, const glm::vec3& place, double tolerance) {
  const std::uint32_t start = texel_near(map, place);
  return {.start = start, .around = {{start, position(map, start)}}, .tolerance = tolerance};
}

double area_of(const mesh::SurfaceMap& map, const TexelSelection& selection) {
  return measure_selection(map, &selection).area;
}

// Returns the share of two areas that belongs to both.
template <class Inside>
double overlap(const mesh::SurfaceMap& map, const TexelSelection& selection, Inside inside) {
  double both = 0, either = 0;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const bool in_area = inside(position(map, texel)), selected = is_in(selection, texel);
    if (in_area && selected) both += map.area[texel];
    if (in_area || selected) either += map.area[texel];
  });
  return both / either;
}

// ── the oracle ───────────────────────────────────────────────────────────────────────────────────

std::set<std::uint32_t> texels_around(const Surface& surface, std::uint32_t texel) {
  const auto& [name, geometry, map, graph] = surface;
  const auto place_of = [&](std::uint32_t each) {
    const auto block = static_cast<int>(map.block_of_slot[each / 64]),
               i = static_cast<int>(each % 64);
    return glm::ivec2(block % map.blocks_per_side * 8 + i % 8,
                      block / map.blocks_per_side * 8 + i / 8);
  };
  const auto in_atlas = [&](std::uint32_t each) {
    std::vector<std::uint32_t> next;
    for (const auto way : {mesh::Way::right, mesh::Way::upper, mesh::Way::left, mesh::Way::lower})
      if (const auto found = mesh::neighbour(map, graph, each, way); found != mesh::kNoNeighbour)
        next.push_back(found);
    return next;
  };
  std::set<std::uint32_t> found{texel};
  mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t next) { found.insert(next); });
  for (const std::uint32_t beside : in_atlas(texel))
    for (const std::uint32_t corner : in_atlas(beside)) {
      const glm::ivec2 step = glm::abs(place_of(corner) - place_of(texel));
      if (step.x <= 1 && step.y <= 1) found.insert(corner);
    }
  return found;
}

std::array<double, 3> light_of(std::uint32_t color) {
  std::array<double, 3> light{};
  for (int c = 0; c < 3; ++c) {
    const double code = (color >> (8 * c) & 0xffu) / 255.0;
    light[static_cast<std::size_t>(c)] =
        code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
  }
  return light;
}

test::Lab lab_of_mean(const TexelAppearance& colors, const std::set<std::uint32_t>& texels) {
  std::array<double, 3> rgb{};
  double count = 0;
  for (const std::uint32_t texel : texels) {
    if (colors[texel] >> 24 < 128) continue;
    for (std::size_t c = 0; c < 3; ++c) rgb[c] += light_of(colors[texel])[c];
    ++count;
  }
  for (double& c : rgb) {
    c /= count;
    c = 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
  }
  return test::lab_of(rgb);
}

double difference(const test::Lab& a, const test::Lab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Returns the difference of each texel to the start: the smaller one of its own color and the mean.
// Empty for a texel without a color.
std::vector<std::optional<double>> differences(const Surface& surface,
                                               const TexelAppearance& colors, std::uint32_t start) {
  const auto at_start = lab_of_mean(colors, texels_around(surface, start));
  std::vector<std::optional<double>> all(colors.size());
  for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (colors[texel] >> 24 < 128) return;
    all[texel] = std::min(difference(lab_of_mean(colors, {texel}), at_start),
                          difference(lab_of_mean(colors, texels_around(surface, texel)), at_start));
  });
  return all;
}

// Grows the selection from those places that belong, by all neighbors, until nothing changes.
TexelSelection grown(const Surface& surface, const std::vector<Similarity::Place>& around,
                     const std::vector<std::uint8_t>& belongs) {
  TexelSelection selection(surface.map.block_of_slot.size(), 0);
  const auto set = [&](std::uint32_t texel) {
    selection[texel / 64] |= std::uint64_t{1} << (texel % 64);
  };
  for (const Similarity::Place& place : around)
    if (belongs[place.texel] != 0) set(place.texel);
  for (bool grows = true; grows;) {
    grows = false;
    for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      if (!is_in(selection, texel)) return;
      mesh::for_each_neighbour(surface.map, surface.graph, texel, [&](std::uint32_t next) {
        if (is_in(selection, next) || belongs[next] == 0) return;
        set(next);
        grows = true;
      });
    });
  }
  return selection;
}

TEST(Similar, selects_the_same_texels_as_brute_force) {
  std::mt19937 random(1);
  const auto code = [&] { return static_cast<std::uint32_t>(random() % 70 + 90); };
  int tested = 0;
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SCOPED_TRACE(name);
    const Surface surface = surface_of(name, mesh, 128);
    const auto colors = appearance_of(surface.map, [&](glm::vec3) {
      return code() | code() << 8 | code() << 16 | (random() % 20 == 0 ? 0 : kOpaque);
    });
    std::vector<std::uint32_t> texels;
    for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      if (colors[texel] >= kOpaque) texels.push_back(texel);
    });
    for (const double tolerance : {4.0, 9.0, 14.0, 30.0}) {
      const std::uint32_t start = texels[random() % texels.size()];
      // one place is a wand, several places are a brush
      std::vector<Similarity::Place> around{{start, position(surface.map, start)}};
      for (std::size_t more = random() % 4; more > 0; --more) {
        const std::uint32_t texel = texels[random() % texels.size()];
        around.push_back({texel, position(surface.map, texel)});
      }
      const float radius = tolerance == 30 ? INFINITY : around.size() > 1 ? 0.4f : 0.8f;
      const auto far = differences(surface, colors, start);
      std::vector<std::uint8_t> similar(colors.size()), near(colors.size());
      bool clear = true;  // no texel is within the rounding of the tolerance
      for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
        near[texel] = std::ranges::any_of(around, [&](const Similarity::Place& place) {
          return glm::distance(position(surface.map, texel), place.position) <= radius;
        });
        similar[texel] = far[texel] && *far[texel] <= tolerance && near[texel] != 0;
        clear = clear && !(far[texel] && std::abs(*far[texel] - tolerance) < 1e-3);
      });
      if (!clear) continue;
      ++tested;
      const Similarity similarity{start, around, radius, tolerance, true};
      EXPECT_EQ(select_similar_colors(surface.map, surface.graph, colors, similarity),
                grown(surface, around, similar));
      Similarity everywhere = similarity;
      everywhere.contiguous = false;
      TexelSelection expected = grown(surface, around, near);
      if (!std::isfinite(radius)) expected = surface.map.surface_mask;
      for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
        if (similar[texel] == 0) expected[texel / 64] &= ~(std::uint64_t{1} << (texel % 64));
      });
      for (const int threads : {1, 3})
        EXPECT_EQ(select_similar_colors(surface.map, surface.graph, colors, everywhere, threads),
                  expected);
    }
  }
  EXPECT_GE(tested, 20);
}

// ── areas ────────────────────────────────────────────────────────────────────────────────────────

constexpr double kPi = 3.14159265358979323846;

double cap_area(double degrees) { return 2 * kPi * (1 - std::cos(degrees * kPi / 180)); }

bool is_in_cap(const glm::vec3& at, const glm::vec3& middle, double degrees) {
  return glm::dot(glm::normalize(at), glm::normalize(middle)) >= std::cos(degrees * kPi / 180);
}

TEST(Similar, finds_a_patch_under_noise) {
  const mesh::SurfaceMap& map = ball().map;
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 14);
  const glm::vec3 middle(0.3f, 0.8f, 0.5f);
  const auto inside = [&](const glm::vec3& at) { return is_in_cap(at, middle, 30); };
  const auto colors = appearance_of(map, [&](const glm::vec3& at) {
    const auto code = [&](double of_patch, double of_ground) {
      return static_cast<std::uint32_t>(
          std::clamp((inside(at) ? of_patch : of_ground) + noise(random), 0.0, 255.0));
    };
    return code(150, 190) | code(90, 180) << 8 | code(70, 160) << 16 | kOpaque;
  });
  const auto selected = select_similar_colors(map, ball().graph, colors, around(map, middle, 14));
  EXPECT_GE(overlap(map, selected, inside), 0.9);
}

TEST(Similar, a_hole_of_one_odd_texel_is_closed) {
  const mesh::SurfaceMap& map = ball().map;
  auto colors = appearance_of(map, [](const glm::vec3&) { return 0xff808080u; });
  const std::uint32_t odd = texel_near(map, {1, 0.2f, 0.1f});
  colors[odd] = 0xff8080b0u;
  const auto selected = select_similar_colors(map, ball().graph, colors, around(map, {0, 1, 0}, 6));
  EXPECT_EQ(selected, map.surface_mask);
}

TEST(Similar, an_area_is_the_same_on_both_sides_of_a_seam) {
  const mesh::SurfaceMap& map = ball().map;
  ASSERT_FALSE(ball().graph.links.empty());
  int seams = 0;
  for (std::size_t i = 0; i < ball().graph.links.size(); i += ball().graph.links.size() / 7) {
    const auto [one, other] = ball().graph.links[i];
    const glm::vec3 middle = position(map, one);
    const auto colors = appearance_of(map, [&](const glm::vec3& at) {
      return is_in_cap(at, middle, 20) ? 0xff2030c0u : 0xffc0c0c0u;
    });
    const auto from_one = select_similar_colors(
        map, ball().graph, colors, {.start = one, .around = {{one, middle}}, .tolerance = 5});
    EXPECT_NEAR(area_of(map, from_one), cap_area(20), 0.02 * cap_area(20));
    EXPECT_EQ(from_one,
              select_similar_colors(map, ball().graph, colors,
                                    {.start = other, .around = {{other, middle}}, .tolerance = 5}));
    ++seams;
  }
  EXPECT_GE(seams, 7);
}

TEST(Similar, selects_all_similar_texels_in_the_radius_if_they_need_not_be_connected) {
  const mesh::SurfaceMap& map = ball().map;
  const glm::vec3 one(1, 0, 0), other(0, 1, 0), far(-1, 0, 0);
  const auto colors = appearance_of(map, [&](const glm::vec3& at) {
    const bool in_patch =
        is_in_cap(at, one, 15) || is_in_cap(at, other, 15) || is_in_cap(at, far, 15);
    return in_patch ? 0xff2030c0u : 0xffc0c0c0u;
  });
  Similarity similarity = around(map, one, 5);
  const auto select = [&] { return select_similar_colors(map, ball().graph, colors, similarity); };
  EXPECT_NEAR(area_of(map, select()), cap_area(15), 0.03 * cap_area(15));
  similarity.contiguous = false;
  EXPECT_NEAR(area_of(map, select()), 3 * cap_area(15), 0.1 * cap_area(15));
  similarity.radius = 1.8f;  // contains the second patch, but not the third one
  EXPECT_NEAR(area_of(map, select()), 2 * cap_area(15), 0.06 * cap_area(15));
  similarity.radius = 0.1f;
  EXPECT_NEAR(area_of(map, select()), kPi * 0.01, 0.05 * kPi * 0.01);
}

TEST(Similar, a_brush_selects_only_the_similar_surface_that_it_passes) {
  const mesh::SurfaceMap& map = ball().map;
  const auto colors = appearance_of(map, [](const glm::vec3& at) {
    return is_in_cap(at, {1, 0, 0}, 25) ? 0xff2030c0u : 0xffc0c0c0u;
  });
  // Begins in the patch, and leaves it along the equator.
  Similarity similarity = around(map, {1, 0, 0}, 5);
  similarity.radius = 0.12f;
  for (int degrees = 1; degrees <= 50; ++degrees) {
    const float angle = glm::radians(static_cast<float>(degrees));
    const std::uint32_t texel = texel_near(map, {std::cos(angle), 0, std::sin(angle)});
    similarity.around.push_back({texel, position(map, texel)});
  }
  const auto selected = select_similar_colors(map, ball().graph, colors, similarity);
  double expected = 0;
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const glm::vec3 at = position(map, texel);
    const float along = std::clamp(std::atan2(at.z, at.x), 0.f, glm::radians(50.f));
    const bool passed = glm::distance(at, {std::cos(along), 0, std::sin(along)}) <= 0.12f;
    if (passed && is_in_cap(at, {1, 0, 0}, 25)) expected += double{map.area[texel]};
  });
  EXPECT_NEAR(area_of(map, selected), expected, 0.03 * expected);
  // The value at the beginning is compared, also where the brush is on other surface.
  similarity.start = texel_near(map, {0, 0, 1});
  const auto rest = select_similar_colors(map, ball().graph, colors, similarity);
  for (std::size_t slot = 0; slot < rest.size(); ++slot) ASSERT_EQ(rest[slot] & selected[slot], 0u);
  EXPECT_GT(area_of(map, rest), 0.05);
}

// ── normals and values ───────────────────────────────────────────────────────────────────────────

TEST(Similar, normals_within_an_angle_are_a_cap_of_a_ball) {
  const mesh::SurfaceMap& map = ball().map;
  Progress progress;
  const auto owners = mesh::bake_texel_owners(ball().geometry, kResolution, progress);
  const auto geometry = std::make_shared<const mesh::Geometry>(ball().geometry);
  const auto normals = *normals_of_texels(geometry, *owners, progress, 2);
  for (const double degrees : {10.0, 25.0, 60.0}) {
    const auto selected = select_similar_normals(map, ball().graph, normals,
                                                 around(map, {0.2f, 0.9f, -0.4f}, degrees));
    EXPECT_NEAR(area_of(map, selected), cap_area(degrees), 0.05 * cap_area(degrees)) << degrees;
  }
  EXPECT_EQ(select_similar_normals(map, ball().graph, normals, around(map, {1, 0, 0}, 180)),
            map.surface_mask);
}

TEST(Similar, packed_normals_are_precise) {
  std::mt19937 random(3);
  std::normal_distribution<float> any;
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 normal = glm::normalize(glm::vec3(any(random), any(random), any(random)));
    EXPECT_LT(glm::distance(unpacked_normal(packed_normal(normal)), normal), 2e-4);
  }
  for (const float sign : {-1.0f, 1.0f})
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 normal(0);
      normal[axis] = sign;
      EXPECT_EQ(unpacked_normal(packed_normal(normal)), normal);
    }
  EXPECT_EQ(packed_normal(glm::vec3(0)), kNoNormal);
  EXPECT_EQ(packed_normal(glm::vec3(NAN)), kNoNormal);
}

LayerView view_of(TileMap tiles, ValueType type, int resolution, PaletteMode mode) {
  LayerView view;
  view.layer.type = type;
  view.layer.resolution = resolution;
  view.layer.palette.mode = mode;
  view.snapshot.tiles = std::move(tiles);
  return view;
}

// Returns a copy of the tiles with another type, with the bits that `bits_of` returns for them.
template <class BitsOf>
TileMap with_bits(const TileMap& tiles, ValueType type, BitsOf bits_of) {
  TileMap made;
  for (const auto& [address, before] : tiles) {
    auto tile = std::make_shared<TileData>(type);
    for (int i = 0; i < kTexelsPerTile; ++i)
      if (before->valid.test(i)) tile->write(i, bits_of(before->bits(i)));
    made[address] = tile;
  }
  return made;
}

TEST(Similar, classes_are_selected_like_connected_areas) {
  const mesh::SurfaceMap& map = ball().map;
  const auto tiles = layer_of(map, [](const glm::vec3& at) {
    return static_cast<int>(std::floor(at.x * 3) + std::floor(at.y * 2) + 5) % 4;
  });
  const auto view = view_of(tiles, ValueType::u8, kResolution, PaletteMode::categorical);
  std::mt19937 random(4);
  std::vector<std::uint32_t> texels;
  for_each_surface_texel(map, [&](std::uint32_t texel) { texels.push_back(texel); });
  for (int i = 0; i < 12; ++i) {
    const std::uint32_t start = texels[random() % texels.size()];
    EXPECT_EQ(select_similar_values(map, ball().graph, view,
                                    {.start = start, .around = {{start, position(map, start)}}}),
              select_connected(map, ball().graph, tiles, start));
  }
}

TEST(Similar, values_within_a_tolerance_are_a_band) {
  const mesh::SurfaceMap& map = ball().map;
  const auto layer = layer_of(
      map, [](const glm::vec3& at) { return static_cast<int>(std::lround(100 + 80 * at.z)); });
  const auto view = view_of(layer, ValueType::u8, kResolution, PaletteMode::linear);
  const auto selected =
      select_similar_values(map, ball().graph, view, around(map, {1, 0, 0}, 20.5));
  // The area of a band of a ball grows with its height, here |z| ≤ 20.5 / 80.
  const double area = 2 * kPi * 2 * 20.5 / 80;
  EXPECT_NEAR(area_of(map, selected), area, 0.03 * area);
}

TEST(Similar, a_layer_can_have_another_resolution) {
  const mesh::SurfaceMap& map = ball().map;
  Progress progress;
  const auto coarse = mesh::bake_surface_map(ball().geometry, kResolution / 2, progress);
  ASSERT_TRUE(coarse);
  const auto inside = [](const glm::vec3& at) { return is_in_cap(at, {0, 0, 1}, 40); };
  const auto tiles = layer_of(*coarse, [&](const glm::vec3& at) { return inside(at) ? 9 : 1; });
  const auto view = view_of(tiles, ValueType::u8, kResolution / 2, PaletteMode::linear);
  EXPECT_GE(overlap(map, select_similar_values(map, ball().graph, view, around(map, {0, 0, 1}, 1)),
                    inside),
            0.97);
}

TEST(Similar, neighboring_large_keys_are_different) {
  const mesh::SurfaceMap& map = ball().map;
  const auto tiles =
      with_bits(layer_of(map, [](const glm::vec3& at) { return at.z > 0 ? 1 : 2; }), ValueType::u32,
                [](std::uint32_t half) { return 16'777'215 + half; });
  const auto view = view_of(tiles, ValueType::u32, kResolution, PaletteMode::categorical);
  const auto selected = select_similar_values(map, ball().graph, view, around(map, {0, 0, 1}, 0));
  EXPECT_NEAR(area_of(map, selected), 2 * kPi, 0.03);
}

TEST(Similar, an_area_of_one_value_has_no_gaps_without_a_tolerance) {
  const mesh::SurfaceMap& map = ball().map;
  const auto halves = layer_of(map, [](const glm::vec3& at) { return at.z > 0 ? 1 : 2; });
  const auto select = [&](ValueType type, auto bits_of) {
    const auto view =
        view_of(with_bits(halves, type, bits_of), type, kResolution, PaletteMode::linear);
    return select_similar_values(map, ball().graph, view, around(map, {0, 0, 1}, 0));
  };
  const auto expected = select(ValueType::u8, [](std::uint32_t half) { return half; });
  EXPECT_NEAR(area_of(map, expected), 2 * kPi, 0.03);
  EXPECT_EQ(select(ValueType::f32,
                   [](std::uint32_t half) {
                     return std::bit_cast<std::uint32_t>(half == 1 ? 0.1f : 0.7f);
                   }),
            expected);
  EXPECT_EQ(select(ValueType::u32, [](std::uint32_t half) { return 4'294'967'290u + half; }),
            expected);
  EXPECT_EQ(select(ValueType::i32,
                   [](std::uint32_t half) {
                     return std::bit_cast<std::uint32_t>(-2'000'000'001 + static_cast<int>(half));
                   }),
            expected);
}

// ── colors of texels ─────────────────────────────────────────────────────────────────────────────

TEST(TexelAppearance, no_colors_or_normals_are_computed_after_a_cancellation) {
  const Surface surface = surface_of("grid", test::open_grid(4), 128);
  Progress progress;
  const auto owners = mesh::bake_texel_owners(surface.geometry, 128, progress);
  progress.cancel();
  const auto colors = vertex_colors_of_texels(surface.geometry, *owners, progress, 2);
  ASSERT_FALSE(colors);
  EXPECT_EQ(colors.error().code, ErrorCode::cancelled);
  const auto geometry = std::make_shared<const mesh::Geometry>(surface.geometry);
  EXPECT_FALSE(normals_of_texels(geometry, *owners, progress, 2));
  TexelAppearance under(surface.map.block_of_slot.size() * 64, kOpaque);
  const TexelAppearance before = under;
  const Picture white{8, 8, std::vector<std::uint8_t>(256, 255)};
  EXPECT_FALSE(draw_over(under, white, 1, surface.map, progress, 2));
  EXPECT_EQ(under, before);
}

TEST(TexelAppearance, an_image_is_drawn_over_the_colors_of_the_vertices) {
  mesh::TriangleMesh mesh = test::open_grid(16);
  for (const glm::dvec3& at : mesh.positions)
    mesh.vertex_colors.push_back(kOpaque | static_cast<std::uint32_t>(at.x * 200 + 20));
  const Surface surface = surface_of("grid", mesh, 256);
  const mesh::SurfaceMap& map = surface.map;
  Progress progress;
  const auto owners = mesh::bake_texel_owners(surface.geometry, 256, progress);
  auto colors = *vertex_colors_of_texels(surface.geometry, *owners, progress, 2);
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const double red = (position(map, texel).x + surface.geometry.origin.x) * 200 + 20;
    ASSERT_NEAR(colors[texel] & 0xffu, red, 1.6);
    ASSERT_EQ(colors[texel] >> 8, 0xff0000u);
  });
  const TexelAppearance below = colors;
  // Rows of an image go down, and rows of the atlas go up. The left half is transparent.
  Picture picture{1024, 1024, std::vector<std::uint8_t>(std::size_t{4} * 1024 * 1024)};
  for (int y = 0; y < 1024; ++y)
    for (int x = 0; x < 1024; ++x) {
      std::uint8_t* pixel =
          &picture.rgba[4 * (static_cast<std::size_t>(y) * 1024 + static_cast<std::size_t>(x))];
      pixel[1] = static_cast<std::uint8_t>(y / 4);
      pixel[3] = x < 512 ? 0 : 255;
    }
  ASSERT_TRUE(draw_over(colors, picture, 1, map, progress, 2));
  for_each_surface_texel(map, [&](std::uint32_t texel) {
    const std::uint32_t block = map.block_of_slot[texel / 64], side = 256 / 8;
    const auto x = block % side * 8 + texel % 8, y = block / side * 8 + texel % 64 / 8;
    if (x < 127) {
      ASSERT_EQ(colors[texel], below[texel]);
    } else if (x > 128) {
      ASSERT_NEAR(colors[texel] >> 8 & 0xffu, 255 - y, 1) << x << " " << y;
    }
  });
}

TEST(TexelAppearance, the_opacity_of_an_image_is_multiplied_with_its_alpha) {
  const Surface surface = surface_of("grid", test::open_grid(4), 128);
  const Picture image{1, 1, {200, 100, 0, 128}};
  for (const float opacity : {0.0f, 0.25f, 1.0f}) {
    TexelAppearance colors(surface.map.block_of_slot.size() * 64, kOpaque | 0x0050a0u);
    Progress progress;
    ASSERT_TRUE(draw_over(colors, image, opacity, surface.map, progress, 2));
    const double share = double(opacity) * 128 / 255;
    for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      ASSERT_NEAR(colors[texel] & 0xffu, share * 200 + (1 - share) * 0xa0, 1);
      ASSERT_NEAR(colors[texel] >> 8 & 0xffu, share * 100 + (1 - share) * 0x50, 1);
      ASSERT_EQ(colors[texel] >> 24, 0xffu);
    });
  }
}

}  // namespace
}  // namespace strata::query
