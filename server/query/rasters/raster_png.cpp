#include <cstring>
#include <memory>
#include <string>

#include "media/guarded_png.h"
#include "query/rasters/raster.h"
#include "query/rasters/raster_rows.h"

namespace strata::query {
namespace {

struct Reader {
  PngMessage message;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, keep_png_message, ignore_png_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  std::span<const std::uint8_t> rest;
  Reader() = default;
  Reader(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  out->insert(out->end(), data, data + size);
}

void take_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (size > reader->rest.size()) png_error(png, "the file ends too early");
  std::memcpy(data, reader->rest.data(), size);
  reader->rest = reader->rest.subspan(size);
}

bool fits_png(ValueType type) { return type == ValueType::u8 || type == ValueType::u16; }

std::string describe(int color_type, int bit_depth) {
  const char* kind = "colour";
  if (color_type == PNG_COLOR_TYPE_GRAY) kind = "gray without alpha";
  if (color_type == PNG_COLOR_TYPE_GRAY_ALPHA) kind = "gray with alpha";
  if (color_type == PNG_COLOR_TYPE_PALETTE) kind = "palette";
  return std::to_string(bit_depth) + "-bit " + kind;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_png(const Layer& layer, const TileMap& tiles) {
  if (!fits_png(layer.type))
    return fail(ErrorCode::not_acceptable, "Values not supported by PNG",
                "PNG can store only whole numbers from 0 to 65535. The values of this layer are " +
                    std::string(name(layer.type)) + ". Request texels.tif or texels.npy.");
  const int width = bytes_per_texel(layer.type);
  const TileRows rows(layer, tiles);
  std::vector<std::uint32_t> bits(layer.resolution);
  std::vector<std::uint8_t> valid(layer.resolution),
      line(std::size_t(layer.resolution) * 2 * width), out;

  PngWriter writer;
  auto failed = [&] {
    return fail(ErrorCode::internal, "PNG not written",
                std::string("libpng: ") + writer.message.text);
  };
  if (writer.info == nullptr) return failed();
  const png_structp png = writer.png;
  const auto side = static_cast<png_uint_32>(layer.resolution);
  if (!guarded(png, [&] {
        png_set_write_fn(png, &out, append_bytes, nullptr);
        png_set_compression_level(png, 3);
        png_set_filter(png, 0, PNG_FILTER_NONE);  // painted classes are runs of equal bytes
        png_set_IHDR(png, writer.info, side, side, 8 * width, PNG_COLOR_TYPE_GRAY_ALPHA,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_write_info(png, writer.info);
      }))
    return failed();
  for (int row = 0; row < layer.resolution; ++row) {
    rows.read(row, bits, valid);
    std::uint8_t* at = line.data();
    for (int x = 0; x < layer.resolution; ++x) {
      if (width == 2) *at++ = static_cast<std::uint8_t>(bits[x] >> 8);  // PNG is big-endian
      *at++ = static_cast<std::uint8_t>(bits[x]);
      for (int i = 0; i < width; ++i) *at++ = valid[x] ? 0xff : 0;
    }
    if (!guarded(png, [&] { png_write_row(png, line.data()); })) return failed();
  }
  if (!guarded(png, [&] { png_write_end(png, nullptr); })) return failed();
  return out;
}

Result<TileMap> decode_png(const Layer& layer, std::span<const std::uint8_t> bytes) {
  if (!fits_png(layer.type))
    return fail(ErrorCode::unsupported, "Values not supported by PNG",
                "PNG can store only whole numbers from 0 to 65535. The values of this layer are " +
                    std::string(name(layer.type)) + ". Send texels.tif or texels.npy.",
                "texels");
  const int width = bytes_per_texel(layer.type);
  Reader reader;
  auto damaged = [&] {
    return refuse_raster(std::string("The PNG cannot be read: ") + reader.message.text + ".");
  };
  if (reader.info == nullptr) return damaged();
  reader.rest = bytes;
  const png_structp png = reader.png;
  if (!guarded(png, [&] {
        png_set_read_fn(png, &reader, take_bytes);
        png_set_chunk_malloc_max(png, 8u << 20);
        png_read_info(png, reader.info);
      }))
    return damaged();
  if (auto size = check_raster_size(layer, png_get_image_width(png, reader.info),
                                    png_get_image_height(png, reader.info));
      !size)
    return tl::unexpected(size.error());
  const int color_type = png_get_color_type(png, reader.info),
            bit_depth = png_get_bit_depth(png, reader.info);
  if (color_type != PNG_COLOR_TYPE_GRAY_ALPHA || bit_depth != 8 * width)
    return refuse_raster("The PNG is " + describe(color_type, bit_depth) +
                         ", but the layer needs " + describe(PNG_COLOR_TYPE_GRAY_ALPHA, 8 * width) +
                         " (" + raster_needs(layer) + "; opaque where a texel is valid).");
  if (png_get_interlace_type(png, reader.info) != PNG_INTERLACE_NONE)
    return refuse_raster("The PNG is interlaced. Save it without interlacing.");

  TileMapBuilder builder(layer);
  std::vector<std::uint8_t> line(std::size_t(layer.resolution) * 2 * width);
  if (!guarded(png, [&] { png_read_update_info(png, reader.info); }) ||
      png_get_rowbytes(png, reader.info) != line.size())
    return damaged();
  for (int row = 0; row < layer.resolution; ++row) {
    if (!guarded(png, [&] { png_read_row(png, line.data(), nullptr); })) return damaged();
    const std::uint8_t* at = line.data();
    for (int x = 0; x < layer.resolution; ++x, at += 2 * width) {
      // the high byte of alpha: a texel is valid if it is at least half opaque
      if (at[width] < 0x80) continue;
      const std::uint8_t value[2] = {at[width - 1], at[0]};
      STRATA_TRY(builder.put(x, row, value));
    }
  }
  if (!guarded(png, [&] { png_read_end(png, nullptr); })) return damaged();
  return builder.finish();
}

}  // namespace strata::query
