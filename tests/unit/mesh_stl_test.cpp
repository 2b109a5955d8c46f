#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;
using testing::HasSubstr;

std::string binary_stl(const std::string& header, std::uint32_t announced, int triangles) {
  std::string file = header;
  file.resize(80, ' ');
  file.append(reinterpret_cast<const char*>(&announced), 4);
  for (int i = 0; i < triangles; ++i) {
    const float numbers[12] = {0, 0, 1, float(i), 0, 0, float(i + 1), 0, 0, float(i), 1, 0};
    file.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    file.append(2, '\0');
  }
  return file;
}

TEST(MeshStl, a_binary_file_is_read_whatever_its_header_begins_with) {
  for (const std::string header : {"made by a scanner", "solid made by a scanner", "solid facet normal"}) {
    const auto loaded = load_text(binary_stl(header, 2, 2), "a.stl");
    ASSERT_TRUE(loaded) << header << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
    EXPECT_EQ(count_of(loaded->repairs, "welded vertices at equal positions"), 1u);
  }
}

TEST(MeshStl, a_text_file_is_read_with_its_polygons_and_names) {
  const auto loaded = load_text(
      "solid vertex of a facet\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1.0e0 0 0\n  vertex 1 1 0\n"
      "  vertex 0 1 0\n endloop\nendfacet\nendsolid vertex\nsolid two\nfacet normal 0 0 1 outer loop vertex 2 0 0 "
      "vertex 3 0 0 vertex 2 1 0 endloop endfacet\nendsolid",
      "A.STL");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 3u);
  EXPECT_EQ(loaded->mesh.positions.size(), 7u);
}

TEST(MeshStl, faults_are_refused_by_name) {
  const std::pair<std::string, std::string> bad[] = {
      {binary_stl("scanner", 3, 2), "announces 3 triangles, but has bytes for 2"},
      {binary_stl("scanner", 4'000'000'000u, 1), "4000000000"},
      {binary_stl("scanner", 0, 0), "no triangle"},
      {"short", "shorter than the header"},
      {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "line 4"},
      {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0", "ends within a facet"},
      {"solid a\nfacet\nvertex 0 0 0\nfacet\n", "does not end"},
      {"solid a\nendsolid a\n", "no triangle"}};
  for (const auto& [text, says] : bad) {
    const auto loaded = load_text(text, "a.stl");
    ASSERT_FALSE(loaded) << says;
    EXPECT_THAT(loaded.error().detail, HasSubstr(says));
  }
}

TEST(MeshStl, bytes_behind_the_last_triangle_are_reported) {
  const auto loaded = load_text(binary_stl("scanner", 1, 1) + "tail", "a.stl");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "ignored bytes after the last element"), 4u);
}

}  // namespace
