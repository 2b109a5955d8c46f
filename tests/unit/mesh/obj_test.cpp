#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/io/load_formats.h"
#include "mesh/io/plain_text.h"
#include "mesh/io/polygon.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;
using testing::HasSubstr;

TEST(MeshObj, all_corner_forms_negative_indices_continuations_and_crlf_are_read) {
  Progress progress;
  const std::vector<std::pair<std::string, std::string>> texts{
      {"a.OBJ",
       "# comment\r\nmtllib none.mtl\r\no first\r\nv 0 0 0\r\nv 1 0 0 1.0\r\nv 0 1 0\r\nvt 0 0\r\nvt 1 0 0\r\nvt "
       ".5\r\nvn 0 0 1\r\n"
       "usemtl stone\r\nf 1/1 2/2 3/3 # trailing\r\no second\r\ng a b\r\nv 0 0 2\r\nv 1 0 2\r\nv 0 1 2\r\n"
       "f -3/-3/1 \\\r\n  -2/-2/1 \\\r\n -1/-1/-1\r\nf 1//1 2//1 6//1\r\nf 4 5 2\r\n"}};
  const auto files = test::files_of(texts);
  const auto loaded = mesh::parse_obj(*files, progress);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangles,
            (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 0, 1, 5, 3, 4, 1}));
  EXPECT_EQ(loaded->mesh.corner_uvs[2], glm::vec2(0.5f, 0));
  EXPECT_EQ(loaded->mesh.corner_uvs[4], glm::vec2(1, 0));
  EXPECT_EQ(loaded->mesh.corner_uvs[6], glm::vec2(0, 0));
  EXPECT_EQ(count_of(loaded->repairs, "triangles without texture coordinates"), 2u);
  EXPECT_EQ(count_of(loaded->repairs, "materials without a definition"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "materials not among the files: none.mtl"), 1u);
}

TEST(MeshObj, a_face_may_name_vertices_that_follow_it) {
  const auto loaded = load_text("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->mesh.triangle_count(), 1u);
}

TEST(MeshObj, a_face_of_more_corners_than_are_taken_is_refused_before_they_are_read) {
  std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (std::size_t i = 0; i < mesh::kMaxPolygonCorners; ++i) face += i % 2 == 0 ? " 1" : " 2";
  EXPECT_TRUE(load_text(face + "\nf 1 2 3\n", "a.obj"));
  const auto loaded = load_text(face + " no_corner\nf 1 2 3\n", "a.obj");
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("The face at line 4 has more than 4096 corners"));
}

TEST(MeshObj, colours_may_be_shares_or_bytes) {
  const auto shares = load_text("v 0 0 0 1 0 .2\nv 1 0 0 0 1 0\nv 0 1 0 0 0 0\nf 1 2 3\n", "a.obj");
  const auto bytes =
      load_text("v 0 0 0 1 0 0\nv 1 0 0 0 255 0\nv 0 1 0 51 0 7\nf 1 2 3\n", "a.obj");
  const auto partly = load_text("v 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
  ASSERT_TRUE(shares && bytes && partly);
  EXPECT_EQ(shares->mesh.vertex_colors,
            (std::vector<std::uint32_t>{0xff3300ffu, 0xff00ff00u, 0xff000000u}));
  EXPECT_EQ(bytes->mesh.vertex_colors,
            (std::vector<std::uint32_t>{0xff000001u, 0xff00ff00u, 0xff070033u}));
  EXPECT_EQ(partly->mesh.vertex_colors,
            (std::vector<std::uint32_t>{0xffffffffu, 0xff00ff00u, 0xffffffffu}));
  EXPECT_EQ(count_of(partly->repairs, "vertices without colour"), 2u);
}

TEST(MeshObj, numbers_may_carry_a_plus_and_an_exponent_and_stay_double) {
  const auto loaded =
      load_text("v +433210.123456789 -1E+1 1e-400\nv 1 0 0\nv 0 1 0\nf +1 2 3\n", "a.obj");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions[0], glm::dvec3(433210.123456789, -10, 0));
}

TEST(MeshObj, a_concave_polygon_keeps_its_area_and_winding) {
  // An L-shape from above and from below, and a comb on which some convex corners are not ears.
  for (const std::string face : {"f 1 2 3 4 5 6\n", "f 6 5 4 3 2 1\n", "f 3 4 5 6 1 2\n"}) {
    const auto loaded =
        load_text("v 0 0 5\nv 3 0 5\nv 3 1 5\nv 1 1 5\nv 1 3 5\nv 0 3 5\n" + face, "a.obj");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->mesh.triangle_count(), 4u);
    EXPECT_NEAR(mesh::surface_area(loaded->mesh), 5, 1e-12);
    for (std::size_t i = 0; i < 12; i += 3) {
      const auto at = [&](std::size_t k) {
        return loaded->mesh.positions[loaded->mesh.triangles[i + k]];
      };
      EXPECT_EQ(glm::cross(at(1) - at(0), at(2) - at(0)).z > 0, face[2] != '6');
    }
  }
  const auto comb = load_text(
      "v 0 0 0\nv 9 0 1\nv 9 5 1\nv 7 1 .7\nv 5 5 .5\nv 3 1 .3\nv 1 5 .1\nf 1 2 3 4 5 6 7\n",
      "a.obj");
  ASSERT_TRUE(comb);
  const double flat_area = 26.5;  // area of the comb in the xy plane, by the shoelace formula
  EXPECT_NEAR(mesh::surface_area(comb->mesh), flat_area, flat_area * 0.02);
}

TEST(MeshObj, an_outline_that_crosses_itself_still_gives_its_triangles) {
  std::vector<glm::dvec3> star;
  for (int i = 0; i < 5; ++i)
    star.emplace_back(std::cos(i * 4 * M_PI / 5), std::sin(i * 4 * M_PI / 5), 0);
  std::vector<std::uint32_t> triangles;
  mesh::triangulate_polygon(star, triangles);
  EXPECT_EQ(triangles.size(), 9u);
  for (std::uint32_t corner : triangles) EXPECT_LT(corner, 5u);
  const std::vector<glm::dvec3> spot(6, glm::dvec3(1));
  mesh::triangulate_polygon(spot, triangles);
  EXPECT_EQ(triangles.size(), 12u);
}

TEST(MeshObj, lines_and_two_cornered_faces_are_dropped_and_counted) {
  const auto loaded =
      load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nl 1 2 3\np 1\nf 1 2 3\n", "a.obj");
  ASSERT_TRUE(loaded);
  EXPECT_EQ(count_of(loaded->repairs, "dropped faces with fewer than three corners"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "ignored lines, points, curves and free-form surfaces"), 2u);
}

TEST(MeshObj,
     faces_that_name_texture_coordinates_or_normals_which_are_not_there_are_read_without_them) {
  const auto loaded = load_text(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/2 4/4/2\n",
      "a.obj");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
  EXPECT_EQ(loaded->mesh.corner_uvs[1], glm::vec2(1, 0));
  EXPECT_EQ(
      count_of(loaded->repairs, "faces that refer to texture coordinates missing from the file"),
      1u);
  EXPECT_EQ(count_of(loaded->repairs, "faces that refer to normals missing from the file"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "triangles without texture coordinates"), 1u);
  // Without `vt` and `vn`, references to them are invalid. Negative indices count from the end.
  const auto none = load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/-3/-3 -2/-2/-2 -1/-1/-1\n", "a.obj");
  ASSERT_TRUE(none) << none.error().detail;
  EXPECT_TRUE(none->mesh.corner_uvs.empty());
  EXPECT_EQ(
      count_of(none->repairs, "faces that refer to texture coordinates missing from the file"), 1u);
  EXPECT_EQ(count_of(none->repairs, "faces that refer to normals missing from the file"), 1u);
}

// Returns UTF-16 with its byte order mark, including characters of two units.
std::string utf16(const std::u16string& text, bool big_endian) {
  std::string bytes;
  for (const char16_t unit : u"\ufeff" + text) {
    const char low = static_cast<char>(unit & 255), high = static_cast<char>(unit >> 8);
    bytes += big_endian ? high : low;
    bytes += big_endian ? low : high;
  }
  return bytes;
}

TEST(MeshObj, line_ends_and_encodings_of_an_obj_and_its_mtl_make_no_difference) {
  const std::u16string obj =
      u"# caf\u00e9 \U0001F3FA\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 \\\n0\nusemtl T\u00f6pferei \U0001F3FA\nf 1 2 3\n";
  const std::u16string mtl = u"newmtl T\u00f6pferei \U0001F3FA\nKd 1 0 0\n";
  const auto with_ends = [](std::u16string text, const std::u16string& end) {
    for (std::size_t at = 0; (at = text.find(u'\n', at)) != text.npos; at += end.size())
      text.replace(at, 1, end);
    return text;
  };
  const auto utf8 = [](const std::u16string& text) {
    const std::string bytes = utf16(text, false);
    const mesh::PlainText plain(
        {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return std::string(plain.bytes().begin(), plain.bytes().end());
  };
  EXPECT_EQ(utf8(u"\u00e9\U0001F3FA\u20ac"), "\u00e9\U0001F3FA\u20ac");
  EXPECT_EQ(utf8(u"a\xd83c"), "a\ufffd") << "half of a pair";
  for (const std::u16string end : {u"\n", u"\r\n", u"\r"})
    for (int encoding = 0; encoding < 4; ++encoding) {
      SCOPED_TRACE(std::to_string(end.size()) + (end[0] == u'\r' ? " CR " : " LF ") +
                   std::to_string(encoding));
      const auto encoded = [&](const std::u16string& text) {
        const std::u16string ended = with_ends(text, end);
        if (encoding < 2) return (encoding == 0 ? "" : "\xef\xbb\xbf") + utf8(ended);
        return utf16(ended, encoding == 3);
      };
      const auto loaded = test::load_texts({{"a.obj", encoded(obj)}, {"a.mtl", encoded(mtl)}});
      ASSERT_TRUE(loaded) << loaded.error().detail;
      EXPECT_EQ(loaded->mesh.triangle_count(), 1u);
      ASSERT_EQ(loaded->mesh.materials.size(), 1u);
      EXPECT_EQ(loaded->mesh.materials[0].color, glm::vec4(1, 0, 0, 1));
      EXPECT_EQ(loaded->mesh.triangle_materials, std::vector<std::uint16_t>{0});
      EXPECT_TRUE(loaded->repairs.empty());
    }
}

struct BadObj {
  std::string name, bytes, says;
  friend std::ostream& operator<<(std::ostream& out, const BadObj& bad) { return out << bad.name; }
};
class MalformedObj : public testing::TestWithParam<BadObj> {};

TEST_P(MalformedObj, is_refused_with_its_line) {
  const auto loaded = load_text(GetParam().bytes, "a.obj");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
  EXPECT_THAT(loaded.error().detail, HasSubstr(GetParam().says));
}

std::string huge_polygon() {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 5000; ++i) text += " " + std::to_string(i % 3 + 1);
  return text + "\n";
}

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
INSTANTIATE_TEST_SUITE_P(
    all, MalformedObj,
    testing::Values(
        BadObj{"empty", "", "empty"}, BadObj{"other", "hello\n", "neither vertices nor faces"},
        BadObj{"points", kThree, "3 vertices but no triangle"},
        BadObj{"index", kThree + "\nf 1 2 4\n",
               "Line 5: the face refers to vertex 4, but the file has 3"},
        BadObj{"zero", kThree + "f 0 1 2\n", "vertex 0"},
        BadObj{"relative", "v 0 0 0\nf -1 -2 -3\nv 0 0 1\nv 1 1 1\n", "(1 above this line)"},
        BadObj{"lowest", kThree + "f -9223372036854775808 1 2\n", "Line 4"},
        BadObj{"beyond", kThree + "f 99999999999999999999 1 2\n", "Line 4"},
        BadObj{"word", kThree + "f a b c\n", "\"a\" is not a corner of a face"},
        BadObj{"uv", kThree + "vt 0 0\nf 1/1 2/x 3/1\n", "\"2/x\" is not a corner of a face"},
        BadObj{"cr", "v 0 0 0\rv 1 x 0\rv 0 1 0\rf 1 2 3\r", "Line 2"},
        BadObj{"ply", "ply\nformat ascii 1.0\n", "The content of the file is a PLY file"},
        BadObj{"web_page", "\n<!DOCTYPE html><p>v 1</p>", "The content of the file is a web page"},
        BadObj{"number", "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n", "Line 2"},
        BadObj{"after_continuation", "v 0 \\\n0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n", "Line 3"},
        BadObj{"two_numbers", "v 0 0\nf 1 1 1\n", "needs three numbers"},
        BadObj{"nan", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "1 vertices"},
        BadObj{"corners", huge_polygon(), "more than 4096 corners"},
        BadObj{"last_backslash", kThree + "f 1 2 \\", "no triangle"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
