#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/io/load_formats.h"
#include "mesh/io/polygon.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;
using test::PlyWriter;
using testing::HasSubstr;

const std::string kSquare =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ascii(const std::string& declarations, const std::string& data) {
  return "ply\nformat ascii 1.0\n" + declarations + "end_header\n" + data;
}

class PlyEncodings : public testing::TestWithParam<PlyWriter::Encoding> {};
INSTANTIATE_TEST_SUITE_P(all, PlyEncodings,
                         testing::Values(PlyWriter::Encoding::ascii, PlyWriter::Encoding::little,
                                         PlyWriter::Encoding::big));

TEST_P(PlyEncodings, every_scalar_type_is_read_and_unknown_properties_are_passed_over) {
  PlyWriter file(
      GetParam(),
      "comment made by a test\nelement camera 1\nproperty int16 focal\nproperty list int8 float64 k\n"
      "element vertex 3\nproperty double x\nproperty list uint16 short extra\nproperty short y\nproperty int8 z\n"
      "property uint quality\nelement face 1\nproperty uint16 label\nproperty list ushort uint vertex_index\nproperty "
      "char side\n");
  file.put(std::int16_t{-5}).put(std::int8_t{2}).put(1.5).put(2.5);
  const double x[] = {433210.123456789, -0.1, 7};
  for (int i = 0; i < 3; ++i) {
    file.put(x[i])
        .put(std::uint16_t{1})
        .put(std::int16_t{9})
        .put(static_cast<std::int16_t>(-300 * i))
        .put(static_cast<std::int8_t>(-i * i));
    file.put(std::uint32_t{4000000000u});
  }
  file.put(std::uint16_t{7})
      .put(std::uint16_t{3})
      .put_all<std::uint32_t>({0, 1, 2})
      .put(std::int8_t{-1});
  const auto loaded = load_text(file.bytes(), "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(loaded->mesh.positions[0], glm::dvec3(433210.123456789, 0, 0));
  EXPECT_EQ(loaded->mesh.positions[1], glm::dvec3(-0.1, -300, -1));
  EXPECT_EQ(loaded->mesh.positions[2], glm::dvec3(7, -600, -4));
  EXPECT_TRUE(loaded->repairs.empty());
}

TEST_P(PlyEncodings, colours_of_every_type_become_bytes) {
  const auto colour_of = [&](const std::string& type, auto red, auto green, auto blue) {
    PlyWriter file(
        GetParam(),
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty " + type +
            " red\nproperty " + type + " green\nproperty " + type + " blue\n" + kFace);
    for (int i = 0; i < 3; ++i)
      file.put(1.0f * (i == 1)).put(1.0f * (i == 2)).put(0.0f).put(red).put(green).put(blue);
    file.put(std::uint8_t{3}).put_all({0, 1, 2});
    const auto loaded = load_text(file.bytes(), "a.ply");
    EXPECT_TRUE(loaded);
    return loaded ? loaded->mesh.vertex_colors.at(2) : 0u;
  };
  EXPECT_EQ(colour_of("uchar", std::uint8_t{255}, std::uint8_t{1}, std::uint8_t{128}), 0xff8001ffu);
  EXPECT_EQ(colour_of("ushort", std::uint16_t{65535}, std::uint16_t{257}, std::uint16_t{32896}),
            0xff8001ffu);
  EXPECT_EQ(colour_of("float", 1.0f, 0.2f, 0.0f), 0xff0033ffu);
  EXPECT_EQ(colour_of("float", 255.0f, 51.0f, 0.0f), 0xff0033ffu);
}

TEST_P(PlyEncodings, corner_and_vertex_texture_coordinates_are_read) {
  PlyWriter corners(
      GetParam(), kSquare + kFace + "property list uchar float texcoord\nproperty int texnumber\n");
  PlyWriter vertices(GetParam(), kSquare + "property float s\nproperty float t\n" + kFace);
  const float xy[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& p : xy) {
    corners.put(p[0]).put(p[1]).put(0.0f);
    vertices.put(p[0]).put(p[1]).put(0.0f).put(p[0] / 2).put(p[1] / 4);
  }
  corners.put(std::uint8_t{4}).put_all({0, 1, 2, 3}).put(std::uint8_t{8});
  for (const auto& p : xy) corners.put(p[0] / 2).put(p[1] / 4);
  corners.put(0);
  vertices.put(std::uint8_t{4}).put_all({0, 1, 2, 3});
  for (const std::string& bytes : {corners.bytes(), vertices.bytes()}) {
    const auto loaded = load_text(bytes, "a.ply");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    ASSERT_EQ(loaded->mesh.corner_uvs.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
      const glm::dvec3 p = loaded->mesh.positions[loaded->mesh.triangles[i]];
      EXPECT_EQ(loaded->mesh.corner_uvs[i], glm::vec2(p.x / 2, p.y / 4));
    }
    EXPECT_EQ(count_of(loaded->repairs, "polygons split into triangles"), 1u);
  }
}

TEST_P(PlyEncodings, triangle_strips_turn_every_second_triangle_and_restart_at_minus_one) {
  PlyWriter file(
      GetParam(),
      "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips "
      "1\nproperty list int int vertex_indices\n");
  const float xy[5][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {5, 5}};
  for (const auto& p : xy) file.put(p[0]).put(p[1]).put(0.0f);
  file.put(8).put_all({0, 1, 2, 3, -1, 1, 4, 3});
  const auto loaded = load_text(file.bytes(), "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 1, 4, 3}));
}

TEST_P(PlyEncodings, a_file_cut_anywhere_is_refused_and_never_read_beyond_its_end) {
  PlyWriter file(GetParam(), kSquare +
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\n" +
                                 kFace + "property list uchar float texcoord\n");
  for (int i = 0; i < 4; ++i)
    file.put(1.0f * (i & 1)).put(1.0f * (i >> 1)).put(0.25f).put_all<std::uint8_t>({1, 2, 3});
  file.put(std::uint8_t{3})
      .put_all({0, 1, 2})
      .put(std::uint8_t{6})
      .put_all({0.f, 0.f, 1.f, 0.f, 1.f, 1.f});
  ASSERT_TRUE(load_text(file.bytes(), "a.ply"));
  const std::size_t end = file.bytes().size() - (GetParam() == PlyWriter::Encoding::ascii ? 2 : 0);
  for (std::size_t size = 0; size < end; ++size) {
    // A heap block of exactly this size, so the sanitizer detects any read beyond its end.
    const std::vector<std::uint8_t> cut(file.bytes().begin(),
                                        file.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    Progress progress;
    const auto loaded = mesh::load_mesh_bytes(cut, "a.ply", progress);
    ASSERT_FALSE(loaded) << size;
    EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
  }
}

TEST(MeshPly, header_line_ends_may_be_crlf_or_cr) {
  const std::string data = "0 0 0\n1 0 0\n0 1 0\n1 1 1\n3 0 1 2\n";
  for (const std::string& end : {std::string("\r\n"), std::string("\r")}) {
    std::string text = ascii(kSquare + kFace, data), changed;
    for (char c : text) changed += c == '\n' ? end : std::string(1, c);
    const auto loaded = load_text(changed, "A.PLY");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count(), 1u);
  }
}

TEST(MeshPly, the_bytes_after_a_crlf_header_are_data_even_when_they_look_like_line_ends) {
  PlyWriter file(
      PlyWriter::Encoding::little,
      "element vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n" + kFace);
  file.put_all<std::uint8_t>({'\n', '\r', 0, 20, 0, 0, 0, 30, 0, 3}).put_all({0, 1, 2});
  std::string crlf;
  const std::size_t header = file.bytes().find("end_header\n") + 11;
  for (char c : file.bytes().substr(0, header))
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  crlf += file.bytes().substr(header);
  const auto loaded = load_text(crlf, "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions[0], glm::dvec3('\n', '\r', 0));
}

TEST(MeshPly, face_colours_are_spread_to_the_vertices) {
  const auto loaded =
      load_text(ascii(kSquare + "element face 2\nproperty list uchar int vertex_indices\nproperty "
                                "uchar red\nproperty uchar green\nproperty uchar blue\n",
                      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2 200 0 0\n3 1 3 2 100 0 0\n"),
                "a.ply");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->mesh.vertex_colors,
            (std::vector<std::uint32_t>{0xff0000c8u, 0xff000096u, 0xff000096u, 0xff000064u}));
  EXPECT_EQ(count_of(loaded->repairs, "face colours spread to vertices"), 4u);
}

TEST(MeshPly, faces_without_texture_coordinates_get_none_and_are_counted) {
  const auto loaded = load_text(
      ascii(
          kSquare +
              "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n",
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2 0\n3 1 3 2 6 .1 .1 .2 .1 nan .2\n"),
      "a.ply");
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->mesh.corner_uvs.empty());
}

TEST(MeshPly, a_face_of_more_corners_than_are_taken_is_refused_before_they_are_read) {
  PlyWriter file(PlyWriter::Encoding::little,
                 kSquare + "element face 1\nproperty list int uchar vertex_indices\n");
  for (int i = 0; i < 4; ++i) file.put(1.0f * (i & 1)).put(1.0f * (i >> 1)).put(0.25f);
  const int corners = static_cast<int>(mesh::kMaxPolygonCorners) + 1;
  file.put(corners);
  // These vertices do not exist, but the reader does not even read their indices.
  for (int i = 0; i < corners; ++i) file.put(std::uint8_t{9});
  const auto loaded = load_text(file.bytes(), "a.ply");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
  EXPECT_THAT(loaded.error().detail, HasSubstr("face 0 (byte"));
  EXPECT_THAT(loaded.error().detail, HasSubstr("more than 4096 corners"));
}

TEST(MeshPly, faces_may_stand_before_their_vertices) {
  const auto loaded =
      load_text(ascii(kFace + kSquare, "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"), "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(MeshPly, more_triangles_than_are_taken_are_refused_whatever_makes_them) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const std::string strip = "element tristrips 1\nproperty list int int vertex_indices\n";
  for (const std::string& text :
       {ascii(kSquare + strip, vertices + "8 0 1 2 3 0 1 2 3\n"),
        ascii(kSquare + "element face 2\nproperty list int int vertex_indices\n",
              vertices + "5 0 1 2 3 1\n5 0 1 2 3 1\n")}) {
    Progress progress;
    const auto most = mesh::parse_ply(*test::files_of({{"a.ply", text}}), progress, 6);
    ASSERT_TRUE(most) << most.error().detail;
    EXPECT_EQ(most->mesh.triangle_count(), 6u);
    const auto more = mesh::parse_ply(*test::files_of({{"a.ply", text}}), progress, 5);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().code, ErrorCode::invalid);
    EXPECT_THAT(more.error().detail, HasSubstr("more than 5 triangles"));
  }
}

TEST(MeshPly, words_that_a_line_has_more_than_the_header_says_are_passed_over_and_said) {
  const std::string texcoord = "property list uchar float texcoord\n",
                    other = "element other 2\nproperty int a\n";
  for (const std::string& end : {std::string("\n"), std::string("\r\n"), std::string("\r")}) {
    std::string
        text = ascii(
            kSquare + other + "element face 2\nproperty list uchar int vertex_indices\n" + texcoord,
            "0 0 0 255\n1 0 0\n0 1 0 255 255 \n1 1 0\n5 6\n7\n3 0 1 2 6 0 0 1 0 0 1 9 1 1 1\n\n"
            "3 1 3 2 6 1 0 1 1 0 1 9 1 1 1"),
        changed;
    for (const char c : text) changed += c == '\n' ? end : std::string(1, c);
    const auto loaded = load_text(changed, "a.ply");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(loaded->mesh.corner_uvs[4], glm::vec2(1, 1));
    EXPECT_EQ(count_of(loaded->repairs, "lines with more values than declared"), 5u);
  }
}

TEST(MeshPly, lists_may_be_folded_and_all_may_stand_in_one_line) {
  for (const std::string data :
       {"0 0 0\n1 0 0\n0 1 0\n1 1 0\n3\n0 1\n2\n", "0 0 0 1 0 0 0 1 0 1 1 0 3 0 1 2\n",
        "0\n0\n0\n1 0\n0\n0 1 0\n1 1 0\n3 0 1 2", "0 0\n0 1\n0 0\n0 1\n0 1\n1 0\n3 0\n1 2\n"}) {
    const auto loaded = load_text(ascii(kSquare + kFace, data), "a.ply");
    ASSERT_TRUE(loaded) << data << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(count_of(loaded->repairs, "lines with more values than declared"), 0u);
  }
}

TEST(MeshPly, header_lines_may_be_long_and_many_and_follow_a_byte_order_mark) {
  std::string comments = "comment " + std::string(100'000, 'x') + "\n";
  for (int i = 0; i < 20'000; ++i) comments += "comment " + std::to_string(i) + "\n";
  const std::string text =
      ascii(comments + kSquare + kFace, "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n");
  for (const std::string& file : {text, "\xef\xbb\xbf" + text}) {
    const auto loaded = load_text(file, "a.ply");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count(), 1u);
  }
}

struct BadPly {
  std::string name, bytes, says;
  friend std::ostream& operator<<(std::ostream& out, const BadPly& bad) { return out << bad.name; }
};
class MalformedPly : public testing::TestWithParam<BadPly> {};

TEST_P(MalformedPly, is_refused_with_its_place) {
  const auto loaded = load_text(GetParam().bytes, "a.ply");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
  EXPECT_EQ(loaded.error().title, "Mesh file refused");
  EXPECT_THAT(loaded.error().detail, HasSubstr(GetParam().says));
}

const std::string kFour = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
INSTANTIATE_TEST_SUITE_P(
    all, MalformedPly,
    testing::Values(
        BadPly{"empty", "", "empty"}, BadPly{"other_file", "hello\n", "not a PLY"},
        BadPly{"stl", "solid stl\n", "The content of the file is an STL file"},
        BadPly{"no_end", "ply\nformat ascii 1.0\n", "end_header"},
        BadPly{"no_end_in_16_mb", "ply\ncomment " + std::string(17u << 20, 'x') + "\n",
               "in its first 16 MB"},
        BadPly{"many_elements",
               [] {
                 std::string text;
                 for (int i = 0; i <= 1000; ++i) text += "element e" + std::to_string(i) + " 0\n";
                 return ascii(text, "");
               }(),
               "more than 1000 elements"},
        BadPly{"surplus_not_a_number",
               ascii(kSquare + kFace, "0 0 0 9\n1 0 0\n0 1 0\n1 1 zero\n3 0 1 2\n"),
               "vertex 3 of 4 (line 13)"},
        BadPly{"bad_format", "ply\nformat binary_middle_endian 1.0\nend_header\n", "line 2"},
        BadPly{"no_format", "ply\nelement vertex 0\nend_header\n", "format"},
        BadPly{"bad_type", ascii("element vertex 1\nproperty quad x\n", "1"),
               "line 4: unknown type \"quad\""},
        BadPly{"float_count",
               ascii("element face 1\nproperty list float int vertex_indices\n", "1"),
               "type of a list's count"},
        BadPly{"early_property", ascii("property int x\n", ""), "before the first element"},
        BadPly{"twice", ascii("element vertex 1\nelement vertex 1\n", ""), "declared twice"},
        BadPly{"negative_count", ascii("element vertex -1\n", ""), "line 3"},
        BadPly{"no_z", ascii("element vertex 1\nproperty int x\nproperty int y\n", "1 2\n"),
               "no properties x, y and z"},
        BadPly{"lying_count",
               ascii("element vertex 4000000000\nproperty int x\nproperty int y\nproperty int z\n" +
                         kFace,
                     kFour),
               "4000000000"},
        BadPly{
            "huge_count",
            ascii(
                "element vertex 9000000000000000000\nproperty int x\nproperty int y\nproperty int z\n" +
                    kFace,
                kFour),
            "9000000000000000000"},
        BadPly{"long_list", ascii(kSquare + kFace, kFour + "250 0 1 2\n"),
               "face 0 of 1 (line 14) has an invalid length"},
        BadPly{"negative_list",
               ascii(kSquare + "element face 1\nproperty list char int vertex_indices\n",
                     kFour + "-3 0 1 2\n"),
               "invalid length"},
        BadPly{"not_a_number", ascii(kSquare + kFace, "0 0 0\n1 zero 0\n0 1 0\n1 1 0\n3 0 1 2\n"),
               "vertex 1 of 4 (line 11)"},
        BadPly{"negative_index", ascii(kSquare + kFace, kFour + "3 0 -1 2\n"),
               "refers to vertex -1, but the file has 4"},
        BadPly{"large_index", ascii(kSquare + kFace, kFour + "3 0 1 4\n"),
               "Face 0 (line 14) refers to vertex 4"},
        BadPly{"faces_first_that_lie", ascii(kFace + kSquare, "3 0 1 4\n" + kFour),
               "refers to vertex 4"},
        BadPly{"no_indices", ascii(kSquare + "element face 1\nproperty int x\n", kFour + "1\n"),
               "vertex_indices"},
        BadPly{"points_only",
               ascii(kSquare + "element face 0\nproperty list uchar int vertex_indices\n", kFour),
               "4 vertices but no triangle"},
        BadPly{"nothing",
               ascii("element vertex 0\nproperty int x\nproperty int y\nproperty int z\n", ""),
               "no triangle"},
        BadPly{"flat", ascii(kSquare + kFace, "0 0 0\n1 0 0\n2 0 0\n1 1 0\n3 0 1 2\n"),
               "No triangle of the file has an area"},
        BadPly{"nan", ascii(kSquare + kFace, "0 0 0\n1 nan 0\n0 1 -inf\n1 1 0\n3 0 1 2\n"),
               "2 vertices that triangles use"},
        BadPly{"too_far", ascii(kSquare + kFace, "0 0 0\n1e200 0 0\n0 1 0\n1 1 0\n3 0 1 2\n"),
               "1 vertices that triangles use have a coordinate beyond"},
        BadPly{"too_small", ascii(kSquare + kFace, "0 0 0\n1e-13 0 0\n0 1e-13 0\n1 1 0\n3 0 1 2\n"),
               "smaller than"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
