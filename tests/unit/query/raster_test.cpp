#include "query/rasters/raster.h"

#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

namespace strata::query {
namespace {

constexpr ValueType kTypes[] = {ValueType::u8,  ValueType::u16, ValueType::u32, ValueType::i8,
                                ValueType::i16, ValueType::i32, ValueType::f16, ValueType::f32};

Layer layer_of(ValueType type, int resolution = 384) {
  Layer layer;
  layer.name = "Salt";
  layer.type = type;
  layer.resolution = resolution;
  return layer;
}

// Paints some of the tiles with values of the whole range, including both limits and 0, which is
// also a value.
TileMap paint(const Layer& layer, unsigned seed = 1) {
  std::mt19937 random(seed);
  const double values[] = {0, 1, lowest_value(layer.type), highest_value(layer.type),
                           is_float(layer.type) ? 0.25 : 3};
  TileMap tiles;
  const int side = (layer.resolution + kTileSize - 1) / kTileSize;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if ((x + 2 * y) % 3 == 1) continue;
      auto tile = std::make_shared<TileData>(layer.type);
      for (int i = 0; i < 4000; ++i)
        tile->write(static_cast<int>(random() % kTexelsPerTile),
                    *encode_value(layer.type, values[random() % 5]));
      tiles[{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}] = tile;
    }
  return tiles;
}

void expect_equal(const TileMap& a, const TileMap& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [address, tile] : a) {
    ASSERT_TRUE(b.contains(address)) << address.x << "," << address.y;
    EXPECT_TRUE(*tile == *b.at(address)) << address.x << "," << address.y;
  }
}

using Bytes = std::vector<std::uint8_t>;
struct Format {
  const char* name;
  Result<Bytes> (*encode)(const Layer&, const TileMap&);
  Result<TileMap> (*decode)(const Layer&, std::span<const std::uint8_t>);
};
constexpr Format kFormats[] = {{"tif", encode_tiff, decode_tiff},
                               {"png", encode_png, decode_png},
                               {"npy", encode_npy, decode_npy}};

bool holds(const Format& format, ValueType type) {
  return format.encode != encode_png || type == ValueType::u8 || type == ValueType::u16;
}

TEST(QueryRaster, every_type_comes_back_as_it_went_out) {
  for (const auto& format : kFormats)
    for (const auto type : kTypes) {
      if (!holds(format, type)) continue;
      SCOPED_TRACE(std::string(format.name) + " " + std::string(name(type)));
      const Layer layer = layer_of(type);
      const TileMap tiles = paint(layer);
      const auto bytes = format.encode(layer, tiles);
      ASSERT_TRUE(bytes) << bytes.error().detail;
      const auto back = format.decode(layer, *bytes);
      ASSERT_TRUE(back) << back.error().detail;
      expect_equal(*back, tiles);
    }
}

TEST(QueryRaster, an_empty_layer_comes_back_empty) {
  for (const auto& format : kFormats) {
    const Layer layer = layer_of(ValueType::u8);
    const auto bytes = format.encode(layer, {});
    ASSERT_TRUE(bytes);
    const auto back = format.decode(layer, *bytes);
    ASSERT_TRUE(back) << back.error().detail;
    EXPECT_TRUE(back->empty());
  }
}

// Row 0 of the file is the top of the texture, but tiles count from the bottom.
TEST(QueryRaster, the_first_row_of_a_file_is_the_top_of_the_texture) {
  const Layer layer = layer_of(ValueType::u16, 256);
  auto tile = std::make_shared<TileData>(ValueType::u16);
  tile->write(127 * kTileSize + 5, 0x0102);  // top row of the upper left tile
  const TileMap tiles{{{0, 1}, tile}};

  const auto npy = encode_npy(layer, tiles);
  ASSERT_TRUE(npy);
  const std::string text(npy->begin(), npy->begin() + 128);
  EXPECT_NE(
      text.find(
          "{'descr': [('value', '<u2'), ('valid', '|b1')], 'fortran_order': False, 'shape': (256, 256), }"),
      std::string::npos);
  const std::size_t data = npy->size() - 256 * 256 * 3;
  EXPECT_EQ(data % 64, 0u);
  EXPECT_EQ((*npy)[data + 5 * 3], 2);
  EXPECT_EQ((*npy)[data + 5 * 3 + 1], 1);
  EXPECT_EQ((*npy)[data + 5 * 3 + 2], 1);
  EXPECT_EQ((*npy)[data + 4 * 3 + 2], 0);

  const auto png = encode_png(layer, tiles);
  ASSERT_TRUE(png);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, png->data(), png->size()));
  EXPECT_EQ(image.format, unsigned(PNG_FORMAT_LINEAR_Y_ALPHA)) << "16 bit grey with alpha";
  image.format = PNG_FORMAT_GA;
  Bytes pixels(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels[5 * 2 + 1], 255);
  EXPECT_EQ(pixels[4 * 2 + 1], 0);
}

TEST(QueryRaster, a_tiff_is_tiled_and_says_what_its_samples_are) {
  for (const auto type : kTypes) {
    const Layer layer = layer_of(type);
    const auto bytes = encode_tiff(layer, paint(layer));
    ASSERT_TRUE(bytes);
    const auto path = std::filesystem::path(testing::TempDir()) /
                      ("strata_raster_" + std::string(name(type)) + ".tif");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()), std::streamsize(bytes->size()));
    TIFF* tiff = TIFFOpen(path.c_str(), "r");
    ASSERT_NE(tiff, nullptr);
    std::uint16_t samples = 0, bits = 0, format = 0, compression = 0;
    std::uint32_t width = 0, tile = 0;
    TIFFGetField(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetField(tiff, TIFFTAG_COMPRESSION, &compression);
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile);
    TIFFClose(tiff);
    std::filesystem::remove(path);
    EXPECT_EQ(samples, 2);
    EXPECT_EQ(bits, 8 * bytes_per_texel(type));
    EXPECT_EQ(format, is_float(type)           ? SAMPLEFORMAT_IEEEFP
                      : lowest_value(type) < 0 ? SAMPLEFORMAT_INT
                                               : SAMPLEFORMAT_UINT);
    EXPECT_EQ(compression, COMPRESSION_ADOBE_DEFLATE);
    EXPECT_EQ(width, 384u);
    EXPECT_EQ(tile, 256u);
  }
}

// Other programs write strips, another codec and big-endian numbers.
TEST(QueryRaster, a_striped_big_endian_tiff_of_another_program_is_read) {
  const Layer layer = layer_of(ValueType::i16, 256);
  const auto path = std::filesystem::path(testing::TempDir()) / "strata_striped.tif";
  TIFF* tiff = TIFFOpen(path.c_str(), "wb");
  ASSERT_NE(tiff, nullptr);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 256);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 256);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 2);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_INT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, 2);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 13);
  for (int row = 0; row < 256; ++row) {
    std::vector<std::int16_t> line(512);
    for (int x = 0; x < 256; ++x) {
      line[2 * x] = static_cast<std::int16_t>(x - row);
      line[2 * x + 1] = x > row ? 1 : 0;
    }
    TIFFWriteScanline(tiff, line.data(), row, 0);
  }
  TIFFClose(tiff);
  std::ifstream file(path, std::ios::binary);
  const Bytes bytes((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  ASSERT_EQ(bytes[0], 'M');
  const auto tiles = decode_tiff(layer, bytes);
  ASSERT_TRUE(tiles) << tiles.error().detail;
  for (int row = 0; row < 256; ++row)
    for (int x = 0; x < 256; ++x) {
      const int y = 255 - row;
      const TileAddress address{static_cast<std::uint16_t>(x / 128),
                                static_cast<std::uint16_t>(y / 128)};
      const auto found = tiles->find(address);
      const int texel = y % 128 * 128 + x % 128;
      const bool valid = found != tiles->end() && found->second->valid.test(texel);
      ASSERT_EQ(valid, x > row);
      if (found == tiles->end()) continue;
      const std::uint32_t bits = found->second->bits(texel);
      ASSERT_EQ(decode_value(layer.type, bits), valid ? x - row : 0) << "an invalid texel stores 0";
    }
}

TEST(QueryRaster, a_png_of_other_than_small_whole_numbers_is_not_possible) {
  for (const auto type : kTypes) {
    if (holds(kFormats[1], type)) continue;
    const auto bytes = encode_png(layer_of(type), {});
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::not_acceptable);
    EXPECT_EQ(decode_png(layer_of(type), {}).error().code, ErrorCode::unsupported);
  }
}

TEST(QueryRaster, another_size_is_refused_and_named) {
  for (const auto& format : kFormats) {
    SCOPED_TRACE(format.name);
    const Layer small = layer_of(ValueType::u8, 256), large = layer_of(ValueType::u8, 512),
                wide = layer_of(ValueType::u16, 256);
    const auto bytes = format.encode(small, paint(small));
    ASSERT_TRUE(bytes);
    const auto other_size = format.decode(large, *bytes);
    ASSERT_FALSE(other_size);
    EXPECT_EQ(other_size.error().code, ErrorCode::invalid);
    EXPECT_NE(other_size.error().detail.find("256"), std::string::npos)
        << other_size.error().detail;
    EXPECT_NE(other_size.error().detail.find("512 × 512"), std::string::npos)
        << other_size.error().detail;
    if (format.decode != decode_png) continue;
    const auto other_type = format.decode(wide, *bytes);
    ASSERT_FALSE(other_type);
    EXPECT_EQ(other_type.error().code, ErrorCode::invalid);
  }
  const Layer whole = layer_of(ValueType::i32, 256), real = layer_of(ValueType::f32, 256);
  EXPECT_FALSE(decode_tiff(real, *encode_tiff(whole, paint(whole))))
      << "2147483647 is no 32-bit float";
  EXPECT_FALSE(decode_npy(real, *encode_npy(whole, paint(whole))));
}

TEST(QueryRaster, a_valid_texel_that_is_not_finite_is_refused_with_its_place) {
  for (const auto type : {ValueType::f16, ValueType::f32}) {
    const Layer layer = layer_of(type, 256);
    auto tile = std::make_shared<TileData>(type);
    tile->write(127 * kTileSize + 9, type == ValueType::f16 ? 0x7e00u : 0x7fc00000u);
    const TileMap tiles{{{0, 1}, tile}};
    for (const auto& format : {kFormats[0], kFormats[2]}) {
      const auto back = format.decode(layer, *format.encode(layer, tiles));
      ASSERT_FALSE(back);
      EXPECT_NE(back.error().detail.find("column 9 of row 0"), std::string::npos)
          << back.error().detail;
    }
  }
}

TEST(QueryRaster, a_file_of_another_kind_is_refused) {
  const Layer layer = layer_of(ValueType::u8, 256);
  const Bytes empty, text{'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd', '!', '!', '!'};
  for (const auto& format : kFormats) {
    EXPECT_FALSE(format.decode(layer, empty));
    EXPECT_FALSE(format.decode(layer, text));
    for (const auto& other : kFormats) {
      if (other.encode == format.encode) continue;
      EXPECT_FALSE(format.decode(layer, *other.encode(layer, paint(layer))));
    }
  }
}

TEST(QueryRaster, a_truncated_file_is_refused_where_texels_are_missing) {
  for (const auto& format : kFormats) {
    const Layer layer = layer_of(ValueType::u16, 256);
    const auto bytes = format.encode(layer, paint(layer));
    ASSERT_TRUE(bytes);
    for (std::size_t size = 0; size < bytes->size(); size += 1 + bytes->size() / 150) {
      const auto back = format.decode(layer, std::span(*bytes).first(size));
      // The end of a TIFF contains comments and the mask. Without these, all texels are still
      // complete.
      if (back && format.decode == decode_tiff && size > bytes->size() * 3 / 4)
        expect_equal(*back, paint(layer));
      else
        EXPECT_FALSE(back) << format.name << " cut to " << size << " of " << bytes->size();
    }
  }
}

// Tests only that the decoder neither crashes nor hangs. The sanitizer build detects more faults.
TEST(QueryRaster, flipped_bits_never_crash) {
  std::mt19937 random(5);
  for (const auto& format : kFormats) {
    const Layer layer = layer_of(ValueType::u8, 256);
    const auto bytes = format.encode(layer, paint(layer));
    ASSERT_TRUE(bytes);
    int refused = 0;
    for (int round = 0; round < 600; ++round) {
      Bytes broken = *bytes;
      // Wrong values have the greatest effect in headers and directories. These are at the start,
      // or at the end for TIFF.
      const std::size_t area =
          round % 3 == 0 ? broken.size() : std::min<std::size_t>(broken.size(), 400);
      const std::size_t from = round % 3 == 1 ? broken.size() - area : 0;
      for (int i = 0; i <= round % 4; ++i)
        broken[from + random() % area] ^= static_cast<std::uint8_t>(1u << random() % 8);
      if (!format.decode(layer, broken)) ++refused;
    }
    EXPECT_GT(refused, 50) << format.name;
  }
}

TEST(QueryRaster, a_numpy_header_in_another_spelling_is_read) {
  const Layer layer = layer_of(ValueType::u8, 256);
  const TileMap tiles = paint(layer);
  const auto ours = encode_npy(layer, tiles);
  ASSERT_TRUE(ours);
  std::string header =
      "{\"shape\": (256,256), \"descr\": [(\"value\", \"|u1\"), (\"valid\", \"|b1\")], \"fortran_order\": False}\n";
  Bytes bytes{0x93, 'N', 'U', 'M', 'P', 'Y', 2, 0, static_cast<std::uint8_t>(header.size()),
              0,    0,   0};
  bytes.insert(bytes.end(), header.begin(), header.end());
  bytes.insert(bytes.end(), ours->end() - 256 * 256 * 2, ours->end());
  const auto back = decode_npy(layer, bytes);
  ASSERT_TRUE(back) << back.error().detail;
  expect_equal(*back, tiles);
}

}  // namespace
}  // namespace strata::query
