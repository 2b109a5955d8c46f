#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "media/picture.h"
#include "mesh/io/mtl.h"
#include "support/mesh_files.h"
#include "support/zip_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_texts;
using testing::HasSubstr;

std::string png_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  const std::vector<std::uint8_t> rgba{red, green, blue, 255};
  const auto png = encode_png(rgba, 1, 1);
  return {png.begin(), png.end()};
}

const std::string kRed = png_of(200, 0, 0), kBlue = png_of(0, 0, 200);
const std::string kVertices =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\n";
const std::string kTwoFaces = "usemtl left\nf 1/1 2/2 3/3\nusemtl right side\nf 1/1 3/3 4/4\n";

std::vector<mesh::MtlMaterial> parse(const std::string& text) {
  return mesh::parse_mtl({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, 100);
}

TEST(Mtl, colours_options_and_names_with_blanks_are_read) {
  const auto materials = parse(
      "# comment\r\nKd 1 1 1\r\nnewmtl a stone\r\nKa 1 1 1\r\nKd 0.25 0.5 \\\r\n 0.75\r\nd 0.5\r\n"
      "map_Kd -blendu on -s 2 3 1 -o 0.5 -mm 0 1 -clamp on  my photo 1.JPG \r\nmap_Bump ignored.png\r\n"
      "newmtl plain\nTr 0.25\nKd spectral file.rfl 1\nmap_Kd -t 1 1 1\n");
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_EQ(materials[0].name, "a stone");
  EXPECT_EQ(materials[0].color, glm::vec4(0.25, 0.5, 0.75, 0.5));
  EXPECT_EQ(materials[0].texture, "my photo 1.JPG");
  EXPECT_EQ(materials[0].uv_scale, glm::vec2(2, 3));
  EXPECT_EQ(materials[0].uv_offset, glm::vec2(0.5, 0));
  EXPECT_TRUE(materials[0].clamp);
  EXPECT_EQ(materials[1].color, glm::vec4(1, 1, 1, 0.75));
  EXPECT_EQ(materials[1].texture, "");
}

TEST(ObjMaterials, each_triangle_knows_its_texture_wherever_that_lay_on_another_machine) {
  const auto loaded = load_texts(
      {{"scan/obj/pot.obj", "mtllib my materials.mtl\n" + kVertices + kTwoFaces},
       {"scan/obj/My Materials.mtl",
        "newmtl left\nmap_Kd C:\\photos\\a\\SKIN.png\nnewmtl right side\nmap_Kd -clamp on ../b/skin.png\n"},
       {"scan/b/skin.png", kBlue},
       {"scan/a/skin.png", kRed}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& mesh = loaded->mesh;
  EXPECT_TRUE(loaded->repairs.empty());
  EXPECT_EQ(mesh.triangle_materials, (std::vector<std::uint16_t>{0, 1}));
  ASSERT_EQ(mesh.textures.size(), 2u);
  EXPECT_EQ(mesh.textures[mesh.materials[0].texture].name, "scan/a/skin.png");
  EXPECT_EQ(mesh.textures[mesh.materials[1].texture].name, "scan/b/skin.png");
  EXPECT_EQ(mesh.materials[1].wrap_u, mesh::Wrap::clamp);
}

TEST(ObjMaterials, lines_of_the_report_are_at_most_as_long_as_the_contract_allows) {
  const std::string name(5000, 'n');
  const auto loaded =
      load_texts({{"pot.obj", "mtllib " + name + ".mtl\n" + kVertices + kTwoFaces},
                  {"pot.mtl", "newmtl left\nmap_Kd " + name + ".jpg\nnewmtl right side\n"}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_FALSE(loaded->repairs.empty());
  for (const Repair& repair : loaded->repairs) EXPECT_LE(repair.what.size(), 1000u) << repair.what;
}

TEST(ObjMaterials, pictures_that_are_missing_or_no_pictures_are_named) {
  const auto loaded =
      load_texts({{"pot.obj", kVertices + kTwoFaces},
                  {"pot.mtl", "newmtl left\nmap_Kd lost.jpg\nnewmtl right side\nmap_Kd text.png\n"},
                  {"text.png", "not a picture"}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_TRUE(loaded->mesh.textures.empty());
  EXPECT_EQ(count_of(loaded->repairs, "texture not among the files: lost.jpg"), 1u);
  ASSERT_EQ(loaded->repairs.size(), 2u);
  EXPECT_THAT(
      loaded->repairs[1].what,
      HasSubstr(
          "texture not read: text.png: The picture is not a JPEG, PNG, TIFF, WebP, BMP or TGA"));
}

TEST(ObjMaterials, names_in_another_encoding_are_found_and_told_as_utf8) {
  const auto loaded = load_texts(
      {{"pot.obj", kVertices + kTwoFaces},
       {"pot.mtl", "newmtl left\nmap_Kd Gr\xfcn.png\nnewmtl right side\nmap_Kd Wei\xdf.png\n"},
       {"Gr\ufffdn.png", kBlue}});  // the name as a form sends it
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->mesh.textures.size(), 1u);
  EXPECT_EQ(loaded->mesh.textures[0].name, "Gr\ufffdn.png");
  EXPECT_EQ(count_of(loaded->repairs, "texture not among the files: Wei\ufffd.png"), 1u);
}

TEST(ObjMaterials, the_only_picture_is_taken_where_nothing_names_one) {
  const auto loaded = load_texts({{"pot.obj", kVertices + "f 1/1 2/2 3/3\n"}, {"photo.png", kRed}});
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->mesh.textures.size(), 1u);
  EXPECT_EQ(loaded->mesh.triangle_materials, (std::vector<std::uint16_t>{0}));
  EXPECT_EQ(count_of(loaded->repairs, "texture taken because it is the only picture: photo.png"),
            1u);
}

TEST(ObjMaterials, udim_tiles_are_found_by_where_triangles_lie) {
  const auto loaded = load_texts(
      {{"pot.obj",
        "mtllib pot.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 1.1 2.1\nvt 1.9 2.1\nvt 1.9 2.9\nvt 0.1 0.1\n"
        "vt 0.9 0.9\nvt 0.1 0.9\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n"},
       {"pot.mtl", "newmtl skin\nmap_Kd skin.<UDIM>.png\n"},
       {"skin.1001.png", kRed},
       {"skin.1022.png", kBlue}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& mesh = loaded->mesh;
  EXPECT_TRUE(loaded->repairs.empty());
  const auto texture = [&](int triangle) {
    return mesh.textures.at(mesh.materials[mesh.triangle_materials[triangle]].texture).name;
  };
  EXPECT_EQ(texture(0), "skin.1022.png");
  EXPECT_EQ(texture(1), "skin.1001.png");
}

TEST(PlyMaterials, faces_choose_among_the_named_files_by_texnumber) {
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment TextureFile red one.png\ncomment TextureFile blue.png\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nelement face 3\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nproperty int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
      "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 1 1 0 1 0\n3 0 1 3 6 0 0 1 0 1 1 7\n";
  const auto loaded = load_texts({{"a.ply", ply}, {"red one.png", kRed}, {"blue.png", kBlue}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_materials, (std::vector<std::uint16_t>{1, 0, mesh::kNoMaterial}));
  EXPECT_EQ(loaded->mesh.textures.size(), 2u);
}

TEST(Archive, a_zip_of_a_scan_is_read_with_its_textures) {
  const auto loaded = load_texts(
      {{"pot.ZIP", test::zip_of({{"__MACOSX/pot/._pot.obj", "v"},
                                 {"pot/readme.txt", "hello"},
                                 {"pot/", ""},
                                 {"pot/.hidden.ply", "x"},
                                 {"../../pot/pot.obj", "mtllib pot.mtl\n" + kVertices + kTwoFaces},
                                 {"pot/pot.mtl", "newmtl left\nmap_Kd a/skin.png\n"},
                                 {"pot/a/skin.png", kRed}})}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
  EXPECT_EQ(loaded->mesh.textures.size(), 1u);
}

TEST(Archive, what_is_no_single_scan_is_refused) {
  const std::string obj = kVertices + "f 1 2 3\n";
  const std::string zip = test::zip_of({{"a.obj", obj}});
  const std::pair<std::string, std::string> bad[] = {
      {test::zip_of({{"a.obj", obj}, {"b/c.ply", "ply"}}), "a.obj, b/c.ply"},
      {test::zip_of({{"a/mesh.obj", obj}, {"b/mesh.obj", obj}}), "a/mesh.obj, b/mesh.obj"},
      {test::zip_of({{"a.jpg", kRed}}), "In the zip: "},
      {test::zip_of({{"readme.txt", "text"}}), "The upload contains no file to import"},
      {test::zip_of({{"inner.zip", zip}}), "another zip"},
      {"", "empty"},
      {"no zip at all", "cannot be opened"},
      {zip.substr(0, zip.size() / 2), "cannot be opened"},
      {test::zip_of({{"a.ply", std::string(64 << 20, '\0')}}),
       "more than 100 times as large as the zip"}};
  for (const auto& [bytes, says] : bad) {
    const auto loaded = load_texts({{"a.zip", bytes}});
    ASSERT_FALSE(loaded) << says;
    EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
    EXPECT_THAT(loaded.error().detail, HasSubstr(says));
  }
}

TEST(Archive, damaged_content_is_refused) {
  std::string zip = test::zip_of({{"a.obj", kVertices + "f 1 2 3\n"}});
  zip[40] = static_cast<char>(zip[40] ^ 0x55);
  zip[45] = static_cast<char>(zip[45] ^ 0x55);
  const auto loaded = load_texts({{"a.zip", zip}});
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("cannot be unpacked"));
}

}  // namespace
