#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/text/filename.h"
#include "core/text/slug.h"
#include "core/text/utf8.h"
#include "core/uuid.h"
#include "domain/layers/palette.h"
#include "domain/layers/tile.h"
#include "domain/layers/value_type.h"
#include "domain/scene/camera.h"

namespace strata {
namespace {

constexpr ValueType kAll[] = {ValueType::u8,  ValueType::u16, ValueType::u32, ValueType::i8,
                              ValueType::i16, ValueType::i32, ValueType::f16, ValueType::f32};

TEST(ValueType, every_type_keeps_its_extremes) {
  for (ValueType type : kAll)
    for (double value : {lowest_value(type), highest_value(type), 0.0, 1.0}) {
      auto bits = encode_value(type, value);
      ASSERT_TRUE(bits) << name(type) << " " << value;
      EXPECT_EQ(decode_value(type, *bits), value) << name(type);
      EXPECT_EQ(parse_value_type(name(type)), type);
    }
}

TEST(ValueType, refuses_what_the_type_cannot_hold) {
  for (ValueType type : kAll) {
    EXPECT_FALSE(encode_value(type, std::nan("")));
    EXPECT_FALSE(encode_value(type, std::numeric_limits<double>::infinity()));
    EXPECT_FALSE(encode_value(type, highest_value(type) * 1.01 + 1));
    if (lowest_value(type) < 0) {
      EXPECT_FALSE(encode_value(type, lowest_value(type) * 1.01 - 1));
    } else {
      EXPECT_FALSE(encode_value(type, -1));
    }
    EXPECT_EQ(encode_value(type, 0.5).has_value(), is_float(type));
  }
  EXPECT_EQ(encode_value(ValueType::u8, 256).error().field, "value");
}

TEST(ValueType, whole_numbers_without_a_sign_widen_with_their_bits) {
  using enum ValueType;
  for (const auto& [from, to] : {std::pair{u8, u16}, {u8, u32}, {u16, u32}}) {
    EXPECT_TRUE(widens_to(from, to));
    EXPECT_FALSE(widens_to(to, from));
    TileData tile(from);
    tile.write(0, 255);
    tile.write(77, 3);
    tile.write(kTexelsPerTile - 1, from == u16 ? 65535u : 200u);
    tile.write(5, 0);
    const TileData wide = widened(tile, to);
    EXPECT_EQ(wide.texel_bytes(), bytes_per_texel(to));
    EXPECT_EQ(wide.valid, tile.valid);
    for (const int texel : {0, 1, 5, 77, kTexelsPerTile - 1})
      EXPECT_EQ(wide.bits(texel), tile.bits(texel));
  }
  for (const auto& [from, to] :
       {std::pair{u8, u8}, {i8, i16}, {u8, i16}, {u16, f32}, {f16, f32}, {u32, u32}})
    EXPECT_FALSE(widens_to(from, to));
}

TEST(Palette, survives_json) {
  for (ValueType type : kAll)
    for (bool categorical : {false, true}) {
      const Palette palette = default_palette(type, categorical);
      auto back = palette_from_json(to_json(palette));
      ASSERT_TRUE(back);
      EXPECT_EQ(to_json(*back), to_json(palette));
    }
}

TEST(Palette, refuses_bad_points_with_the_field_named) {
  auto bad = [](const char* text) {
    return palette_from_json(nlohmann::json::parse(text)).error().field;
  };
  EXPECT_EQ(bad(R"({"mode":"rainbow"})"), "palette.mode");
  EXPECT_EQ(bad(R"({"mode":"linear","points":[]})"), "palette.points");
  EXPECT_EQ(bad(R"({"points":[{"at":1,"color":"#12345g"}]})"), "palette.points[0].color");
  EXPECT_EQ(bad(R"({"points":[{"at":1,"color":"#123456"},{"at":1,"color":"#123456"}]})"),
            "palette.points[1]");
  EXPECT_EQ(bad(R"({"points":[{"at":1,"color":"#123456"}],"min":3,"max":2})"), "palette.max");
}

TEST(Palette, linear_mixes_step_holds_categorical_names) {
  Palette palette{
      PaletteMode::linear, 0, 10, {{0, {0, 0, 0, 255}, ""}, {10, {200, 100, 0, 255}, ""}}, ""};
  EXPECT_EQ(color_of(palette, 5), (Rgba{100, 50, 0, 255}));
  EXPECT_EQ(color_of(palette, -3), (Rgba{0, 0, 0, 255}));
  EXPECT_EQ(color_of(palette, 99), (Rgba{200, 100, 0, 255}));
  palette.mode = PaletteMode::step;
  EXPECT_EQ(color_of(palette, 9.9), (Rgba{0, 0, 0, 255}));
  EXPECT_EQ(color_of(palette, 10), (Rgba{200, 100, 0, 255}));
  palette.mode = PaletteMode::categorical;
  EXPECT_EQ(color_of(palette, 10), (Rgba{200, 100, 0, 255}));
  EXPECT_EQ(color_of(palette, 7), generated_color(7));
}

TEST(Camera, refuses_sections_that_are_none) {
  Camera camera{glm::dmat4(1), glm::dmat4(1), 100, 100};
  camera.section = {{0, 0, 1, 5}, {0, 0, 0, 5}};
  EXPECT_EQ(validate(camera).error().field, "camera.section[1]");
  camera.section = {{0, std::nan(""), 1, 5}};
  EXPECT_EQ(validate(camera).error().field, "camera.section[0]");
  camera.section.assign(7, {0, 0, 1, 5});
  EXPECT_EQ(validate(camera).error().field, "camera.section");
  camera.section.resize(6);
  EXPECT_TRUE(validate(camera));
}

TEST(Camera, a_section_is_relative_to_the_origin_and_has_unit_normals) {
  Camera camera;
  camera.section = {{0, 0, -10, 40'000'000}};
  const auto planes = section_in_model(camera, {0, 0, 4'000'000 - 2});
  EXPECT_EQ(planes[0], glm::vec4(0, 0, -1, 2));
  EXPECT_EQ(planes[5], glm::vec4(0, 0, 0, 1)) << "keeps everything";
}

TEST(Camera, refuses_singular_and_endless_matrices) {
  Camera camera{glm::dmat4(1), glm::dmat4(1), 100, 100};
  EXPECT_TRUE(validate(camera));
  camera.view[0][0] = std::nan("");
  EXPECT_EQ(validate(camera).error().field, "camera.view");
  camera.view = glm::dmat4(1);
  camera.projection = glm::dmat4(0);
  EXPECT_EQ(validate(camera).error().field, "camera.projection");
  camera.projection = glm::dmat4(1);
  camera.width = 0;
  EXPECT_EQ(validate(camera).error().field, "camera.width");
  camera.width = kMaxViewSize + 1;
  EXPECT_FALSE(validate(camera));
}

TEST(Camera, the_ray_through_a_pixel_hits_what_projects_there) {
  // Large coordinates, as on a real site.
  const glm::dvec3 eye{500012.5, 4000003.0, 130.0}, target{500010.0, 4000000.0, 128.0};
  for (bool orthographic : {false, true}) {
    const Camera camera{glm::lookAt(eye, target, glm::dvec3(0, 0, 1)),
                        orthographic ? glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.1, 50.0)
                                     : glm::perspective(0.8, 4.0 / 3.0, 0.1, 50.0),
                        800, 600};
    EXPECT_EQ(is_orthographic(camera), orthographic);
    const Ray ray = ray_through_pixel(camera, 300.5, 200.5);
    const glm::dvec3 point = ray.origin + ray.direction * 3.0;
    const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(point, 1);
    EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * 800, 300.5, 1e-4);
    EXPECT_NEAR((0.5 - clip.y / clip.w * 0.5) * 600, 200.5, 1e-4);
    // In floats relative to the model's origin, the point has the same pixel as in doubles.
    const glm::vec4 near_origin =
        clip_from_model(camera, target) * glm::vec4(glm::vec3(point - target), 1);
    EXPECT_NEAR((near_origin.x / near_origin.w * 0.5 + 0.5) * 800, 300.5, 1e-2);
  }
}

TEST(Slug, is_never_all_digits_nor_empty) {
  EXPECT_EQ(make_slug("Muro 3 (norte)"), "muro-3-norte");
  EXPECT_EQ(make_slug("12"), "n-12");
  EXPECT_EQ(make_slug("  ---  "), "n");
  EXPECT_EQ(make_slug("κρήνη"), "n");
  EXPECT_LE(make_slug(std::string(500, 'a')).size(), 48u);
}

TEST(Uuid, reads_what_it_writes_and_nothing_else) {
  const Uuid uuid = random_uuid();
  EXPECT_EQ(parse_uuid(to_string(uuid)), uuid);
  EXPECT_NE(random_uuid(), uuid);
  for (const char* bad :
       {"", "123", "00000000-0000-0000-0000-00000000000g", "000000000000-0000-0000-0000-00000000"})
    EXPECT_FALSE(parse_uuid(bad)) << bad;
}

TEST(Filename, loses_its_folders) {
  EXPECT_EQ(base_filename("../../etc/pot.ply"), "pot.ply");
  EXPECT_EQ(base_filename("C:\\scans\\pot.ply"), "pot.ply");
  EXPECT_EQ(base_filename(".."), "");
  EXPECT_EQ(base_filename("photo\u202egpj.exe"), "photogpj.exe")
      << "marks that turn what follows are left out";
  EXPECT_EQ(base_filename(".\u200b."), "") << "also where they hide what is left";
  EXPECT_EQ(base_filename("\ufeffSU\u00a012 \u00e9t\u00e9 \u4e2d\U0001f3fa\u0085.jpg"),
            "SU\u00a012 \u00e9t\u00e9 \u4e2d\U0001f3fa.jpg");
  EXPECT_EQ(base_filename("a\r\nb.ply"), "ab.ply");
  EXPECT_EQ(base_filename(std::string(300, 'x') + ".ply").size(), 255u);
}

TEST(Filename, is_utf8_whatever_it_was) {
  EXPECT_EQ(base_filename("Gr\xf6\xdf.shp"), "Gr\ufffd\ufffd.shp");
  std::string many;
  for (int i = 0; i < 100; ++i) many += "ö€";
  const std::string cut = base_filename(many + ".shp");
  EXPECT_TRUE(is_utf8(cut)) << cut;
  EXPECT_TRUE(cut.ends_with("ö€.shp"));
  EXPECT_GT(cut.size(), 250u);
  EXPECT_LE(cut.size(), 255u);
}

TEST(Utf8, is_what_the_rfc_says) {
  for (const std::string_view good :
       {"", "a\x7f", "é", "\u0800", "\ud7ff", "\ue000", "\uffff", "\U00010000", "\U0010ffff"}) {
    EXPECT_TRUE(is_utf8(good)) << good;
    EXPECT_EQ(mended_utf8(good), good);
  }
  for (const std::string_view bad :
       {"\x80", "\xc3", "\xc0\x80", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
        "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xff"}) {
    EXPECT_FALSE(is_utf8(bad));
    EXPECT_FALSE(is_utf8("a" + std::string(bad) + "b"));
    EXPECT_TRUE(is_utf8(mended_utf8(bad)));
  }
  EXPECT_EQ(mended_utf8("a\xe2\x82 \xff€"), "a\ufffd\ufffd \ufffd€");
}

}  // namespace
}  // namespace strata
