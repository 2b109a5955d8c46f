#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/manifold_check.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;
using test::load_texts;

void expect_manifold(const mesh::TriangleMesh& mesh) {
  const auto faults = test::manifold_faults(mesh);
  EXPECT_EQ(faults.crowded_edges, 0u);
  EXPECT_EQ(faults.disagreements, 0u);
  EXPECT_EQ(faults.vertices_of_fans, 0u);
}

double volume(const mesh::TriangleMesh& mesh) {
  double six = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    six += glm::dot(
        mesh.positions[mesh.triangles[i]],
        glm::cross(mesh.positions[mesh.triangles[i + 1]], mesh.positions[mesh.triangles[i + 2]]));
  return six / 6;
}

// Returns a box from `low` to `high` as OBJ. `first` is the number of its first vertex.
std::string box(double low, double high, int first, bool outward) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    text += "v";
    for (int k = 0; k < 3; ++k) text += " " + std::to_string(i >> k & 1 ? high : low);
    text += "\n";
  }
  static constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      text += "f";
      for (int k = 0; k < 3; ++k) text += " " + std::to_string(first + t[outward ? k : 2 - k]);
      text += "\n";
    }
  return text;
}

TEST(MeshManifold, a_sound_mesh_is_left_as_it_is) {
  const auto loaded = load_text(box(0, 1, 1, true), "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->repairs.empty());
  EXPECT_NEAR(volume(loaded->mesh), 1, 1e-12);
}

TEST(MeshManifold, closed_pieces_turn_outward) {
  const auto loaded = load_text(box(0, 1, 1, false) + box(5, 6, 9, true), "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "closed pieces turned outward"), 1u);
  EXPECT_NEAR(volume(loaded->mesh), 2, 1e-12);
}

TEST(MeshManifold, a_hollow_stays_turned_inward) {
  const auto loaded = load_text(box(0, 10, 1, true) + box(3, 4, 9, false), "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->repairs.empty());
  EXPECT_NEAR(volume(loaded->mesh), 999, 1e-9);
}

TEST(MeshManifold, single_turned_triangles_follow_their_neighbours) {
  std::string text = box(0, 1, 1, true);
  const auto line = text.find("f 1 3 4");
  ASSERT_NE(line, text.npos);
  text.replace(line, 7, "f 4 3 1");
  const auto loaded = load_text(text, "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "turned triangles to agree with their neighbours"), 1u);
  EXPECT_NEAR(volume(loaded->mesh), 1, 1e-12);
  expect_manifold(loaded->mesh);
}

TEST(MeshManifold, texture_coordinates_and_materials_follow_a_turned_triangle) {
  const auto loaded = load_texts(
      {{"a.obj",
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "usemtl one\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\nusemtl two\nf 2/2 3/3 5/4\nf 5/1 6/2 3/3\n"},
       {"a.mtl", "newmtl one\nKd 1 0 0\nnewmtl two\nKd 0 1 0\n"}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(count_of(loaded->repairs, "turned triangles to agree with their neighbours"), 1u);
  EXPECT_EQ(loaded->mesh.triangle_materials, (std::vector<std::uint16_t>{0, 0, 1, 1}));
  expect_manifold(loaded->mesh);
  for (int k = 0; k < 3; ++k) {
    const auto vertex = loaded->mesh.triangles[6 + k];
    const glm::vec2 expected = vertex == 1   ? glm::vec2(1, 0)
                               : vertex == 2 ? glm::vec2(1, 1)
                                             : glm::vec2(0, 1);
    EXPECT_EQ(loaded->mesh.corner_uvs[6 + k], expected) << vertex;
  }
}

TEST(MeshManifold, a_fin_is_cut_off_and_the_surface_under_it_stays_whole) {
  const auto loaded = load_text(box(0, 1, 1, true) + "v -1 -1 0.5\nf 1 5 9\n", "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "cut edges of more than two triangles"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "cut vertices where pieces of the surface only touch"), 2u);
  EXPECT_EQ(loaded->mesh.positions.size(), 11u);
  expect_manifold(loaded->mesh);
  EXPECT_EQ(test::manifold_faults(loaded->mesh).boundary_edges, 3u) << "those of the fin";
}

TEST(MeshManifold, boxes_that_touch_in_an_edge_or_a_corner_come_apart) {
  // The second box shares the edge (1,1,·) of the first box. The third box shares its corner
  // (0,0,0).
  std::string text = box(0, 1, 1, true);
  auto moved = [](std::string shape, glm::dvec3 by) {
    std::string out;
    std::istringstream lines(shape);
    for (std::string line; std::getline(lines, line);) {
      if (line[0] == 'v') {
        std::istringstream numbers(line.substr(2));
        glm::dvec3 p;
        numbers >> p.x >> p.y >> p.z;
        p += by;
        line = "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
      }
      out += line + "\n";
    }
    return out;
  };
  text += moved(box(0, 1, 9, true), {1, 1, 0}) + moved(box(0, 1, 17, true), {-1, -1, -1});
  const auto loaded = load_text(text, "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "welded vertices at equal positions"), 3u);
  EXPECT_EQ(count_of(loaded->repairs, "cut edges of more than two triangles"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "cut vertices where pieces of the surface only touch"), 3u);
  EXPECT_NEAR(volume(loaded->mesh), 3, 1e-12);
  EXPECT_EQ(test::manifold_faults(loaded->mesh).boundary_edges, 0u);
  expect_manifold(loaded->mesh);
}

TEST(MeshManifold, a_strip_with_one_side_is_cut_once) {
  std::string text;
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps; ++i)
    for (const double across : {-0.3, 0.3}) {
      const double turn = 2 * 3.14159265358979 * i / kSteps, twist = turn / 2;
      const double radius = 1 + across * std::cos(twist);
      text += "v " + std::to_string(radius * std::cos(turn)) + " " +
              std::to_string(radius * std::sin(turn)) + " " +
              std::to_string(across * std::sin(twist)) + "\n";
    }
  for (int i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const int a = 2 * i + 1, b = a + 1, c = last ? 2 : a + 2, d = last ? 1 : b + 2;
    text += "f " + std::to_string(a) + " " + std::to_string(c) + " " + std::to_string(b) + "\n";
    text += "f " + std::to_string(b) + " " + std::to_string(c) + " " + std::to_string(d) + "\n";
  }
  const auto loaded = load_text(text, "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "cut edges where the surface has only one side"), 1u);
  EXPECT_EQ(loaded->mesh.positions.size(), 2u * kSteps + 2);
  expect_manifold(loaded->mesh);
}

TEST(MeshManifold, slivers_on_an_edge_of_others_are_dropped) {
  const auto loaded = load_text(box(0, 1, 1, true) + "v 0 0 0.5000001\nf 1 5 9\n", "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "dropped slivers on edges of other triangles") +
                count_of(loaded->repairs, "dropped triangles without area"),
            1u);
  EXPECT_EQ(loaded->mesh.triangle_count(), 12u);
  EXPECT_EQ(loaded->mesh.positions.size(), 8u);
}

TEST(MeshWeld, vertices_within_the_distance_are_joined_and_none_moves_farther) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.04 0 0\nv 0 1.04 0\nv 1 1 0\nv 1.08 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3\nf 4 6 5\nf 7 8 9\n";
  const auto apart = load_text(text, "a.obj");
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->mesh.positions.size(), 9u);
  const auto joined = load_texts({{"a.obj", text}}, {0.05});
  ASSERT_TRUE(joined);
  EXPECT_EQ(count_of(joined->repairs, "welded vertices within 0.05"), 2u);
  EXPECT_EQ(joined->mesh.positions.size(), 7u)
      << "1.08 lies farther than 0.05 from 1, and 1.04 has gone there";
  for (const auto& repair : joined->repairs) EXPECT_FALSE(mesh::is_fault(repair)) << repair.what;
}

}  // namespace
