#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/atlas/atlas.h"
#include "mesh/io/vertex_properties.h"
#include "mesh/surface/geometry.h"
#include "support/mesh_files.h"

namespace strata::mesh {
namespace {

using ::testing::ElementsAre;
using Encoding = test::PlyWriter::Encoding;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const char* const kHeader =
    "element camera 1\nproperty list uchar float focus\nproperty int id\n"
    "element vertex 3\nproperty float x\nproperty double y\nproperty float z\nproperty list uchar short tags\n"
    "property uchar red\nproperty ushort quality\nproperty float confidence\n"
    "element face 1\nproperty list uchar int vertex_indices\n";

// Returns a PLY file with three vertices of quality 10, 20 and 30 and confidence 0.5. They follow
// an element of another type.
std::string scan(Encoding encoding) {
  test::PlyWriter ply(encoding, kHeader);
  ply.put(std::uint8_t{2}).put(1.5f).put(2.5f).put(std::int32_t{7});
  for (int i = 0; i < 3; ++i) {
    ply.put(i == 1 ? 4.0f : 0.0f).put(i == 2 ? 5.0 : 0.0).put(0.0f);
    ply.put(std::uint8_t(i));
    for (int k = 0; k < i; ++k) ply.put(std::int16_t{3});
    ply.put(std::uint8_t{200}).put(std::uint16_t(10 * (i + 1))).put(0.5f);
  }
  ply.put(std::uint8_t{3}).put_all<std::int32_t>({0, 1, 2});
  return ply.bytes();
}

Geometry triangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 5, 0}};
  mesh.triangles = {0, 1, 2};
  return build_geometry(mesh, Atlas{});
}

TEST(VertexProperties, are_named_without_what_a_mesh_knows_itself) {
  EXPECT_THAT(vertex_property_names(bytes_of(scan(Encoding::little))),
              ElementsAre("quality", "confidence"));
  EXPECT_TRUE(vertex_property_names(bytes_of("solid none")).empty());
  EXPECT_TRUE(vertex_property_names({}).empty());
}

TEST(VertexProperties, are_read_from_every_encoding_with_their_places) {
  for (const Encoding encoding : {Encoding::ascii, Encoding::little, Encoding::big}) {
    const auto quality = read_vertex_property(bytes_of(scan(encoding)), "quality");
    ASSERT_TRUE(quality) << quality.error().detail;
    EXPECT_THAT(quality->values, ElementsAre(10, 20, 30));
    EXPECT_EQ(quality->positions[1], glm::dvec3(4, 0, 0));
    EXPECT_EQ(quality->positions[2], glm::dvec3(0, 5, 0));
  }
}

TEST(VertexProperties, of_a_file_that_ends_early_or_has_none_such_are_refused) {
  for (const Encoding encoding : {Encoding::ascii, Encoding::little, Encoding::big}) {
    const std::string whole = scan(encoding);
    for (std::size_t length = 0; length + 16 < whole.size(); length += 3) {
      const auto cut = read_vertex_property(bytes_of(whole.substr(0, length)), "quality");
      if (cut) continue;  // the missing part is after the vertices
      EXPECT_EQ(cut.error().code, ErrorCode::invalid);
    }
    EXPECT_FALSE(
        read_vertex_property(bytes_of(whole.substr(0, whole.size() / 2 + 120)), "quality"));
    EXPECT_EQ(read_vertex_property(bytes_of(whole), "tags").error().field, "compute.property");
    EXPECT_EQ(read_vertex_property(bytes_of(whole), "beauty").error().field, "compute.property");
  }
}

TEST(VertexProperties, land_on_the_welded_positions_as_mean_or_as_first_key) {
  const Geometry geometry = triangle();
  VertexProperty property;
  property.positions = {{0, 0, 0}, {4, 0, 0}, {-0.0, 0, 0}, {9, 9, 9}};
  property.values = {2, 8, 4, 100};
  const auto at = [&](const std::vector<double>& values, const glm::dvec3& place) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (geometry.positions[i] == place) return values[i];
    return -1.0;
  };
  const auto means = values_at_positions(geometry, property, false),
             keys = values_at_positions(geometry, property, true);
  EXPECT_EQ(at(means, {0, 0, 0}), 3);
  EXPECT_EQ(at(keys, {0, 0, 0}), 2);
  EXPECT_EQ(at(means, {4, 0, 0}), 8);
  EXPECT_TRUE(std::isnan(at(means, {0, 5, 0})));
}

TEST(VertexProperties, are_mixed_in_a_triangle_but_keys_are_not) {
  const Geometry geometry = triangle();
  std::vector<double> values(3, std::nan(""));
  const auto corner = [&](int k) -> double& {
    return values[geometry.vertices[geometry.indices[k]].position_index];
  };
  corner(0) = 10;
  corner(1) = 20;
  EXPECT_NEAR(value_in_triangle(geometry, values, 0, {0.25f, 0.75f, 0}, false), 17.5, 1e-9);
  EXPECT_EQ(value_in_triangle(geometry, values, 0, {0.25f, 0.75f, 0}, true), 20);
  // One corner has no value.
  EXPECT_NEAR(value_in_triangle(geometry, values, 0, {0.25f, 0.25f, 0.5f}, false), 15, 1e-9);
  corner(0) = corner(1) = std::nan("");
  EXPECT_TRUE(std::isnan(value_in_triangle(geometry, values, 0, {0.25f, 0.75f, 0}, true)));
}

TEST(VertexProperties, come_from_a_csv_of_one_column_in_the_order_of_the_file) {
  Progress progress;
  const std::string obj = "v 0 0 0\nv 4 0 0\nv 0 5 0\nf 1 2 3\n";
  const auto read = [&](const std::string& csv) {
    return read_vertex_csv(bytes_of(obj), "scan.OBJ", csv, progress);
  };
  const auto good = read("moisture\r\n 1.5\r\n\n-3e2\n\n");
  ASSERT_TRUE(good) << good.error().detail;
  EXPECT_EQ(good->values[0], 1.5);
  EXPECT_TRUE(std::isnan(good->values[1]));
  EXPECT_EQ(good->values[2], -300);
  EXPECT_EQ(good->positions[1], glm::dvec3(4, 0, 0));
  for (const char* bad :
       {"", "1\n2\n", "1\n2\n3\n4\n", "1\nx\n3\n", "1\ninf\n3\n", "1,2\n3,4\n5,6\n7,8\n"}) {
    const auto refused = read(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().field, "body") << bad;
  }
  EXPECT_EQ(read_vertex_csv(bytes_of("solid"), "scan.stl", "1\n", progress).error().field,
            "source");
}

}  // namespace
}  // namespace strata::mesh
