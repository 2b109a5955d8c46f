#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesh/demo/demo_pot.h"
#include "mesh/surface/geometry.h"

namespace {

using namespace strata;
using mesh::Atlas;
using mesh::build_geometry;
using mesh::decode_geometry;
using mesh::encode_geometry;
using mesh::Geometry;
using mesh::TriangleMesh;

// Returns a square of two triangles, which is folded along its diagonal if `height` is not 0.
TriangleMesh square(const glm::dvec3& at, double size, double height = 0) {
  TriangleMesh mesh;
  mesh.positions = {at, at + glm::dvec3(size, 0, height), at + glm::dvec3(size, size, 0),
                    at + glm::dvec3(0, size, height)};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  return mesh;
}

glm::vec3 unpack_normal(std::uint32_t packed) {
  const auto part = [&](int shift) {
    const int value = static_cast<int>(packed << (22 - shift)) >> 22;
    return std::max(-1.0f, static_cast<float>(value) / 511.0f);
  };
  return {part(0), part(10), part(20)};
}

void expect_equal(const Geometry& a, const Geometry& b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.box_min, b.box_min);
  EXPECT_EQ(a.box_max, b.box_max);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  const auto same = [](const mesh::Vertex& v, const mesh::Vertex& w) {
    return v.position == w.position && v.normal == w.normal && v.uv == w.uv && v.color == w.color &&
           v.position_index == w.position_index;
  };
  EXPECT_TRUE(std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), same));
}

TEST(MeshGeometry, vertices_split_where_texture_coordinates_differ_and_share_their_position) {
  Atlas atlas;
  atlas.corner_uvs = {{0, 0}, {.4f, 0}, {.4f, .4f}, {.5f, .5f}, {.4f, .4f}, {.5f, .9f}};
  const Geometry geometry = build_geometry(square({0, 0, 0}, 1), atlas);
  EXPECT_EQ(geometry.positions.size(), 4u);
  EXPECT_EQ(geometry.vertices.size(), 5u);  // position 0 is split, position 2 is not
  std::map<std::uint32_t, int> at;
  for (const auto& vertex : geometry.vertices) {
    ++at[vertex.position_index];
    EXPECT_EQ(vertex.position,
              glm::vec3(geometry.positions[vertex.position_index] - geometry.origin));
    EXPECT_EQ(vertex.color, 0xffcfd3d6u);
  }
  EXPECT_EQ(at.size(), 4u);
}

TEST(MeshGeometry, the_origin_is_the_centre_rounded_for_large_boxes_only) {
  EXPECT_EQ(build_geometry(square({433210.25, 4581234.5, 612}, 2), {}).origin,
            glm::dvec3(433211.25, 4581235.5, 612));
  const Geometry large = build_geometry(square({433210.25, 4581234.5, 612.25}, 20), {});
  EXPECT_EQ(large.origin, glm::dvec3(433220, 4581245, 612));
  EXPECT_EQ(large.box_min, glm::vec3(-9.75f, -10.5f, 0.25f));
  EXPECT_EQ(large.box_max, glm::vec3(10.25f, 9.5f, 0.25f));
}

TEST(MeshGeometry, normals_are_smooth_over_seams_and_weighted_by_area) {
  TriangleMesh mesh = square({0, 0, 0}, 1, 0.5);
  Atlas atlas;
  atlas.corner_uvs = {{0, 0}, {.4f, 0}, {.4f, .4f}, {.5f, .5f}, {.9f, .9f}, {.5f, .9f}};
  const Geometry geometry = build_geometry(mesh, atlas);
  std::map<std::uint32_t, std::set<std::uint32_t>> normals;
  for (const auto& vertex : geometry.vertices) normals[vertex.position_index].insert(vertex.normal);
  for (const auto& [position, set] : normals) EXPECT_EQ(set.size(), 1u);
  // The two triangles are congruent, so the normal on the fold is vertical.
  for (const auto& vertex : geometry.vertices) {
    const glm::vec3 normal = unpack_normal(vertex.normal);
    EXPECT_NEAR(glm::length(normal), 1, 0.004);
    const glm::dvec3 p = geometry.positions[vertex.position_index];
    if (p.z == 0) {
      EXPECT_NEAR(normal.z, 1, 0.004);
    }
  }
}

TEST(MeshGeometry, triangles_are_the_same_as_those_of_the_mesh_in_a_local_order) {
  TriangleMesh mesh = mesh::make_demo_pot(0.05);
  std::vector<std::uint32_t> shuffled(mesh.triangle_count());
  std::iota(shuffled.begin(), shuffled.end(), 0u);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(7));
  TriangleMesh mixed = mesh;
  for (std::size_t i = 0; i < shuffled.size(); ++i) {
    std::copy_n(mesh.triangles.begin() + 3 * shuffled[i], 3,
                mixed.triangles.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  const Geometry geometry = build_geometry(mixed, {});
  using Key = std::array<std::array<double, 3>, 3>;
  const auto key = [](const std::vector<glm::dvec3>& positions, std::uint32_t a, std::uint32_t b,
                      std::uint32_t c) {
    Key result;
    int k = 0;
    for (std::uint32_t i : {a, b, c})
      result[k++] = {positions[i].x, positions[i].y, positions[i].z};
    return result;
  };
  std::multiset<Key> before, after;
  double step = 0, step_mixed = 0;
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 3) {
    const auto index = [&](std::size_t k) {
      return geometry.vertices[geometry.indices[i + k]].position_index;
    };
    before.insert(
        key(mixed.positions, mixed.triangles[i], mixed.triangles[i + 1], mixed.triangles[i + 2]));
    after.insert(key(geometry.positions, index(0), index(1), index(2)));
    if (i == 0) continue;
    step += glm::distance(
        geometry.positions[index(0)],
        geometry.positions[geometry.vertices[geometry.indices[i - 3]].position_index]);
    step_mixed +=
        glm::distance(mixed.positions[mixed.triangles[i]], mixed.positions[mixed.triangles[i - 3]]);
  }
  EXPECT_EQ(before, after);
  EXPECT_LT(step, step_mixed / 10);
}

TEST(MeshGeometry, the_order_of_the_triangles_never_jumps) {
  constexpr int kSide = 8;
  TriangleMesh mesh;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const glm::dvec3 at(x, y, z);
        mesh.positions.insert(mesh.positions.end(),
                              {at, at + glm::dvec3(1e-3, 0, 0), at + glm::dvec3(0, 1e-3, 0)});
        mesh.triangles.insert(mesh.triangles.end(), {first, first + 1, first + 2});
      }
  const Geometry geometry = build_geometry(mesh, {});
  const auto place = [&](std::size_t triangle) {
    return geometry.vertices[geometry.indices[3 * triangle]].position;
  };
  for (std::size_t t = 1; t < geometry.triangle_count(); ++t)
    EXPECT_NEAR(glm::distance(place(t - 1), place(t)), 1, 0.01) << "triangle " << t;
}

TEST(MeshGeometry, what_is_encoded_is_decoded_bit_for_bit) {
  TriangleMesh mesh = mesh::make_demo_pot(0.03);
  for (auto& p : mesh.positions) p += glm::dvec3(433210.123, 4581234.567, 612.25);
  Atlas atlas;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    atlas.corner_uvs.emplace_back(unit(random), unit(random));
  const Geometry geometry = build_geometry(mesh, atlas);
  const auto bytes = encode_geometry(geometry);
  const auto decoded = decode_geometry(bytes);
  ASSERT_TRUE(decoded) << decoded.error().detail;
  expect_equal(geometry, *decoded);
  const auto plain = encode_geometry(build_geometry(mesh, {}));
  EXPECT_LT(plain.size(), mesh.triangle_count() * 16);
  const auto empty = decode_geometry(encode_geometry(Geometry{}));
  ASSERT_TRUE(empty);
  expect_equal(Geometry{}, *empty);
}

TEST(MeshGeometry, of_version_1_is_open_everywhere) {
  Geometry geometry = build_geometry(square({0, 0, 0}, 1), {});
  const Geometry open = geometry;
  for (auto& vertex : geometry.vertices) vertex.color &= 0x40ffffffu;
  auto bytes = encode_geometry(geometry);
  expect_equal(*decode_geometry(bytes), geometry);
  bytes[4] = 1;
  expect_equal(*decode_geometry(bytes), open);
}

TEST(MeshGeometry, damaged_bytes_are_refused) {
  const auto good = encode_geometry(build_geometry(square({0, 0, 0}, 1), {}));
  ASSERT_TRUE(decode_geometry(good));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode_geometry(
        std::vector<std::uint8_t>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))))
        << size;
  }
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      auto bad = good;
      bad[i] ^= static_cast<std::uint8_t>(1 << bit);
      const auto decoded = decode_geometry(bad);
      // A flipped bit may be unused. Then the result must be the same as without the flip.
      if (decoded) expect_equal(*decoded, *decode_geometry(good));
    }
  }
  auto longer = good;
  longer.push_back(0);
  EXPECT_FALSE(decode_geometry(longer));
}

TEST(MeshGeometry, indices_out_of_range_and_infinite_numbers_are_refused_behind_a_right_checksum) {
  const Geometry good = build_geometry(square({0, 0, 0}, 1), {});
  const auto refused = [&](auto change) {
    Geometry bad = good;
    change(bad);
    return !decode_geometry(encode_geometry(bad)).has_value();
  };
  EXPECT_TRUE(refused([](Geometry& g) { g.indices[2] = 4; }));
  EXPECT_TRUE(refused([](Geometry& g) { g.indices.push_back(0); }));
  EXPECT_TRUE(refused([](Geometry& g) { g.vertices[1].position_index = 0xffffffffu; }));
  EXPECT_TRUE(
      refused([](Geometry& g) { g.positions[0].x = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](Geometry& g) { g.positions[0].x = 1e300; }));
  EXPECT_TRUE(
      refused([](Geometry& g) { g.vertices[0].uv.x = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(refused([](Geometry& g) { g.origin.y = std::numeric_limits<double>::infinity(); }));
}

}  // namespace
