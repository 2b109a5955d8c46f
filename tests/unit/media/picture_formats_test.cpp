#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiff.h>

#include <cstdlib>
#include <tuple>
#include <utility>

#include "media/picture.h"
#include "support/gradient.h"
#include "support/picture_files.h"

namespace strata {
namespace {

using test::Bytes;
using test::gradient;
using test::Inks;
using test::tiff_of;
using test::TiffSettings;
using testing::HasSubstr;

constexpr int kWidth = 37, kHeight = 23;

// Returns a gradient of red and green in which a third of the alpha values are 128.
Bytes see_through() {
  Bytes rgba = gradient(kWidth, kHeight);
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = i % 3 == 0 ? 128 : 255;
  return rgba;
}

std::function<std::uint32_t(int, int, int)> samples_of(const Bytes& rgba, int scale = 1) {
  return [&rgba, scale](int x, int y, int s) {
    return std::uint32_t{rgba[4 * (std::size_t(y) * kWidth + x) + s]} *
           static_cast<std::uint32_t>(scale);
  };
}

int worst_difference(const Bytes& a, const Bytes& b) {
  int worst = a.size() == b.size() ? 0 : 256;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(int(a[i]) - int(b[i])));
  return worst;
}

void expect_same(const Bytes& file, PictureFormat format, const Bytes& rgba, int tolerance = 0) {
  EXPECT_EQ(picture_format(file), format);
  const auto info = inspect_picture(file);
  ASSERT_TRUE(info) << info.error().detail;
  EXPECT_EQ(std::tuple(info->format, info->width, info->height),
            std::tuple(format, kWidth, kHeight));
  const auto back = decode_picture(file);
  ASSERT_TRUE(back) << back.error().detail;
  EXPECT_EQ(std::pair(back->width, back->height), std::pair(kWidth, kHeight));
  EXPECT_LE(worst_difference(back->rgba, rgba), tolerance);
  EXPECT_EQ(decode_picture(file, kWidth - 1).error().code, ErrorCode::invalid)
      << "larger than a side may be";
}

TEST(PictureFormats, a_tiff_keeps_its_pixels_however_it_is_stored) {
  const Bytes rgba = gradient(kWidth, kHeight);
  for (const auto compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (const bool tiled : {false, true})
      for (const bool separate : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << compression << (tiled ? " tiled" : "") << (separate ? " separate" : ""));
        TiffSettings settings;
        settings.compression = static_cast<std::uint16_t>(compression);
        settings.tiled = tiled;
        settings.separate = separate;
        expect_same(tiff_of(kWidth, kHeight, settings, samples_of(rgba)), PictureFormat::tiff,
                    rgba);
      }
}

TEST(PictureFormats, a_tiff_of_16_bits_grey_or_a_table_is_shown) {
  const Bytes rgba = gradient(kWidth, kHeight);
  TiffSettings deep;
  deep.bits = 16;
  // The 16-bit table of libtiff rounds, so values may differ by 1.
  expect_same(tiff_of(kWidth, kHeight, deep, samples_of(rgba, 257)), PictureFormat::tiff, rgba, 1);

  Bytes grey = rgba;
  for (std::size_t i = 0; i < grey.size(); i += 4) grey[i + 1] = grey[i + 2] = grey[i];
  TiffSettings one;
  one.samples = 1;
  one.photometric = PHOTOMETRIC_MINISBLACK;
  expect_same(tiff_of(kWidth, kHeight, one, samples_of(rgba)), PictureFormat::tiff, grey);
  one.bits = 16;
  expect_same(tiff_of(kWidth, kHeight, one, samples_of(rgba, 257)), PictureFormat::tiff, grey, 1);

  TiffSettings table;
  table.samples = 1;
  table.photometric = PHOTOMETRIC_PALETTE;
  for (const int channel : {0, 1, 2})
    for (int i = 0; i < 256; ++i)
      table.palette.push_back(static_cast<std::uint16_t>(257 * (channel == 0 ? 255 - i : i)));
  Bytes colored = grey;
  for (std::size_t i = 0; i < colored.size(); i += 4)
    colored[i] = static_cast<std::uint8_t>(255 - grey[i]);
  expect_same(tiff_of(kWidth, kHeight, table, samples_of(rgba)), PictureFormat::tiff, colored, 1);
}

TEST(PictureFormats, alpha_of_a_tiff_is_not_multiplied_in) {
  const Bytes rgba = see_through();
  TiffSettings settings;
  settings.samples = 4;
  settings.alpha = EXTRASAMPLE_UNASSALPHA;
  expect_same(tiff_of(kWidth, kHeight, settings, samples_of(rgba)), PictureFormat::tiff, rgba, 2);
}

TEST(PictureFormats, of_several_pages_the_first_one_is_taken_in_any_byte_order) {
  const Bytes rgba = gradient(kWidth, kHeight);
  TiffSettings settings;
  settings.pages = 3;
  settings.big_endian = true;
  expect_same(tiff_of(kWidth, kHeight, settings, samples_of(rgba)), PictureFormat::tiff, rgba);
}

TEST(PictureFormats, a_tiff_that_is_no_picture_says_what_it_is) {
  const auto zeros = [](int, int, int) { return 0u; };
  const auto says = [&](const TiffSettings& settings) {
    const auto file = tiff_of(kWidth, kHeight, settings, zeros);
    const auto refused = decode_picture(file);
    return refused ? "nothing" : refused.error().detail;
  };
  TiffSettings real;
  real.bits = 32;
  real.sample_format = SAMPLEFORMAT_IEEEFP;
  EXPECT_THAT(says(real), HasSubstr("floating-point"));
  TiffSettings wide;
  wide.bits = 32;
  EXPECT_THAT(says(wide), HasSubstr("32 bits"));
  TiffSettings many;
  many.samples = 9;
  EXPECT_THAT(says(many), HasSubstr("9 samples"));
  TiffSettings lying;
  lying.orientation = ORIENTATION_RIGHTTOP;
  EXPECT_THAT(says(lying), HasSubstr("rotated by 90°"));
}

TEST(PictureFormats, a_webp_keeps_its_pixels) {
  const Bytes rgba = see_through();
  expect_same(test::webp_of(rgba, kWidth, kHeight), PictureFormat::webp, rgba);
}

TEST(PictureFormats, a_bmp_keeps_its_pixels) {
  const Bytes rgba = gradient(kWidth, kHeight);
  for (const bool top_down : {false, true})
    for (const int bits : {24, 32})
      expect_same(test::bmp_of(rgba, kWidth, kHeight, bits, top_down), PictureFormat::bmp, rgba);
  Bytes colored = rgba;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    colored[i] = static_cast<std::uint8_t>(255 - rgba[i]);
    colored[i + 1] = colored[i + 2] = rgba[i];
  }
  expect_same(test::bmp_of(rgba, kWidth, kHeight, 8), PictureFormat::bmp, colored);
}

TEST(PictureFormats, a_tga_keeps_its_pixels) {
  for (const bool packed : {false, true}) {
    const Bytes rgba = gradient(kWidth, kHeight);
    expect_same(test::tga_of(rgba, kWidth, kHeight, 24, packed), PictureFormat::tga, rgba);
    expect_same(test::tga_of(see_through(), kWidth, kHeight, 32, packed), PictureFormat::tga,
                see_through());
    Bytes grey = rgba;
    for (std::size_t i = 0; i < grey.size(); i += 4) grey[i + 1] = grey[i + 2] = grey[i];
    expect_same(test::tga_of(rgba, kWidth, kHeight, 8, packed), PictureFormat::tga, grey);
  }
}

TEST(PictureFormats, inks_become_the_colours_that_they_print) {
  const Bytes rgba = gradient(kWidth, kHeight);
  for (const Inks inks : {Inks::adobe_cmyk, Inks::adobe_ycck, Inks::plain_cmyk}) {
    SCOPED_TRACE(static_cast<int>(inks));
    const Bytes file = test::cmyk_jpeg_of(rgba, kWidth, kHeight, inks);
    expect_same(file, PictureFormat::jpeg, rgba, 12);
    const auto small = decode_coarse(file, 5);
    ASSERT_TRUE(small) << small.error().detail;
    EXPECT_LT(small->width, kWidth);
  }
}

TEST(PictureFormats, every_format_that_is_cut_short_is_refused) {
  const Bytes rgba = see_through();
  TiffSettings lzw;
  lzw.compression = COMPRESSION_LZW;
  const std::pair<const char*, Bytes> files[] = {
      {"webp", test::webp_of(rgba, kWidth, kHeight)},
      {"tiff", tiff_of(kWidth, kHeight, {}, samples_of(rgba))},
      {"lzw tiff", tiff_of(kWidth, kHeight, lzw, samples_of(rgba))},
      {"bmp", test::bmp_of(rgba, kWidth, kHeight, 24)},
      {"bmp with a table", test::bmp_of(rgba, kWidth, kHeight, 8)},
      {"tga", test::tga_of(rgba, kWidth, kHeight, 32, false)},
      {"packed tga", test::tga_of(rgba, kWidth, kHeight, 24, true)},
      {"cmyk jpeg", test::cmyk_jpeg_of(rgba, kWidth, kHeight, Inks::adobe_ycck)}};
  for (const auto& [name, bytes] : files)
    for (const std::size_t length : {bytes.size() - 40, bytes.size() / 2, std::size_t{60}}) {
      const auto cut = decode_picture(std::span(bytes).first(length));
      ASSERT_FALSE(cut) << name << ' ' << length;
      EXPECT_EQ(cut.error().code, ErrorCode::invalid) << name << ' ' << length;
    }
}

TEST(PictureFormats, a_jpeg_whose_rest_was_cut_out_of_it_is_refused) {
  Bytes jpeg = encode_jpeg(gradient(200, 120), 200, 120, {90, true});
  jpeg.resize(jpeg.size() / 2);
  jpeg.insert(jpeg.end(), {0xff, 0xd9});  // a program that repairs files may append this marker
  EXPECT_FALSE(decode_picture(jpeg));
}

TEST(PictureFormats, formats_that_are_not_read_are_named) {
  const auto says = [](std::string bytes) {
    bytes.resize(200);
    const auto refused =
        decode_picture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return refused ? Error{} : refused.error();
  };
  using namespace std::literals;
  EXPECT_THAT(says("\xabKTX 20\xbb\r\n\x1a\n").detail, HasSubstr("KTX2"));
  EXPECT_THAT(says("DDS |").detail, HasSubstr("DDS"));
  EXPECT_THAT(says("\0\0\0\x1c"
                   "ftypavif"s)
                  .detail,
              HasSubstr("AVIF"));
  EXPECT_EQ(says("\xabKTX 20\xbb\r\n\x1a\n").code, ErrorCode::unsupported);
  const std::string text = says("newmtl a").detail;
  EXPECT_THAT(text, HasSubstr("TIFF, WebP, BMP or TGA"));
}

TEST(PictureFormats, what_goes_with_a_mesh_is_not_taken_for_a_tga) {
  // Indices and coordinates of a glTF file, data of a database, and zeros.
  const std::vector<Bytes> others{
      {0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0, 3, 0, 4, 0, 5, 0, 6, 0},
      {0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0},
      {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19},
      {3, 126, 7, 26, 4, 0, 0, 0, 65, 0, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0},
      Bytes(400, 0)};
  for (const Bytes& bytes : others) EXPECT_FALSE(picture_format(bytes));
}

}  // namespace
}  // namespace strata
