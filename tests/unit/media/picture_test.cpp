#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "media/picture.h"
#include "media/picture_writer.h"
#include "support/gradient.h"

namespace strata {
namespace {

using test::gradient;

TEST(Picture, a_jpeg_shows_what_was_drawn_top_row_first) {
  const auto rgba = gradient(200, 120);
  for (const bool full_color : {false, true}) {
    const auto back = decode_picture(encode_jpeg(rgba, 200, 120, {90, full_color}));
    ASSERT_TRUE(back);
    ASSERT_EQ(std::pair(back->width, back->height), std::pair(200, 120));
    int worst = 0;
    for (std::size_t i = 0; i < rgba.size(); ++i)
      worst = std::max(worst, std::abs(int(rgba[i]) - int(back->rgba[i])));
    EXPECT_LE(worst, 12);
  }
}

TEST(Picture, higher_quality_costs_more_bytes) {
  const auto rgba = gradient(256, 256);
  EXPECT_LT(encode_jpeg(rgba, 256, 256, {40, false}).size(),
            encode_jpeg(rgba, 256, 256, {95, true}).size());
}

// Returns an image with this color. If `line` is set, every 20th row has the color `line`.
std::vector<std::uint8_t> flat(std::array<std::uint8_t, 3> color,
                               std::optional<std::array<std::uint8_t, 3>> line = {}) {
  constexpr int kSide = 80;
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto& c = line && y % 20 == 9 ? *line : color;
      rgba.insert(rgba.end(), {c[0], c[1], c[2], 255});
    }
  return rgba;
}

TEST(Picture, a_jpeg_of_low_quality_does_not_tint_a_gray_background) {
  for (int level = 0; level <= 28; ++level) {
    const auto at = [&](int top) { return static_cast<std::uint8_t>(top - level); };
    const auto rgba = flat({at(242), at(240), at(236)});
    const auto back = decode_picture(encode_jpeg(rgba, 80, 80, {50, false}));
    ASSERT_TRUE(back);
    const auto tint = [](const std::vector<std::uint8_t>& pixels, int channel) {
      return int{pixels[static_cast<std::size_t>(channel)]} - int{pixels[1]};
    };
    for (const int channel : {0, 2})
      EXPECT_NEAR(tint(back->rgba, channel), tint(rgba, channel), 2) << level;
  }
}

TEST(Picture, a_jpeg_with_full_color_keeps_the_color_of_a_hairline) {
  const std::array<std::uint8_t, 3> clay{190, 100, 30}, crack{40, 190, 80};
  const auto rgba = flat(clay, crack);
  const auto error = [&](bool full_color) {
    const auto back = decode_picture(encode_jpeg(rgba, 80, 80, {80, full_color}));
    const std::size_t at = std::size_t{4} * (49 * 80 + 40);  // on a line
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
      sum += std::abs(int(back->rgba[at + c]) - int(rgba[at + c]));
    return sum;
  };
  std::printf("error of a hairline's color: 4:2:0 %.0f, 4:4:4 %.0f\n", error(false), error(true));
  EXPECT_LT(error(true), error(false) / 2);
}

TEST(PictureWriter, writes_what_the_whole_picture_would_be_however_its_rows_come) {
  const int width = 61, height = 133;
  auto rgba = gradient(width, height);
  rgba[3] = 128;
  for (const std::size_t rows : {std::size_t{1}, std::size_t{40}, std::size_t{133}}) {
    const auto write = [&](PictureFormat format, JpegSettings jpeg) {
      PictureWriter writer(format, width, height, jpeg);
      const std::span<const std::uint8_t> all(rgba);
      for (std::size_t top = 0; top < height; top += rows)
        writer.put(all.subspan(4 * width * top, 4 * width * std::min(rows, height - top)));
      return writer.finish();
    };
    const auto png = decode_picture(write(PictureFormat::png, {}));
    ASSERT_TRUE(png);
    EXPECT_EQ(png->rgba, rgba);
    for (const JpegSettings settings : {JpegSettings{90, true}, JpegSettings{60, false}}) {
      const auto jpeg = decode_picture(write(PictureFormat::jpeg, settings));
      ASSERT_TRUE(jpeg);
      EXPECT_EQ(jpeg->rgba, decode_picture(encode_jpeg(rgba, width, height, settings))->rgba);
    }
  }
}

TEST(PictureWriter, fails_where_rows_are_missing_or_are_no_rows) {
  PictureWriter writer(PictureFormat::jpeg, 8, 8);
  EXPECT_THROW(writer.put(std::vector<std::uint8_t>(31)), std::invalid_argument);
  EXPECT_THROW(writer.finish(), std::runtime_error);
  EXPECT_THROW(PictureWriter(PictureFormat::png, 0, 8), std::invalid_argument);
}

TEST(Picture, a_png_keeps_every_pixel) {
  auto rgba = gradient(61, 33);
  rgba[3] = 128;
  const auto png = encode_png(rgba, 61, 33);
  const auto back = decode_picture(png);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->width, 61);
  EXPECT_EQ(back->rgba, rgba);
}

TEST(Picture, a_picture_of_one_pixel_is_encoded) {
  const std::vector<std::uint8_t> red{255, 0, 0, 255};
  EXPECT_EQ(decode_picture(encode_jpeg(red, 1, 1, {90, true}))->width, 1);
  EXPECT_EQ(decode_picture(encode_png(red, 1, 1))->rgba, red);
}

TEST(Picture, pixels_that_do_not_have_the_size_are_refused) {
  const std::vector<std::uint8_t> few(16);
  EXPECT_THROW(encode_jpeg(few, 4, 4, {}), std::invalid_argument);
  EXPECT_THROW(encode_png(few, 0, 4), std::invalid_argument);
}

TEST(Picture, format_and_size_are_told_without_decoding) {
  const auto rgba = gradient(200, 120);
  const auto jpeg = encode_jpeg(rgba, 200, 120, {}), png = encode_png(rgba, 200, 120);
  EXPECT_EQ(picture_format(jpeg), PictureFormat::jpeg);
  EXPECT_EQ(picture_format(png), PictureFormat::png);
  EXPECT_EQ(media_type(PictureFormat::png), "image/png");
  for (const auto& bytes : {jpeg, png}) {
    const auto info = inspect_picture(bytes);
    ASSERT_TRUE(info);
    EXPECT_EQ(std::pair(info->width, info->height), std::pair(200, 120));
  }
}

TEST(Picture, what_is_no_picture_or_too_large_or_cut_short_is_refused) {
  const auto rgba = gradient(200, 120);
  const std::vector<std::uint8_t> text{'B', 'M', 1, 2, 3};
  EXPECT_EQ(decode_picture(text).error().code, ErrorCode::unsupported);
  EXPECT_EQ(inspect_picture({}).error().code, ErrorCode::unsupported);
  for (auto bytes : {encode_jpeg(rgba, 200, 120, {}), encode_png(rgba, 200, 120)}) {
    EXPECT_EQ(decode_picture(bytes, 199).error().code, ErrorCode::invalid);
    EXPECT_EQ(inspect_picture(bytes, 199).error().code, ErrorCode::invalid);
    EXPECT_TRUE(decode_picture(bytes, 200));
    for (const std::size_t length : {bytes.size() / 2, std::size_t{30}, std::size_t{9}}) {
      const auto cut = decode_picture(std::span(bytes).first(length));
      ASSERT_FALSE(cut) << length;
      EXPECT_EQ(cut.error().code, ErrorCode::invalid);
    }
  }
}

}  // namespace
}  // namespace strata
