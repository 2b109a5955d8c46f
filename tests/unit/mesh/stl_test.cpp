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
  for (const std::string header :
       {"made by a scanner", "solid made by a scanner", "solid facet normal"}) {
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
  // As a binary file, these bytes would declare 538976288 triangles.
  std::string other_text = "v 0 0 0\nf 1 1 1\n";
  other_text.insert(0, 200, ' ');
  const std::pair<std::string, std::string> bad[] = {
      {binary_stl("scanner", 3, 2), "declares 3 triangles, but contains only 2"},
      {binary_stl("scanner", 4'000'000'000u, 1), "4000000000"},
      {binary_stl("scanner", 0, 0), "no triangle"},
      {"short", "it is text without a facet"},
      {std::string("sh\0rt", 5), "shorter than the header of a binary STL"},
      {"\xef\xbb\xbf", "it is text without a facet"},
      {"solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 zero\r", "line 4"},
      {"solid a\r\nfacet\r\nvertex 0 0\r\n", "line 3"},
      {other_text, "it is text without a facet"},
      {"<!DOCTYPE html>" + std::string(200, ' '), "The content of the file is a web page"},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "Git LFS"},
      {"PK\3\4" + std::string(200, '\0'), "The content of the file is a zip archive"},
      {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "line 4"},
      {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0",
       "ends within a facet"},
      {"solid a\nfacet\nvertex 0 0 0\nfacet\n", "without an end"},
      {"solid a\nendsolid a\n", "no triangle"}};
  for (const auto& [text, says] : bad) {
    const auto loaded = load_text(text, "a.stl");
    ASSERT_FALSE(loaded) << says;
    EXPECT_THAT(loaded.error().detail, HasSubstr(says));
  }
}

std::string with_ends(std::string text, const std::string& end) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
    text.replace(at, 1, end);
  return text;
}

TEST(MeshStl, text_is_known_by_its_words_in_any_case_with_any_ends_of_lines_marks_and_comments) {
  const std::string plain =
      "solid pot\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid pot\n";
  std::string capitals = plain;
  for (char& c : capitals) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  std::string mixed = plain;
  mixed.replace(mixed.rfind("facet normal"), 12, "FACET Normal");
  std::string commented = "# made by hand, 1 vertex\n// solid\n" + plain;
  for (std::size_t at = 0; (at = commented.find("0\n", at)) != commented.npos; at += 20)
    commented.insert(at + 1, " # vertex 9 9 9");
  const std::string named = "solid " + std::string(3000, 'x') + plain.substr(5),
                    nameless = "solid" + plain.substr(9);
  const std::string padded = "solid pot" + std::string(90, '\0') + plain.substr(9);
  const std::string dos = plain + "\x1a";
  std::string utf16 = "\xff\xfe";
  for (const char c : plain) utf16 += std::string{c, '\0'};
  const std::pair<std::string, std::string> texts[] = {
      {"plain", plain},         {"capitals", capitals}, {"mixed", mixed},
      {"commented", commented}, {"long_name", named},   {"no_name", nameless},
      {"padded_name", padded},  {"dos", dos},           {"no_solid", plain.substr(10)}};
  for (const auto& [name, text] : texts)
    for (const std::string end : {"\n", "\r\n", "\r"})
      for (const std::string mark : {"", "\xef\xbb\xbf"}) {
        SCOPED_TRACE(name + std::to_string(end.size()) + (end[0] == '\r' ? " CR " : " LF ") +
                     std::to_string(mark.size()));
        const auto loaded = load_text(mark + with_ends(text, end), "a.stl");
        ASSERT_TRUE(loaded) << loaded.error().detail;
        EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
        EXPECT_NEAR(mesh::surface_area(loaded->mesh), 1, 1e-12);
      }
  const auto wide = load_text(utf16, "a.stl");
  ASSERT_TRUE(wide) << wide.error().detail;
  EXPECT_EQ(wide->mesh.triangle_count(), 2u);
}

TEST(MeshStl, a_binary_file_with_a_tail_is_none_of_text_though_its_header_has_the_words) {
  const auto loaded = load_text(binary_stl("solid facet vertex", 2, 2) + "tail", "a.stl");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
}

TEST(MeshStl, bytes_behind_the_last_triangle_are_reported) {
  const auto loaded = load_text(binary_stl("scanner", 1, 1) + "tail", "a.stl");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "ignored bytes after the last element"), 4u);
}

}  // namespace
