#include <gtest/gtest.h>

#include <cmath>

#include "mesh/texture/base_color.h"
#include "mesh/texture/gutter_fill.h"
#include "mesh/texture/texture_sampler.h"
#include "mesh/texture/vertex_color.h"
#include "support/picture_files.h"

namespace {

using namespace strata;
using mesh::Material;
using mesh::TriangleMesh;

// Returns a texture of one color.
mesh::Texture plain(const std::string& name, int size, glm::u8vec3 color,
                    PictureFormat format = PictureFormat::png) {
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < size * size; ++i) rgba.insert(rgba.end(), {color.r, color.g, color.b, 255});
  return {name, format == PictureFormat::png ? encode_png(rgba, size, size)
                                             : encode_jpeg(rgba, size, size, {95, true})};
}

// Two adjacent squares, each of two triangles that fill [0,1]² of their texture. In the atlas, they
// are the lower left and the upper right quarter.
struct Squares {
  TriangleMesh mesh;
  mesh::Atlas atlas;
  std::vector<Repair> repairs;
  Progress progress;

  Squares() {
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    mesh.triangles = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    for (int i = 0; i < 2; ++i)
      for (const glm::vec2 uv : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
        mesh.corner_uvs.push_back(uv);
        atlas.corner_uvs.push_back(uv * 0.5f + glm::vec2(i * 0.5f));
      }
    mesh.triangle_materials = {0, 0, 1, 1};
    mesh.materials = {Material{.name = "left", .texture = 0},
                      Material{.name = "right", .texture = 1}};
    mesh.textures = {plain("left", 1024, {200, 0, 0}), plain("right", 1024, {0, 0, 200})};
    atlas.report.source = "made";
  }

  std::optional<mesh::BaseColor> bake() {
    auto baked = mesh::bake_base_color(mesh, atlas, repairs, progress);
    EXPECT_TRUE(baked);
    return baked ? std::move(*baked) : std::nullopt;
  }
};

// Returns the color at an atlas coordinate, with v upwards.
glm::ivec3 color_at(const Picture& picture, double u, double v) {
  const int x = static_cast<int>(u * picture.width), y = static_cast<int>((1 - v) * picture.height);
  const auto* p = &picture.rgba[(static_cast<std::size_t>(y) * picture.width + x) * 4];
  return {p[0], p[1], p[2]};
}

TEST(BaseColor, several_textures_become_one_picture_of_their_density) {
  Squares squares;
  const auto baked = squares.bake();
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->format, PictureFormat::png);
  EXPECT_EQ(baked->width, 2048) << "1024 pixels on half the atlas' side";
  const auto picture = decode_picture(baked->bytes);
  ASSERT_TRUE(picture);
  for (const double s : {0.001, 0.25, 0.499}) {
    EXPECT_EQ(color_at(*picture, s, s), glm::ivec3(200, 0, 0));
    EXPECT_EQ(color_at(*picture, s, 0.499 - s + 0.001), glm::ivec3(200, 0, 0));
    EXPECT_EQ(color_at(*picture, 0.5 + s, 0.5 + s), glm::ivec3(0, 0, 200));
  }
  // The gutter continues the colors of the adjacent surface.
  EXPECT_EQ(color_at(*picture, 0.25, 0.5 + 5.0 / 2048), glm::ivec3(200, 0, 0));
  EXPECT_EQ(color_at(*picture, 0.75, 0.5 - 5.0 / 2048), glm::ivec3(0, 0, 200));
  EXPECT_TRUE(squares.mesh.textures[0].bytes.empty());
}

TEST(BaseColor, the_picture_stands_upright) {
  Squares squares;
  std::vector<std::uint8_t> rgba(64 * 64 * 4, 255);
  for (std::size_t i = 0; i < rgba.size() / 2; i += 4) rgba[i] = 10;  // the upper half
  squares.mesh.textures[0].bytes = encode_png(rgba, 64, 64);
  const auto picture = decode_picture(squares.bake()->bytes);
  EXPECT_EQ(color_at(*picture, 0.25, 0.4).r, 10);
  EXPECT_EQ(color_at(*picture, 0.25, 0.1).r, 255);
}

TEST(BaseColor, jpegs_make_a_jpeg_and_a_repeated_texture_makes_it_finer) {
  Squares squares;
  for (auto& uv : squares.mesh.corner_uvs) uv *= 3.0f;
  squares.mesh.textures = {plain("left", 256, {200, 0, 0}, PictureFormat::jpeg),
                           plain("right", 256, {0, 0, 200}, PictureFormat::jpeg)};
  const auto baked = squares.bake();
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->format, PictureFormat::jpeg);
  EXPECT_EQ(baked->width, 2048) << "3 × 256 pixels on half the side";
}

TEST(BaseColor, one_texture_on_the_files_own_coordinates_keeps_its_bytes) {
  Squares squares;
  squares.mesh.materials[1].texture = 0;
  squares.atlas.report.source = "file";
  const auto bytes = squares.mesh.textures[0].bytes;
  const auto baked = squares.bake();
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->bytes, bytes);
  EXPECT_EQ(baked->width, 1024);
}

TEST(BaseColor, a_colour_or_a_tint_on_the_texture_is_multiplied_in_as_light) {
  Squares squares;
  squares.atlas.report.source = "file";
  squares.mesh.materials[1].texture = 0;
  for (auto& material : squares.mesh.materials) material.color.r = 0.5f;
  squares.mesh.vertex_colors.assign(6, 0xff000080u);
  squares.mesh.colors_tint_materials = true;
  const auto picture = decode_picture(squares.bake()->bytes);
  const double light = mesh::linear_of_srgb(200 / 255.0) * mesh::linear_of_srgb(0.5) *
                       mesh::linear_of_srgb(128 / 255.0);
  EXPECT_NEAR(color_at(*picture, 0.25, 0.25).r, 255 * mesh::srgb_of_linear(light), 1.5);
}

TEST(BaseColor, colours_without_textures_are_painted_where_they_differ) {
  Squares squares;
  squares.mesh.textures.clear();
  squares.mesh.materials = {Material{.color = {1, 0, 0, 1}}, Material{.color = {0, 1, 0, 1}}};
  const auto picture = decode_picture(squares.bake()->bytes);
  ASSERT_TRUE(picture);
  EXPECT_EQ(color_at(*picture, 0.25, 0.25), glm::ivec3(255, 0, 0));
  EXPECT_EQ(color_at(*picture, 0.75, 0.75), glm::ivec3(0, 255, 0));
}

TEST(BaseColor, one_colour_goes_to_the_vertices) {
  Squares squares;
  squares.mesh.textures.clear();
  squares.mesh.materials = {Material{.color = {1, 0, 0, 1}}, Material{.color = {1, 0, 0, 1}}};
  EXPECT_FALSE(squares.bake());
  EXPECT_EQ(squares.mesh.vertex_colors, std::vector<std::uint32_t>(6, 0xff0000ffu));
}

TEST(BaseColor, white_without_textures_is_nothing) {
  Squares squares;
  squares.mesh.textures.clear();
  squares.mesh.materials = {Material{}, Material{}};
  EXPECT_FALSE(squares.bake());
  EXPECT_TRUE(squares.mesh.vertex_colors.empty());
}

TEST(BaseColor, black_as_the_only_color_is_ignored) {
  Squares materials;
  materials.mesh.textures.clear();
  materials.mesh.materials = {Material{.color = {0, 0, 0, 1}}, Material{.color = {0, 0, 0, 1}}};
  EXPECT_FALSE(materials.bake());
  EXPECT_TRUE(materials.mesh.vertex_colors.empty());
  ASSERT_EQ(materials.repairs.size(), 1u);
  EXPECT_EQ(materials.repairs[0].count, 4u);

  Squares vertices;
  vertices.mesh.textures.clear();
  vertices.mesh.materials.clear();
  vertices.mesh.triangle_materials.clear();
  vertices.mesh.vertex_colors.assign(6, 0xff000000u);
  EXPECT_FALSE(vertices.bake());
  EXPECT_TRUE(vertices.mesh.vertex_colors.empty());
  ASSERT_EQ(vertices.repairs.size(), 1u);
  EXPECT_EQ(vertices.repairs[0].count, 6u);
}

TEST(BaseColor, black_beside_another_color_stays_black) {
  Squares squares;
  squares.mesh.textures.clear();
  squares.mesh.materials = {Material{.color = {0, 0, 0, 1}}, Material{.color = {1, 0, 0, 1}}};
  const auto picture = decode_picture(squares.bake()->bytes);
  EXPECT_EQ(color_at(*picture, 0.25, 0.25), glm::ivec3(0));
  EXPECT_EQ(color_at(*picture, 0.75, 0.75), glm::ivec3(255, 0, 0));
  EXPECT_TRUE(squares.repairs.empty());
}

TEST(BaseColor, black_does_not_hide_a_texture) {
  Squares squares;
  squares.mesh.materials[0].color = {0, 0, 0, 1};
  const auto picture = decode_picture(squares.bake()->bytes);
  EXPECT_EQ(color_at(*picture, 0.25, 0.25), glm::ivec3(200, 0, 0));
  EXPECT_EQ(color_at(*picture, 0.75, 0.75), glm::ivec3(0, 0, 200));
  ASSERT_EQ(squares.repairs.size(), 1u);
  EXPECT_EQ(squares.repairs[0].count, 1u);
}

TEST(BaseColor, a_texture_that_breaks_off_is_reported_and_left_out) {
  Squares squares;
  squares.mesh.textures[0].bytes.resize(squares.mesh.textures[0].bytes.size() / 2);
  const auto picture = decode_picture(squares.bake()->bytes);
  EXPECT_EQ(color_at(*picture, 0.25, 0.25), glm::ivec3(255, 255, 255));
  EXPECT_EQ(color_at(*picture, 0.75, 0.75), glm::ivec3(0, 0, 200));
  ASSERT_EQ(squares.repairs.size(), 1u);
  EXPECT_EQ(squares.repairs[0].what.find("texture not read: left: The PNG cannot be read"), 0u);

  Squares alone;
  alone.atlas.report.source = "file";
  alone.mesh.materials[1].texture = 0;
  alone.mesh.textures[0].bytes.resize(alone.mesh.textures[0].bytes.size() / 2);
  EXPECT_FALSE(alone.bake());
  EXPECT_EQ(alone.repairs.size(), 1u);
}

TEST(BaseColor, textures_of_which_none_can_be_read_are_no_look) {
  Squares squares;
  for (auto& texture : squares.mesh.textures) texture.bytes.resize(texture.bytes.size() / 2);
  EXPECT_FALSE(squares.bake()) << "and no white picture";
  EXPECT_EQ(squares.repairs.size(), 2u);

  Squares coloured;
  for (auto& texture : coloured.mesh.textures) texture.bytes.resize(texture.bytes.size() / 2);
  for (auto& material : coloured.mesh.materials) material.color = {1, 0, 0, 1};
  EXPECT_FALSE(coloured.bake());
  EXPECT_EQ(coloured.mesh.vertex_colors, std::vector<std::uint32_t>(6, 0xff0000ffu))
      << "the materials' colour";
}

TEST(BaseColor, pixels_that_are_lost_are_said_with_the_sizes) {
  Squares squares;
  MemoryLedger memory("memory", "--memory", 12 << 20);  // only enough for 1024²
  const auto baked = mesh::bake_base_color(squares.mesh, squares.atlas, squares.repairs,
                                           squares.progress, &memory);
  ASSERT_TRUE(baked && *baked);
  EXPECT_EQ((*baked)->width, 1024);
  ASSERT_EQ(squares.repairs.size(), 1u);
  EXPECT_EQ(
      squares.repairs[0].what,
      "textures made smaller: 2 of 1024 × 1024 pixels became one picture of 1024 × 1024, which keeps 25 % of the "
      "pixels that the surface uses");
  EXPECT_EQ(squares.repairs[0].count, 2u);
  EXPECT_EQ(memory.used(), 0u);

  Squares poor;
  MemoryLedger little("memory", "--memory", 1 << 20);
  const auto refused =
      mesh::bake_base_color(poor.mesh, poor.atlas, poor.repairs, poor.progress, &little);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
}

TEST(BaseColor, a_tiff_becomes_a_png_of_its_pixels) {
  Squares squares;
  squares.mesh.materials[1].texture = 0;
  squares.atlas.report.source = "file";
  test::TiffSettings settings;
  squares.mesh.textures[0].bytes = test::tiff_of(64, 32, settings, [](int x, int y, int s) {
    return static_cast<std::uint32_t>(s == 0 ? x : s == 1 ? y : 7);
  });
  const auto baked = squares.bake();
  ASSERT_TRUE(baked);
  EXPECT_EQ(baked->format, PictureFormat::png);
  EXPECT_EQ(picture_format(baked->bytes), PictureFormat::png);
  const auto picture = decode_picture(baked->bytes);
  EXPECT_EQ(std::pair(picture->width, picture->height), std::pair(64, 32));
  EXPECT_EQ(picture->rgba[4 * (5 * 64 + 9)], 9);
  EXPECT_EQ(picture->rgba[4 * (5 * 64 + 9) + 1], 5);
}

TEST(BaseColor, a_triangle_that_was_moved_takes_its_pixels_along_and_the_others_keep_theirs) {
  Squares squares;
  squares.mesh.materials[1].texture = 0;
  squares.atlas.report.source = "file";
  // The texture is the atlas, except for the second triangle. The lower half of the image is red,
  // and the upper half is blue.
  squares.mesh.corner_uvs = squares.atlas.corner_uvs;
  std::vector<std::uint8_t> rgba(512 * 512 * 4, 255);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const bool upper = i < rgba.size() / 2;
    rgba[i] = upper ? 0 : 200, rgba[i + 1] = 0, rgba[i + 2] = upper ? 200 : 0;
  }
  squares.mesh.textures[0].bytes = encode_png(rgba, 512, 512);
  squares.atlas.moved = {1};
  const glm::vec2 place[] = {{0.6f, 0.1f}, {0.9f, 0.1f}, {0.6f, 0.4f}};
  std::copy(std::begin(place), std::end(place), squares.atlas.corner_uvs.begin() + 3);
  const auto own = [&](std::initializer_list<glm::vec2> uvs) {
    std::copy(uvs.begin(), uvs.end(), squares.mesh.corner_uvs.begin() + 3);
  };

  own({{0.6f, 1.6f}, {0.9f, 1.6f}, {0.9f, 1.9f}});  // outside, so the texture repeats: blue
  auto baked = squares.bake();
  ASSERT_TRUE(baked);
  auto picture = decode_picture(baked->bytes);
  EXPECT_EQ(color_at(*picture, 0.7, 0.2), glm::ivec3(0, 0, 200));
  EXPECT_EQ(color_at(*picture, 0.5995, 0.2), glm::ivec3(0, 0, 200)) << "and a ring around it";
  std::size_t changed = 0;
  for (std::size_t i = 0; i < rgba.size(); i += 4) changed += rgba[i] != picture->rgba[i];
  EXPECT_NEAR(double(changed), 512 * 512 * 0.045, 800) << "nothing else";

  // Without coordinates, the triangle gets the colors of its corners in adjacent triangles. The
  // first corner is red there.
  squares.mesh.textures[0].bytes = encode_png(rgba, 512, 512);
  const float none = NAN;
  own({{none, none}, {none, none}, {none, none}});
  baked = squares.bake();
  ASSERT_TRUE(baked);
  picture = decode_picture(baked->bytes);
  EXPECT_GT(color_at(*picture, 0.605, 0.105).r, 180);
  EXPECT_EQ(color_at(*picture, 0.75, 0.75), glm::ivec3(0, 0, 200));
}

TEST(BaseColor, a_cancelled_bake_stops) {
  Squares squares;
  squares.progress.cancel();
  EXPECT_EQ(mesh::bake_base_color(squares.mesh, squares.atlas, squares.repairs, squares.progress)
                .error()
                .code,
            ErrorCode::cancelled);
}

TEST(TextureSampler, textures_go_on_outside_as_their_wrap_says) {
  Picture picture{4, 1, {}};
  for (int i = 0; i < 4; ++i)
    picture.rgba.insert(picture.rgba.end(), {std::uint8_t(10 * i), 0, 0, 255});
  const mesh::TextureSampler sampler(picture);
  const auto at = [&](double pixel, mesh::Wrap wrap) {
    return sampler.sample({pixel / 4, 0.5}, wrap, wrap).r;
  };
  EXPECT_FLOAT_EQ(at(1.5, mesh::Wrap::clamp), 10);
  EXPECT_FLOAT_EQ(at(2.0, mesh::Wrap::clamp), 15);
  EXPECT_FLOAT_EQ(at(-3.5, mesh::Wrap::clamp), 0);
  EXPECT_FLOAT_EQ(at(9.5, mesh::Wrap::clamp), 30);
  EXPECT_FLOAT_EQ(at(-0.5, mesh::Wrap::repeat), 30);
  EXPECT_FLOAT_EQ(at(5.5, mesh::Wrap::repeat), 10);
  EXPECT_FLOAT_EQ(at(0.0, mesh::Wrap::repeat), 15);
  EXPECT_FLOAT_EQ(at(4.5, mesh::Wrap::mirror), 30);
  EXPECT_FLOAT_EQ(at(-1.5, mesh::Wrap::mirror), 10);
  EXPECT_FLOAT_EQ(at(NAN, mesh::Wrap::mirror), 0);
}

TEST(TextureSampler, half_a_picture_has_the_mean_light) {
  const Picture picture{2, 2, {0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 255}};
  const Picture half = mesh::halve(picture);
  EXPECT_EQ(half.width, 1);
  EXPECT_EQ(half.rgba[0], 188) << "half the light of white";
  EXPECT_EQ(mesh::halve({3, 1, std::vector<std::uint8_t>(12, 7)}).width, 1);
}

TEST(TextureSampler, transparent_pixels_do_not_darken_half_a_picture) {
  const Picture picture{2, 2, {200, 100, 50, 255, 0, 0, 0, 0, 0, 0, 0, 0, 200, 100, 50, 255}};
  const Picture half = mesh::halve(picture);
  EXPECT_EQ(half.rgba, (std::vector<std::uint8_t>{200, 100, 50, 128}));
  const Picture invisible{2, 1, {10, 20, 30, 0, 10, 20, 30, 0}};
  EXPECT_EQ(mesh::halve(invisible).rgba, (std::vector<std::uint8_t>{10, 20, 30, 0}));
}

TEST(TextureSampler, each_side_of_a_picture_is_halved_toward_the_texture) {
  Picture picture{8, 3, std::vector<std::uint8_t>(8 * 3 * 4, 9)};
  for (int x = 0; x < 8; ++x) picture.rgba[static_cast<std::size_t>(x) * 4] = x < 4 ? 40 : 80;
  ASSERT_TRUE(mesh::halve_toward(picture, 2));
  EXPECT_EQ(std::pair(picture.width, picture.height), std::pair(4, 3));
  EXPECT_EQ(picture.rgba[0], 40) << "the rows are not mixed";
  EXPECT_EQ(picture.rgba[12], 80);
  ASSERT_TRUE(mesh::halve_toward(picture, 2));
  EXPECT_EQ(std::pair(picture.width, picture.height), std::pair(2, 3));
  EXPECT_FALSE(mesh::halve_toward(picture, 2));
}

TEST(GutterFill, everything_gets_a_colour_and_rings_the_nearest) {
  Picture picture{64, 40, std::vector<std::uint8_t>(64 * 40 * 4, 0)};
  const auto put = [&](int x, int y, std::uint8_t red) {
    picture.rgba[(y * 64 + x) * 4] = red;
    picture.rgba[(y * 64 + x) * 4 + 3] = 255;
  };
  put(10, 10, 100);
  put(40, 30, 200);
  mesh::fill_gutter(picture, 4);
  const auto red = [&](int x, int y) { return picture.rgba[(y * 64 + x) * 4]; };
  EXPECT_EQ(red(10, 14), 100);
  EXPECT_EQ(red(36, 30), 200);
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    EXPECT_EQ(picture.rgba[i + 3], 255);
    EXPECT_GE(picture.rgba[i], 100);
  }
  Picture empty{3, 3, std::vector<std::uint8_t>(36, 0)};
  mesh::fill_gutter(empty, 2);
  EXPECT_EQ(empty.rgba[3], 255);
}

}  // namespace
