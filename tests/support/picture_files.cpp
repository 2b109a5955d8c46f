#include "support/picture_files.h"

#include <stdio.h>  // jpeglib.h requires this include before it

#include <jpeglib.h>
#include <webp/encode.h>

#include <cstdlib>
#include <cstring>
#include <utility>

#include "media/tiff_memory.h"

namespace strata::test {
namespace {

void put(Bytes& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i, value >>= 8) out.push_back(static_cast<std::uint8_t>(value));
}

void write_samples(TIFF* tiff, int width, int height, const TiffSettings& s,
                   const std::function<std::uint32_t(int, int, int)>& sample) {
  const auto row = [&](int y, int first, int last, int x_begin, int x_end) {
    Bytes bytes;
    unsigned collected = 0, bits = 0;
    for (int x = x_begin; x < x_end; ++x)
      for (int k = first; k < last; ++k) {
        const std::uint32_t value = x < width && y < height ? sample(x, y, k) : 0;
        if (s.bits < 8) {
          collected = collected << s.bits | value;
          if ((bits += static_cast<unsigned>(s.bits)) == 8)
            put(bytes, std::exchange(collected, 0), 1), bits = 0;
        } else {
          put(bytes, value, s.bits / 8);
        }
      }
    if (bits > 0) put(bytes, collected << (8 - bits), 1);
    return bytes;
  };
  // libtiff refuses uncompressed tiles of less than 1024 bytes that are not mapped from a file.
  constexpr int kTile = 32;
  const int planes = s.separate ? s.samples : 1;
  for (int plane = 0; plane < planes; ++plane) {
    const int first = s.separate ? plane : 0, last = s.separate ? plane + 1 : s.samples;
    if (!s.tiled) {
      for (int y = 0; y < height; ++y)
        TIFFWriteScanline(tiff, row(y, first, last, 0, width).data(), static_cast<std::uint32_t>(y),
                          static_cast<std::uint16_t>(plane));
      continue;
    }
    for (int top = 0; top < height; top += kTile)
      for (int left = 0; left < width; left += kTile) {
        Bytes tile;
        for (int y = top; y < top + kTile; ++y)
          for (const auto byte : row(y, first, last, left, left + kTile)) tile.push_back(byte);
        TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                      static_cast<std::uint32_t>(top), 0, static_cast<std::uint16_t>(plane));
      }
  }
}

}  // namespace

Bytes tiff_of(int width, int height, const TiffSettings& s,
              const std::function<std::uint32_t(int, int, int)>& sample) {
  Bytes bytes;
  TiffMemory file{{}, &bytes, 0, {}};
  {
    const Tiff tiff = open_tiff(file, s.big_endian ? "wb" : "wl");
    for (int page = 0; page < s.pages; ++page) {
      TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, width);
      TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, height);
      TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, s.bits);
      TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, s.samples);
      TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, s.sample_format);
      TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, s.photometric);
      TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, s.compression);
      TIFFSetField(tiff.get(), TIFFTAG_ORIENTATION, s.orientation);
      TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG,
                   s.separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
      if (s.alpha >= 0) {
        const auto kind = static_cast<std::uint16_t>(s.alpha);
        TIFFSetField(tiff.get(), TIFFTAG_EXTRASAMPLES, 1, &kind);
      }
      if (!s.palette.empty()) {
        const auto* table = s.palette.data();
        const std::size_t count = s.palette.size() / 3;
        TIFFSetField(tiff.get(), TIFFTAG_COLORMAP, table, table + count, table + 2 * count);
      }
      if (s.tiled) {
        TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, 32);
        TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, 32);
      } else {
        TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 5);
      }
      write_samples(
          tiff.get(), width, height, s, page == 0 ? sample : [](int, int, int) { return 0u; });
      TIFFWriteDirectory(tiff.get());
    }
  }
  return bytes;
}

Bytes webp_of(const Bytes& rgba, int width, int height) {
  std::uint8_t* out = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &out);
  Bytes bytes(out, out + size);
  WebPFree(out);
  return bytes;
}

Bytes bmp_of(const Bytes& rgba, int width, int height, int bits, bool top_down) {
  const std::size_t colors = bits == 8 ? 256 : 0, row = (std::size_t(width) * bits + 31) / 32 * 4;
  const std::size_t start = 54 + 4 * colors;
  Bytes out{'B', 'M'};
  put(out, start + row * height, 4);
  put(out, 0, 4);
  put(out, start, 4);
  put(out, 40, 4);
  put(out, static_cast<std::uint32_t>(width), 4);
  put(out, static_cast<std::uint32_t>(top_down ? -height : height), 4);
  put(out, 1, 2);
  put(out, static_cast<std::uint32_t>(bits), 2);
  put(out, 0, 24);
  // Each entry is (255 − i, i, i), with blue in the low byte.
  for (std::uint32_t i = 0; i < colors; ++i) put(out, (255 - i) << 16 | i << 8 | i, 4);
  for (int i = 0; i < height; ++i) {
    const int y = top_down ? i : height - 1 - i;
    const std::size_t begin = out.size();
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* p = &rgba[4 * (std::size_t(y) * width + x)];
      if (bits == 8)
        put(out, p[0], 1);
      else
        put(out,
            std::uint32_t{p[2]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[0]} << 16 |
                std::uint32_t{p[3]} << 24,
            bits / 8);
    }
    out.resize(begin + row);
  }
  return out;
}

Bytes tga_of(const Bytes& rgba, int width, int height, int bits, bool packed) {
  Bytes out(18, 0);
  out[2] = static_cast<std::uint8_t>((bits == 8 ? 3 : 2) + (packed ? 8 : 0));
  out[12] = static_cast<std::uint8_t>(width), out[13] = static_cast<std::uint8_t>(width >> 8);
  out[14] = static_cast<std::uint8_t>(height), out[15] = static_cast<std::uint8_t>(height >> 8);
  out[16] = static_cast<std::uint8_t>(bits);
  out[17] = bits == 32 ? 8 : 0;
  const auto put_pixel = [&](const std::uint8_t* p) {
    if (bits == 8)
      put(out, p[0], 1);
    else
      put(out,
          std::uint32_t{p[2]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[0]} << 16 |
              std::uint32_t{p[3]} << 24,
          bits / 8);
  };
  for (int y = height - 1; y >= 0; --y)  // bottom row first
    for (int x = 0; x < width;) {
      const std::uint8_t* p = &rgba[4 * (std::size_t(y) * width + x)];
      int same = 1;
      while (packed && same < 128 && x + same < width && std::memcmp(p, p + 4 * same, 4) == 0)
        ++same;
      if (packed) put(out, same > 1 ? 127u + static_cast<unsigned>(same) : 0u, 1);
      put_pixel(p);
      x += same;
    }
  return out;
}

Bytes cmyk_jpeg_of(const Bytes& rgba, int width, int height, Inks inks) {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, inks == Inks::adobe_ycck ? JCS_YCCK : JCS_CMYK);
  jpeg_set_quality(&jpeg, 98, TRUE);
  for (int i = 0; i < 4; ++i) jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
  if (inks == Inks::plain_cmyk) jpeg.write_Adobe_marker = FALSE;
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < height; ++y) {
    Bytes row;
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* p = &rgba[4 * (std::size_t(y) * width + x)];
      // These CMYK colors have no black, so the stored inverted value is the color itself.
      for (int c = 0; c < 3; ++c)
        row.push_back(inks == Inks::plain_cmyk ? static_cast<std::uint8_t>(255 - p[c]) : p[c]);
      row.push_back(inks == Inks::plain_cmyk ? 0 : 255);
    }
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&jpeg, rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  Bytes bytes(out, out + size);
  std::free(out);
  return bytes;
}

}  // namespace strata::test
