// The reader returns the same texels for TIFF and NumPy files with every type of number, byte order
// and layout. GIS programs can read Strata's TIFF files.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "media/tiff_memory.h"
#include "query/rasters/raster.h"

namespace strata::query {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kSide = kTileSize;
constexpr double kNodata = 120;

struct Form {
  char kind;  // the letter of NumPy: u, i or f
  int bytes;
  std::string name() const { return std::string(1, kind) + std::to_string(bytes); }
};
constexpr Form kForms[] = {{'u', 1}, {'u', 2}, {'u', 4}, {'u', 8}, {'i', 1}, {'i', 2},
                           {'i', 4}, {'i', 8}, {'f', 2}, {'f', 4}, {'f', 8}};

Layer layer_of(ValueType type) {
  Layer layer;
  layer.name = "Salt";
  layer.type = type;
  layer.resolution = kSide;
  return layer;
}

// The raster that all files contain. `row` counts from the top.
bool is_painted(int x, int row) { return (x + 3 * row) % 5 != 0; }
double value_at(int x, int row) { return (7 * x + 3 * row) % 101; }

Bytes sample(const Form& form, double value, bool big_endian = false) {
  std::uint64_t bits = 0;
  if (form.kind == 'f' && form.bytes == 8)
    bits = std::bit_cast<std::uint64_t>(value);
  else if (form.kind == 'f' && form.bytes == 4)
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  else if (form.kind == 'f')
    bits = std::isnan(value) ? 0x7e00u : *encode_value(ValueType::f16, value);
  else if (value < 0)
    bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
  else
    bits = value >= 0x1p64 ? ~std::uint64_t{0} : static_cast<std::uint64_t>(value);
  Bytes bytes(static_cast<std::size_t>(form.bytes));
  std::memcpy(bytes.data(), &bits, bytes.size());
  if (big_endian) std::ranges::reverse(bytes);
  return bytes;
}

void expect_expected(const Layer& layer, const TileMap& tiles, bool all_painted = false,
                     const std::function<double(double)>& shown = {}) {
  ASSERT_EQ(tiles.size(), 1u);
  const TileData& tile = *tiles.begin()->second;
  int wrong = 0;
  for (int row = 0; row < kSide; ++row)
    for (int x = 0; x < kSide; ++x) {
      const int texel = (kSide - 1 - row) * kTileSize + x;
      const bool painted = all_painted || is_painted(x, row);
      const double value = shown ? shown(value_at(x, row)) : value_at(x, row);
      wrong += tile.valid.test(texel) != painted ||
               decode_value(layer.type, tile.bits(texel)) != (painted ? value : 0);
    }
  EXPECT_EQ(wrong, 0);
}

enum class Layout { interleaved, separate, nodata, mask };

struct TiffKind {
  Form form{'u', 1};
  Layout layout = Layout::interleaved;
  bool big_endian = false, tiled = false;
  int compression = COMPRESSION_NONE;
  int mask_bits = 1;
  std::function<double(int, int)> value = value_at;
};

void set_size(TIFF* tiff, const TiffKind& kind) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kSide);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kSide);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
  if (kind.tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 48);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 32);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 13);
  }
}

// Writes the pixels of one plane of the current directory. `pixel(x, row)` returns the bytes of a
// pixel.
void write_plane(TIFF* tiff, const TiffKind& kind, std::uint16_t plane,
                 const std::function<Bytes(int x, int row)>& pixel) {
  const std::size_t bytes = pixel(0, 0).size();
  const auto put_row = [&](std::uint8_t* to, int left, int row, int count) {
    for (int x = left; x < std::min(left + count, kSide); ++x, to += bytes) {
      const Bytes from = pixel(x, std::min(row, kSide - 1));
      std::copy(from.begin(), from.end(), to);
    }
  };
  Bytes buffer(bytes * (kind.tiled ? 48 * 32 : kSide));
  if (!kind.tiled)
    for (int row = 0; row < kSide; ++row) {
      put_row(buffer.data(), 0, row, kSide);
      ASSERT_EQ(TIFFWriteScanline(tiff, buffer.data(), static_cast<std::uint32_t>(row), plane), 1);
    }
  else
    for (int top = 0; top < kSide; top += 32)
      for (int left = 0; left < kSide; left += 48) {
        for (int y = 0; y < 32; ++y)
          put_row(buffer.data() + bytes * 48 * static_cast<std::size_t>(y), left, top + y, 48);
        ASSERT_GT(TIFFWriteTile(tiff, buffer.data(), static_cast<std::uint32_t>(left),
                                static_cast<std::uint32_t>(top), 0, plane),
                  0);
      }
}

Bytes write_tiff(const TiffKind& kind) {
  Bytes out;
  TiffMemory file{{}, &out, 0, {}};
  Tiff tiff = open_tiff(file, kind.big_endian ? "wbm" : "wlm");
  const bool has_valid = kind.layout == Layout::interleaved || kind.layout == Layout::separate;
  set_size(tiff.get(), kind);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, has_valid ? 2 : 1);
  TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8 * kind.form.bytes);
  TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT,
               kind.form.kind == 'f'   ? SAMPLEFORMAT_IEEEFP
               : kind.form.kind == 'i' ? SAMPLEFORMAT_INT
                                       : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG,
               kind.layout == Layout::separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  if (kind.layout == Layout::nodata) {
    static char name[] = "GDALNoDataValue";
    static const TIFFFieldInfo field{42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name};
    TIFFMergeFieldInfo(tiff.get(), &field, 1);
    TIFFSetField(tiff.get(), 42113, "120");
  }
  const auto value = [&](int x, int row) {
    if (kind.layout != Layout::nodata || is_painted(x, row))
      return sample(kind.form, kind.value(x, row));
    const bool is_nan = kind.form.kind == 'f' && x % 2 == 0;
    return sample(kind.form, is_nan ? std::numeric_limits<double>::quiet_NaN() : kNodata);
  };
  const auto valid = [&](int x, int row) { return sample(kind.form, is_painted(x, row) ? 1 : 0); };
  if (kind.layout == Layout::interleaved) {
    write_plane(tiff.get(), kind, 0, [&](int x, int row) {
      Bytes both = value(x, row);
      const Bytes second = valid(x, row);
      both.insert(both.end(), second.begin(), second.end());
      return both;
    });
  } else {
    write_plane(tiff.get(), kind, 0, value);
    if (kind.layout == Layout::separate) write_plane(tiff.get(), kind, 1, valid);
  }
  EXPECT_EQ(TIFFWriteDirectory(tiff.get()), 1);
  if (kind.layout == Layout::mask) {
    set_size(tiff.get(), kind);
    TIFFSetField(tiff.get(), TIFFTAG_SUBFILETYPE, FILETYPE_MASK);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, kind.mask_bits);
    TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MASK);
    if (kind.mask_bits == 8) {
      write_plane(tiff.get(), kind, 0,
                  [&](int x, int row) { return Bytes(1, is_painted(x, row) ? 255 : 0); });
    } else {
      const bool tiled = kind.tiled;
      Bytes bits(tiled ? 6 * 32 : kSide / 8);
      for (int top = 0; top < kSide; top += tiled ? 32 : 1)
        for (int left = 0; left < kSide; left += tiled ? 48 : kSide) {
          std::ranges::fill(bits, std::uint8_t{0});
          for (int y = 0; y < (tiled ? 32 : 1); ++y)
            for (int x = left; x < std::min(kSide, left + (tiled ? 48 : kSide)); ++x)
              if (is_painted(x, top + y))
                bits[static_cast<std::size_t>(y * (tiled ? 6 : 0) + (x - left) / 8)] |=
                    static_cast<std::uint8_t>(0x80u >> (x - left) % 8);
          if (tiled)
            TIFFWriteTile(tiff.get(), bits.data(), static_cast<std::uint32_t>(left),
                          static_cast<std::uint32_t>(top), 0, 0);
          else
            TIFFWriteScanline(tiff.get(), bits.data(), static_cast<std::uint32_t>(top), 0);
        }
    }
    EXPECT_EQ(TIFFWriteDirectory(tiff.get()), 1);
  }
  tiff.reset();
  return out;
}

TEST(QueryRasterForms, a_tiff_of_every_kind_order_layout_and_compression_brings_the_same_texels) {
  for (const Form& form : kForms)
    for (const bool big_endian : {false, true})
      for (const auto layout :
           {Layout::interleaved, Layout::separate, Layout::nodata, Layout::mask})
        for (const bool tiled : {false, true})
          for (const int compression :
               {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
            SCOPED_TRACE(form.name() + " big " + std::to_string(big_endian) + " layout " +
                         std::to_string(static_cast<int>(layout)) + " tiled " +
                         std::to_string(tiled) + " compression " + std::to_string(compression));
            const Bytes bytes =
                write_tiff({form, layout, big_endian, tiled, compression, tiled ? 8 : 1});
            for (const auto type : {ValueType::i16, ValueType::f32}) {
              const auto tiles = decode_tiff(layer_of(type), bytes);
              ASSERT_TRUE(tiles) << tiles.error().detail;
              expect_expected(layer_of(type), *tiles);
            }
          }
}

TEST(QueryRasterForms, a_mask_may_have_one_or_eight_bits_in_strips_and_tiles) {
  for (const bool tiled : {false, true})
    for (const int bits : {1, 8}) {
      const auto tiles = decode_tiff(
          layer_of(ValueType::u8),
          write_tiff({{'u', 1}, Layout::mask, false, tiled, COMPRESSION_ADOBE_DEFLATE, bits}));
      ASSERT_TRUE(tiles) << tiles.error().detail;
      expect_expected(layer_of(ValueType::u8), *tiles);
    }
}

struct NpyKind {
  std::string value;  // such as "<f4"
  Form form;
  bool big_endian = false, by_columns = false, structured = false;
};

Bytes write_npy(const NpyKind& kind, const std::function<double(int, int)>& value) {
  const std::string descr = kind.structured ? "[('value', '" + kind.value + "'), ('valid', '|b1')]"
                                            : "'" + kind.value + "'";
  std::string header =
      "{'descr': " + descr + ", 'fortran_order': " + (kind.by_columns ? "True" : "False") +
      ", 'shape': (" + std::to_string(kSide) + ", " + std::to_string(kSide) + "), }\n";
  std::string before("\x93NUMPY\1\0", 8);
  before += static_cast<char>(header.size());
  before += '\0';
  before += header;
  Bytes out(before.begin(), before.end());
  for (int slow = 0; slow < kSide; ++slow)
    for (int fast = 0; fast < kSide; ++fast) {
      const int row = kind.by_columns ? fast : slow, x = kind.by_columns ? slow : fast;
      const Bytes number = sample(kind.form, value(x, row), kind.big_endian);
      out.insert(out.end(), number.begin(), number.end());
      if (kind.structured) out.push_back(is_painted(x, row) ? 1 : 0);
    }
  return out;
}

TEST(QueryRasterForms, a_numpy_array_of_every_kind_and_order_brings_the_same_texels) {
  for (const Form& form : kForms)
    for (const char order : {'<', '>', '|', '='})
      for (const bool by_columns : {false, true})
        for (const bool structured : {false, true}) {
          const NpyKind kind{order + form.name(), form, order == '>', by_columns, structured};
          SCOPED_TRACE(kind.value + (by_columns ? " Fortran" : " C") +
                       (structured ? " structured" : ""));
          const bool with_gaps = form.kind == 'f' && !structured;  // NaN marks a gap
          const Bytes bytes = write_npy(kind, [&](int x, int row) {
            return with_gaps && !is_painted(x, row) ? std::numeric_limits<double>::quiet_NaN()
                                                    : value_at(x, row);
          });
          for (const auto type :
               {ValueType::i8, ValueType::u16, ValueType::i32, ValueType::f16, ValueType::f32}) {
            const auto tiles = decode_npy(layer_of(type), bytes);
            ASSERT_TRUE(tiles) << tiles.error().detail;
            expect_expected(layer_of(type), *tiles, !structured && !with_gaps);
          }
        }
  const auto odd = [](double value) { return static_cast<double>(static_cast<int>(value) % 2); };
  const auto truths = decode_npy(
      layer_of(ValueType::u8),
      write_npy({"|b1", {'u', 1}}, [&](int x, int row) { return odd(value_at(x, row)); }));
  ASSERT_TRUE(truths) << truths.error().detail;
  expect_expected(layer_of(ValueType::u8), *truths, true, odd);
}

TEST(QueryRasterForms, doubles_are_rounded_to_the_nearest_float) {
  const auto tenth = [](double value) { return value + 0.1; };
  const auto tiles = decode_npy(
      layer_of(ValueType::f32),
      write_npy({"<f8", {'f', 8}}, [&](int x, int row) { return tenth(value_at(x, row)); }));
  ASSERT_TRUE(tiles) << tiles.error().detail;
  expect_expected(layer_of(ValueType::f32), *tiles, true,
                  [&](double value) { return double{static_cast<float>(tenth(value))}; });
}

TEST(QueryRasterForms, the_first_number_that_does_not_fit_is_named_with_its_place) {
  struct Case {
    ValueType type;
    Form form;
    double value;
    const char* text;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Case& wrong : {Case{ValueType::u8, {'u', 2}, 256, "256"},
                            {ValueType::u8, {'i', 4}, -1, "-1"},
                            {ValueType::i8, {'u', 1}, 128, "128"},
                            {ValueType::u32, {'u', 8}, 4294967296.0, "4294967296"},
                            {ValueType::i32, {'u', 8}, 0x1p64, "18446744073709551615"},
                            {ValueType::f32, {'i', 4}, 16777217, "16777217"},
                            {ValueType::f32, {'f', 8}, 1e39, "1e+39"},
                            {ValueType::f16, {'f', 4}, 65536, "65536"},
                            {ValueType::u16, {'f', 4}, 0.5, "0.5"},
                            {ValueType::i16, {'f', 8}, infinity, "inf"},
                            {ValueType::f32, {'f', 4}, infinity, ""}}) {
    SCOPED_TRACE(std::string(name(wrong.type)) + " from " + wrong.form.name());
    const auto value = [&](int x, int row) {
      return (row == 3 && x >= 7) || row == 90 ? wrong.value : 1.0;
    };
    const Form& form = wrong.form;
    TiffKind tiff{form, Layout::mask};
    tiff.value = value;
    for (const auto& tiles :
         {decode_npy(layer_of(wrong.type), write_npy({"<" + form.name(), form}, value)),
          decode_tiff(layer_of(wrong.type), write_tiff(tiff))}) {
      ASSERT_FALSE(tiles);
      EXPECT_EQ(tiles.error().code, ErrorCode::invalid);
      EXPECT_NE(tiles.error().detail.find("column 7 of row 3"), std::string::npos)
          << tiles.error().detail;
      EXPECT_NE(tiles.error().detail.find(std::string("The value ") + wrong.text),
                std::string::npos)
          << tiles.error().detail;
    }
  }
}

TEST(QueryRasterForms, types_that_no_layer_takes_are_refused_and_named) {
  for (const char* type : {"<c8", "<f16", "|S4", "<M8", "<u3", "<b4", "?u1"}) {
    const auto tiles = decode_npy(layer_of(ValueType::u8), write_npy({type, {'u', 1}}, value_at));
    ASSERT_FALSE(tiles) << type;
    EXPECT_EQ(tiles.error().code, ErrorCode::invalid);
    EXPECT_NE(tiles.error().detail.find(type), std::string::npos) << tiles.error().detail;
  }
}

TEST(QueryRasterForms, files_with_a_mask_or_planes_that_are_cut_or_damaged_never_crash) {
  unsigned state = 7;
  const auto random = [&] { return state = state * 1664525u + 1013904223u, state >> 8; };
  for (const auto layout : {Layout::separate, Layout::nodata, Layout::mask})
    for (const bool tiled : {false, true}) {
      const Bytes bytes = write_tiff({{'f', 8}, layout, true, tiled, COMPRESSION_LZW, 1});
      for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 60)
        EXPECT_FALSE(decode_tiff(layer_of(ValueType::f32), std::span(bytes).first(size)))
            << size << " of " << bytes.size();
      for (int round = 0; round < 300; ++round) {
        Bytes broken = bytes;
        for (int i = 0; i < 3; ++i)
          broken[broken.size() - 1 - random() % std::min<std::size_t>(broken.size(), 900)] ^=
              static_cast<std::uint8_t>(1u << random() % 8);
        const auto tiles = decode_tiff(layer_of(ValueType::f32), broken);
        EXPECT_TRUE(tiles || tiles.error().code == ErrorCode::invalid);
      }
    }
}

// The file marks unpainted texels as GDAL expects: an internal mask for all types, and for floats
// also NaN and its tag.
TEST(QueryRasterForms, our_tiff_marks_what_is_not_painted_for_gis) {
  for (const auto type : {ValueType::u8, ValueType::u16, ValueType::u32, ValueType::i16,
                          ValueType::f16, ValueType::f32}) {
    SCOPED_TRACE(name(type));
    auto tile = std::make_shared<TileData>(type);
    for (int row = 0; row < kSide; ++row)
      for (int x = 0; x < kSide; ++x)
        if (is_painted(x, row))
          tile->write((kSide - 1 - row) * kTileSize + x, *encode_value(type, value_at(x, row)));
    const Layer layer = layer_of(type);
    const auto bytes = encode_tiff(layer, {{{0, 0}, tile}});
    ASSERT_TRUE(bytes) << bytes.error().detail;
    const auto back = decode_tiff(layer, *bytes);
    ASSERT_TRUE(back) << back.error().detail;
    expect_expected(layer, *back);

    TiffMemory file{*bytes, nullptr, 0, {}};
    const Tiff tiff = open_tiff(file, "rm");
    ASSERT_EQ(TIFFNumberOfDirectories(tiff.get()), 2);
    std::uint32_t length = 0;
    const char* text = nullptr;
    const bool has_nodata = TIFFGetField(tiff.get(), 42113, &length, &text) == 1;
    EXPECT_EQ(has_nodata, is_float(type));
    EXPECT_STREQ(has_nodata ? text : "nan", "nan");
    std::uint32_t kind = 0;
    std::uint16_t bits = 0, photometric = 0;
    TIFFSetDirectory(tiff.get(), 1);
    TIFFGetField(tiff.get(), TIFFTAG_SUBFILETYPE, &kind);
    TIFFGetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff.get(), TIFFTAG_PHOTOMETRIC, &photometric);
    EXPECT_EQ(kind, FILETYPE_MASK);
    EXPECT_EQ(bits, 1);
    EXPECT_EQ(photometric, PHOTOMETRIC_MASK);
    Bytes mask(256 * 256 / 8);
    ASSERT_GT(TIFFReadTile(tiff.get(), mask.data(), 0, 0, 0, 0), 0);
    for (int row = 0; row < kSide; ++row)
      for (int x = 0; x < kSide; ++x)
        ASSERT_EQ((mask[static_cast<std::size_t>(row * 32 + x / 8)] >> (7 - x % 8) & 1) != 0,
                  is_painted(x, row));
  }
}

}  // namespace
}  // namespace strata::query
