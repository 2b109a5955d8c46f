#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "media/jpeg_facts.h"
#include "media/picture.h"
#include "media/thumbnail.h"
#include "support/gradient.h"

namespace strata {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Inserts an APP1 segment with one entry after the start of the image.
Bytes with_orientation(const Bytes& jpeg, int orientation, bool little = true) {
  Bytes tiff = little ? Bytes{'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 0x12, 1, 3,
                              0,   1,   0,  0, 0, 0, 0, 0, 0, 0, 0,    0, 0}
                      : Bytes{'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0,
                              3,   0,   0, 0,  1, 0, 0, 0, 0, 0, 0, 0,    0};
  tiff[little ? 18 : 19] = static_cast<std::uint8_t>(orientation);
  Bytes out{0xff, 0xd8, 0xff, 0xe1, 0, static_cast<std::uint8_t>(8 + tiff.size()),
            'E',  'x',  'i',  'f',  0, 0};
  out.insert(out.end(), tiff.begin(), tiff.end());
  out.insert(out.end(), jpeg.begin() + 2, jpeg.end());
  return out;
}

// Returns an image with a different color in each corner: red and green in the upper half, blue and
// white in the lower half.
Bytes corners(int width, int height) {
  Bytes rgba;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool right = 2 * x >= width, below = 2 * y >= height;
      for (const bool lit : {!right && !below, right && !below, !right && below})
        rgba.push_back(lit || (right && below) ? 255 : 0);
      rgba.push_back(255);
    }
  return rgba;
}

// Returns r, g, b or w for the four corners: top left, top right, bottom left, bottom right.
std::string corners_of(const Picture& picture) {
  std::string found;
  for (const int y : {picture.height / 8, picture.height * 7 / 8})
    for (const int x : {picture.width / 8, picture.width * 7 / 8}) {
      const std::uint8_t* pixel =
          &picture.rgba[4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))];
      const bool r = pixel[0] > 127, g = pixel[1] > 127, b = pixel[2] > 127;
      found += r && g && b ? 'w' : r ? 'r' : g ? 'g' : b ? 'b' : '?';
    }
  return found;
}

TEST(Thumbnail, a_picture_becomes_small_and_keeps_its_shape) {
  for (const bool is_jpeg : {true, false}) {
    const auto rgba = test::gradient(1600, 800);
    const auto small = make_thumbnail(
        is_jpeg ? encode_jpeg(rgba, 1600, 800, {}) : encode_png(rgba, 1600, 800), 256);
    ASSERT_TRUE(small) << small.error().detail;
    const auto picture = decode_picture(*small);
    ASSERT_TRUE(picture);
    EXPECT_EQ(std::pair(picture->width, picture->height), std::pair(256, 128));
    for (const auto& [x, y] : {std::pair(10, 10), std::pair(128, 64), std::pair(250, 120)})
      for (int c = 0; c < 3; ++c) {
        const int now = picture->rgba[std::size_t(4 * (y * 256 + x) + c)];
        const int then = rgba[std::size_t(4 * ((y * 800 / 128) * 1600 + x * 1600 / 256) + c)];
        EXPECT_LE(std::abs(now - then), 16) << x << " " << y << " " << c;
      }
  }
}

TEST(Thumbnail, a_small_picture_stays_as_small_as_it_is) {
  const auto small = make_thumbnail(encode_png(test::gradient(20, 10), 20, 10), 256);
  ASSERT_TRUE(small);
  const auto info = inspect_picture(*small);
  EXPECT_EQ(std::pair(info->width, info->height), std::pair(20, 10));
}

TEST(Thumbnail, photographs_are_turned_as_exif_says) {
  const auto jpeg = encode_jpeg(corners(320, 160), 320, 160, {95, true});
  const std::array<const char*, 8> kSeen = {"rgbw", "grwb", "wbgr", "bwrg",
                                            "rbgw", "brwg", "wgbr", "gwrb"};
  for (int orientation = 1; orientation <= 8; ++orientation)
    for (const bool little : {true, false}) {
      const auto turned = with_orientation(jpeg, orientation, little);
      EXPECT_EQ(read_jpeg_facts(turned).orientation, orientation);
      const auto small = make_thumbnail(turned, 64);
      ASSERT_TRUE(small);
      const auto picture = decode_picture(*small);
      ASSERT_TRUE(picture);
      EXPECT_EQ(corners_of(*picture), kSeen[std::size_t(orientation - 1)]) << orientation;
      EXPECT_EQ(picture->width, orientation < 5 ? 64 : 32);
    }
}

TEST(Thumbnail, transparent_places_are_white) {
  auto rgba = Bytes(64 * 64 * 4, 0);
  const auto picture = decode_picture(*make_thumbnail(encode_png(rgba, 64, 64), 64));
  ASSERT_TRUE(picture);
  EXPECT_GT(picture->rgba[0], 250);
}

TEST(Thumbnail, a_bomb_is_refused_by_its_header) {
  auto png = encode_png(test::gradient(8, 8), 8, 8);
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i)
      png[at + std::size_t(i)] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  };
  put(16, 16000);
  put(20, 16000);
  const auto crc_of = [&] {  // CRC of the header chunk
    std::uint32_t crc = 0xffffffff;
    for (std::size_t i = 12; i < 29; ++i) {
      crc ^= png[i];
      for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return ~crc;
  };
  put(29, crc_of());
  const auto refused = make_thumbnail(png, 256);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_NE(refused.error().detail.find("256 million pixels"), std::string::npos)
      << refused.error().detail;
}

TEST(Thumbnail, what_is_no_picture_is_refused) {
  EXPECT_EQ(make_thumbnail(Bytes{'<', 's', 'v', 'g'}, 256).error().code, ErrorCode::unsupported);
  auto jpeg = encode_jpeg(test::gradient(64, 64), 64, 64, {});
  jpeg.resize(jpeg.size() / 2);
  EXPECT_EQ(make_thumbnail(jpeg, 256).error().code, ErrorCode::invalid);
}

TEST(JpegFacts, cut_and_damaged_ones_say_nothing) {
  const auto whole = with_orientation(encode_jpeg(test::gradient(16, 16), 16, 16, {}), 6);
  for (std::size_t cut = 0; cut < 60; ++cut) read_jpeg_facts(std::span(whole).first(cut));
  auto wild = whole;
  wild[16] = 0xff;  // offset of the directory
  wild[17] = 0xff;
  EXPECT_EQ(read_jpeg_facts(wild).orientation, 1);
  EXPECT_FALSE(read_jpeg_facts(whole).progressive);
}

}  // namespace
}  // namespace strata
