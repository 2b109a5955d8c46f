#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <functional>
#include <map>

#include "media/picture.h"
#include "mesh/io/gltf/gltf_uri.h"
#include "mesh/io/load_formats.h"
#include "support/glb.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using test::count_of;
using test::load_text;
using test::load_texts;
using testing::HasSubstr;

constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;
const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<std::uint16_t> kTwoTriangles{0, 1, 2, 0, 2, 3};

test::GltfBuilder square() {
  test::GltfBuilder builder;
  const int positions = builder.add(kSquare, kFloat, "VEC3"),
            indices = builder.add(kTwoTriangles, kShort, "SCALAR");
  builder.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
  return builder;
}

std::string dot_png() {
  const std::vector<std::uint8_t> rgba{200, 100, 50, 255};
  const auto png = encode_png(rgba, 1, 1);
  return {png.begin(), png.end()};
}

TEST(MeshGltf, a_glb_is_in_metres_with_y_up) {
  const auto loaded = load_text(square().glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(loaded->mesh.positions[2], glm::dvec3(1, 1, 0));
  EXPECT_EQ(loaded->unit, Unit::m);
  EXPECT_EQ(loaded->up, "y");
  EXPECT_TRUE(loaded->repairs.empty());
}

TEST(MeshGltf, data_may_lie_beside_the_file_or_in_a_uri) {
  const auto builder = square();
  const auto beside = load_texts({{"scan/a.gltf", builder.gltf("data%20of%20a.bin")},
                                  {"scan/data of a.bin", builder.binary()}});
  ASSERT_TRUE(beside) << beside.error().detail;
  EXPECT_EQ(beside->mesh.triangle_count(), 2u);
  const auto missing = load_texts({{"a.gltf", builder.gltf("a.bin")}});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().detail,
              HasSubstr("\"a.bin\", but the upload does not contain this file"));
  const auto cut =
      load_texts({{"a.gltf", builder.gltf("a.bin")}, {"a.bin", builder.binary().substr(0, 30)}});
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().detail, HasSubstr("60 bytes, but has 30"));

  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i < builder.binary().size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < builder.binary().size() ? static_cast<std::uint8_t>(builder.binary()[i + k])
                                             : 0u;
    };
    const std::uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (int k = 3; k >= 0; --k) base64 += kDigits[bits >> (6 * k) & 63];
  }
  const auto inside =
      load_text(builder.gltf("data:application/octet-stream;base64," + base64), "a.gltf");
  ASSERT_TRUE(inside) << inside.error().detail;
  EXPECT_EQ(inside->mesh.positions, beside->mesh.positions);
}

TEST(MeshGltf, base64_and_percent_encoding_are_decoded) {
  EXPECT_EQ(mesh::decode_data_uri("data:;base64,TWFu"), (std::vector<std::uint8_t>{'M', 'a', 'n'}));
  EXPECT_EQ(mesh::decode_data_uri("data:;base64,TWE="), (std::vector<std::uint8_t>{'M', 'a'}));
  EXPECT_FALSE(mesh::decode_data_uri("data:;base64,T"));
  EXPECT_FALSE(mesh::decode_data_uri("data:;base64,T!Fu"));
  EXPECT_FALSE(mesh::decode_data_uri("data:text/plain,TWFu"));
}

TEST(MeshGltf, transforms_of_nodes_are_applied_in_double) {
  auto builder = square();
  builder.json["nodes"] = {
      {{"translation", {433210.123456, 4581234.567891, 612.25}}, {"children", {1}}},
      {{"mesh", 0}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, {"scale", {2, 1, 1}}}};
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  // (1, 0, 0) is doubled along x and rotated to y.
  EXPECT_NEAR(loaded->mesh.positions[1].x, 433210.123456, 1e-9);
  EXPECT_NEAR(loaded->mesh.positions[1].y, 4581236.567891, 1e-9);
  EXPECT_EQ(loaded->mesh.positions[1].z, 612.25);
}

TEST(MeshGltf, a_mirrored_instance_turns_its_triangles) {
  auto builder = square();
  builder.json["scenes"][0]["nodes"] = {0, 1};
  builder.json["nodes"] = {{{"mesh", 0}},
                           {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {-5, 0, 0}}}};
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded->mesh.triangle_count(), 4u);
  for (std::size_t i = 0; i < 12; i += 3) {
    const auto& p = loaded->mesh.positions;
    const auto& t = loaded->mesh.triangles;
    EXPECT_GT(glm::cross(p[t[i + 1]] - p[t[i]], p[t[i + 2]] - p[t[i]]).z, 0);
  }
}

TEST(MeshGltf, strips_and_fans_and_plain_lists_make_the_same_square) {
  for (const auto& [mode, indices] : std::map<int, std::vector<std::uint32_t>>{
           {4, {0, 1, 3, 1, 2, 3}}, {5, {0, 1, 3, 2}}, {6, {0, 1, 2, 3}}}) {
    auto builder = square();
    auto& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive["indices"] = builder.add(indices, kInt, "SCALAR");
    const auto loaded = load_text(builder.glb(), "a.glb");
    ASSERT_TRUE(loaded) << loaded.error().detail;
    EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
    EXPECT_NEAR(mesh::surface_area(loaded->mesh), 1, 1e-12);
    EXPECT_TRUE(loaded->repairs.empty()) << mode;
  }
}

TEST(MeshGltf, whole_numbers_are_normalised_and_strides_and_sparse_values_followed) {
  auto builder = square();
  const std::vector<std::uint8_t> interleaved{0,   0,   0, 9, 255, 0,   0, 9,
                                              255, 255, 0, 9, 0,   255, 0, 9};
  const int positions = builder.add(interleaved, kByte, "SCALAR", true);
  builder.json["bufferViews"].back()["byteStride"] = 4;
  auto& accessor = builder.json["accessors"][positions];
  accessor["type"] = "VEC3";
  accessor["count"] = 4;
  const std::vector<std::uint16_t> where{2};
  const std::vector<std::uint8_t> what{255, 255, 255};
  accessor["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", builder.add_view(where.data(), 2)}, {"componentType", kShort}}},
      {"values", {{"bufferView", builder.add_view(what.data(), 3)}}}};
  builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions;
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions[1], glm::dvec3(1, 0, 0));
  EXPECT_EQ(loaded->mesh.positions[2], glm::dvec3(1, 1, 1));
}

TEST(MeshGltf, a_material_chooses_its_texture_coordinates_and_transforms_them) {
  auto builder = square();
  const std::string png = dot_png();
  const int image = builder.add_view(png.data(), png.size());
  auto& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = builder.add(std::vector<float>(8, 0.25f), kFloat, "VEC2");
  attributes["TEXCOORD_1"] =
      builder.add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, kFloat, "VEC2");
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.json["images"] = {{{"bufferView", image}, {"mimeType", "image/png"}, {"name", "photo"}}};
  builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const nlohmann::json transform = {{"offset", {0.5, 0.25}},
                                    {"scale", {2, 4}},
                                    {"rotation", 1.5707963267948966},
                                    {"texCoord", 1}};
  builder.json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 0.5, 0, 1}},
         {"baseColorTexture",
          {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}}};
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& mesh = loaded->mesh;
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(std::string(mesh.textures[0].bytes.begin(), mesh.textures[0].bytes.end()), png);
  EXPECT_EQ(mesh.materials[0].wrap_u, mesh::Wrap::clamp);
  EXPECT_EQ(mesh.materials[0].wrap_v, mesh::Wrap::mirror);
  EXPECT_NEAR(mesh.materials[0].color.g, 0.7354, 1e-3) << "0.5 of the light, as pictures store it";
  // u = 1 is scaled to 2, rotated counter-clockwise by 90° (to v = −2, because v points down), and
  // moved.
  EXPECT_NEAR(mesh.corner_uvs[1].x, 0.5, 1e-6);
  EXPECT_NEAR(mesh.corner_uvs[1].y, 1 - (0.25 - 2), 1e-6);
}

TEST(MeshGltf, colours_are_turned_from_light_to_what_pictures_store) {
  auto builder = square();
  builder.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = builder.add(
      std::vector<std::uint16_t>{65535, 32768, 0, 0, 0, 0, 65535, 65535, 65535, 0, 0, 0}, kShort,
      "VEC3", true);
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.vertex_colors[0], 0xff00bcffu);
  EXPECT_EQ(loaded->mesh.vertex_colors[2], 0xffffffffu);
  EXPECT_TRUE(loaded->mesh.colors_tint_materials);
}

TEST(MeshGltf, meshopt_views_are_decoded_and_need_no_fallback) {
  auto builder = square();
  std::vector<float> padded;
  for (int i = 0; i < 4; ++i)
    padded.insert(padded.end(), kSquare.begin() + 3 * i, kSquare.begin() + 3 * i + 3);
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12)),
      triangles(meshopt_encodeIndexBufferBound(6, 4));
  const std::vector<unsigned> indices{0, 1, 2, 0, 2, 3};
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), padded.data(), 4, 12));
  triangles.resize(
      meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 6));
  const auto compress = [&](int accessor, const std::vector<unsigned char>& bytes, int stride,
                            int count, const char* mode) {
    const int raw = builder.add_view(bytes.data(), bytes.size());
    auto& view =
        builder.json["bufferViews"][builder.json["accessors"][accessor]["bufferView"].get<int>()];
    view["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0},
        {"byteOffset", builder.json["bufferViews"][raw]["byteOffset"]},
        {"byteLength", bytes.size()},
        {"byteStride", stride},
        {"count", count},
        {"mode", mode}};
    view["buffer"] = 77;  // a fallback that does not exist
  };
  compress(0, vertices, 12, 4, "ATTRIBUTES");
  compress(1, triangles, 2, 6, "TRIANGLES");
  builder.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions[2], glm::dvec3(1, 1, 0));
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);

  builder.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 400000000;
  const auto lies = load_text(builder.glb(), "a.glb");
  ASSERT_FALSE(lies);
  EXPECT_THAT(lies.error().detail, HasSubstr("EXT_meshopt_compression"));
}

TEST(MeshGltf, a_texture_without_a_picture_costs_the_look_and_nothing_else) {
  auto builder = square();
  auto& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_0"] =
      builder.add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, kFloat, "VEC2");
  primitive["material"] = 0;
  builder.json["textures"] = {{{"extensions", {{"ACME_texture", {{"source", 0}}}}}},
                              {{"sampler", 0}}};
  builder.json["samplers"] = nlohmann::json::array({nlohmann::json::object()});
  for (const int texture : {0, 1})
    builder.json["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 0, 0, 1}}, {"baseColorTexture", {{"index", texture}}}}}});
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
  EXPECT_EQ(loaded->mesh.corner_uvs.size(), 6u);
  EXPECT_EQ(loaded->mesh.materials[0].texture, -1);
  EXPECT_EQ(loaded->mesh.materials[0].color.r, 1) << "its colour stays";
  EXPECT_EQ(count_of(loaded->repairs, "texture without a picture: texture 0 (ACME_texture)"), 1u);
  EXPECT_EQ(count_of(loaded->repairs, "texture without a picture: texture 1"), 1u);
}

TEST(MeshGltf, parts_without_positions_are_passed_over_and_said) {
  auto builder = square();
  builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"TEXCOORD_0", 0}}}});
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
  EXPECT_EQ(count_of(loaded->repairs, "ignored parts of meshes without positions"), 1u);
}

// Adds EXT_mesh_gpu_instancing to the node of the square.
nlohmann::json& instanced(test::GltfBuilder& builder, const nlohmann::json& attributes) {
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  builder.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  return builder.json["nodes"][0];
}

TEST(MeshGltf, instances_stand_where_their_translation_rotation_and_scale_say) {
  auto builder = square();
  const int translations =
      builder.add(std::vector<float>{10, 0, 0, 0, 20, 0, 0, 0, 30}, kFloat, "VEC3");
  // No rotation, 90° about z, no rotation. The extension allows these normalized shorts.
  const auto half = static_cast<std::int16_t>(std::lround(32767 * std::sqrt(0.5)));
  const int rotations =
      builder.add(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, half, half, 0, 0, 0, 32767}, 5122,
                  "VEC4", true);
  const int scales = builder.add(std::vector<float>{1, 1, 1, 2, 1, 1, -1, 1, 1}, kFloat, "VEC3");
  auto& node = instanced(
      builder, {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}});
  node["translation"] = {433210.123456, 0, 0};
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->mesh.triangle_count(), 6u);
  const auto corner = [&](std::size_t i) {
    return loaded->mesh.positions[loaded->mesh.triangles[i]];
  };
  const auto expect_near = [](const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(found - expected - glm::dvec3(433210.123456, 0, 0)), 1e-4)
        << found.x << ' ' << found.y;
  };
  expect_near(corner(1), {11, 0, 0});
  expect_near(corner(7), {0, 22, 0});  // (1, 0, 0), doubled along x, rotated to y
  expect_near(corner(12), {0, 0, 30});
  // The mirrored instance reverses the order of its triangle corners.
  EXPECT_GT(glm::cross(corner(13) - corner(12), corner(14) - corner(12)).z, 0);
  EXPECT_NEAR(mesh::surface_area(loaded->mesh), 4, 1e-4);
  EXPECT_TRUE(loaded->repairs.empty());
}

TEST(MeshGltf, an_instancing_without_places_is_one_mesh) {
  auto builder = square();
  instanced(builder, {{"_FEATURE_ID_0", 1}});
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_count(), 2u);
}

TEST(MeshGltf, instances_that_contradict_themselves_or_are_too_many_are_refused) {
  const auto refusal = [](const std::function<void(test::GltfBuilder&)>& harm) {
    auto builder = square();
    instanced(builder, {{"TRANSLATION", builder.add(std::vector<float>(6, 1), kFloat, "VEC3")}});
    harm(builder);
    const auto loaded = load_text(builder.glb(), "a.glb");
    return loaded ? std::string("read") : loaded.error().detail;
  };
  const auto attributes = [](test::GltfBuilder& b) -> nlohmann::json& {
    return b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  };
  EXPECT_THAT(
      refusal([&](auto& b) {
        attributes(b)["SCALE"] = b.add(std::vector<float>(9, 1), kFloat, "VEC3");
      }),
      HasSubstr(
          "SCALE of EXT_mesh_gpu_instancing in the glTF has 3 values, but another attribute has 2"));
  EXPECT_THAT(
      refusal([&](auto& b) {
        attributes(b)["ROTATION"] = b.add(std::vector<float>(6, 1), kFloat, "VEC3");
      }),
      HasSubstr("ROTATION of EXT_mesh_gpu_instancing in the glTF does not contain 4 numbers"));
  EXPECT_THAT(
      refusal([&](auto& b) {
        attributes(b)["ROTATION"] = b.add(std::vector<std::uint8_t>(8, 1), kByte, "VEC4", true);
      }),
      HasSubstr("does not contain 4 numbers of type FLOAT, or of normalized BYTE or SHORT"));
  EXPECT_THAT(refusal([&](auto& b) { attributes(b)["TRANSLATION"] = 99; }),
              HasSubstr("index 99 of \"accessors\""));
  EXPECT_THAT(refusal([&](auto& b) { attributes(b)["TRANSLATION"] = "here"; }),
              HasSubstr("\"TRANSLATION\""));
  EXPECT_THAT(refusal([](auto& b) {
                b.json["accessors"].back()["count"] = 1'000'001;
                b.json["accessors"].back().erase("bufferView");
              }),
              HasSubstr("repeats a mesh 1000001 times"));
}

TEST(MeshGltf, more_triangles_than_are_taken_are_refused_before_they_are_made) {
  auto builder = square();
  instanced(builder, {{"TRANSLATION", builder.add(std::vector<float>{0, 0, 0, 5, 0, 0, 9, 0, 0},
                                                  kFloat, "VEC3")}});
  const std::vector<std::pair<std::string, std::string>> texts{{"a.glb", builder.glb()}};
  const auto files = test::files_of(texts);
  Progress progress;
  EXPECT_TRUE(mesh::parse_gltf(*files, progress, 6));
  const auto more = mesh::parse_gltf(*files, progress, 5);
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error().detail,
              HasSubstr("repeats a mesh of 2 triangles 3 times. That is more than 5"));
}

struct BadGltf {
  std::string name;
  std::function<void(nlohmann::json&)> harm;
  std::string says;
};

class MeshGltfFaults : public testing::TestWithParam<BadGltf> {};

TEST_P(MeshGltfFaults, is_refused_by_name) {
  auto builder = square();
  GetParam().harm(builder.json);
  const auto loaded = load_text(builder.glb(), "a.glb");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
  EXPECT_THAT(loaded.error().detail, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    MeshGltf, MeshGltfFaults,
    testing::Values(
        BadGltf{"no_asset", [](auto& j) { j.erase("asset"); }, "no \"asset\""},
        BadGltf{"old", [](auto& j) { j["asset"]["version"] = "1.0"; }, "is not 2"},
        BadGltf{"unknown_extension", [](auto& j) { j["extensionsRequired"] = {"ACME_magic"}; },
                "ACME_magic"},
        BadGltf{"cycle", [](auto& j) { j["nodes"][0]["children"] = {0}; }, "its own ancestor"},
        BadGltf{"lost_node", [](auto& j) { j["scenes"][0]["nodes"] = {5}; },
                "index 5 of \"nodes\""},
        BadGltf{"lost_mesh", [](auto& j) { j["nodes"][0]["mesh"] = 3; }, "\"meshes\""},
        BadGltf{"lost_material", [](auto& j) { j["meshes"][0]["primitives"][0]["material"] = 0; },
                "material 0"},
        BadGltf{"no_position",
                [](auto& j) { j["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); },
                "no POSITION"},
        BadGltf{"count_lies", [](auto& j) { j["accessors"][0]["count"] = 4000000000u; },
                "4000000000 values"},
        BadGltf{"offset_lies",
                [](auto& j) { j["accessors"][1]["byteOffset"] = 18446744073709551615u; },
                "too short"},
        BadGltf{"view_lies", [](auto& j) { j["bufferViews"][0]["byteLength"] = 1000; },
                "beyond the end of its buffer"},
        BadGltf{"negative", [](auto& j) { j["accessors"][0]["count"] = -4; },
                "\"count\" is not a whole number"},
        BadGltf{"small_stride", [](auto& j) { j["bufferViews"][0]["byteStride"] = 4; }, "stride"},
        BadGltf{"not_indices", [](auto& j) { j["meshes"][0]["primitives"][0]["indices"] = 0; },
                "unsigned whole"},
        BadGltf{"index_out_of_range", [](auto& j) { j["accessors"][0]["count"] = 3; },
                "refers to vertex 3"},
        BadGltf{"points", [](auto& j) { j["meshes"][0]["primitives"][0]["mode"] = 0; },
                "points or lines"},
        BadGltf{"no_such_mode", [](auto& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; },
                "mode 7"},
        BadGltf{"no_meshes",
                [](auto& j) {
                  j.erase("meshes");
                  j["nodes"][0].erase("mesh");
                },
                "contains no meshes"},
        BadGltf{"not_shown", [](auto& j) { j["nodes"][0].erase("mesh"); },
                "no node of its scene uses one"},
        BadGltf{"other_numbers", [](auto& j) { j["accessors"][0]["componentType"] = 5130; },
                "numbers of type 5130, which glTF does not define"},
        BadGltf{"matrices", [](auto& j) { j["accessors"][0]["type"] = "MAT3"; }, "type \"MAT3\""},
        BadGltf{"counts_differ",
                [](auto& j) {
                  j["accessors"].push_back(j["accessors"][0]);
                  j["accessors"][2]["count"] = 3;
                  j["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
                },
                "4 positions, but 3 values of COLOR_0"},
        BadGltf{"text_for_a_matrix", [](auto& j) { j["nodes"][0]["matrix"] = "unit"; },
                "\"matrix\""},
        BadGltf{"zeros", [](auto& j) { j["accessors"][0].erase("bufferView"); }, "area"}),
    [](const auto& bad) { return bad.param.name; });

TEST(MeshGltf, a_file_that_is_cut_anywhere_is_refused) {
  const std::string whole = square().glb();
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_FALSE(load_text(whole.substr(0, size), "a.glb")) << size;
}

}  // namespace
