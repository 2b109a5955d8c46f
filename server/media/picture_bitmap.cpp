#include <algorithm>
#include <climits>
#include <cstdlib>
#include <memory>
#include <string>

#include "media/picture_formats.h"

// stb_image is used for BMP and TGA in memory only. The limit of sizes is kMaxPictureSide.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace strata {
namespace {

static_assert(STBI_MAX_DIMENSIONS == kMaxPictureSide);

// Reads a little-endian number of a header. Bytes beyond the end are read as 0.
std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) {
    const std::size_t place = at + static_cast<std::size_t>(i);
    if (place < bytes.size()) value |= std::uint32_t{bytes[place]} << (8 * i);
  }
  return value;
}

constexpr std::size_t kBmpFileHeader = 14;
constexpr std::uint32_t kBmpCoreHeader = 12;

struct BmpHeader {
  std::uint64_t pixels_at = 0, width = 0, height = 0;
  std::uint32_t bits = 0, compression = 0;
};

BmpHeader bmp_header(std::span<const std::uint8_t> bytes) {
  BmpHeader header;
  header.pixels_at = number(bytes, 10, 4);
  if (number(bytes, kBmpFileHeader, 4) == kBmpCoreHeader) {
    header.width = number(bytes, 18, 2);
    header.height = number(bytes, 20, 2);
    header.bits = number(bytes, 24, 2);
  } else {
    header.width = number(bytes, 18, 4);
    // A negative height means that the top row is first.
    const std::uint32_t height = number(bytes, 22, 4);
    header.height = height >> 31 ? 0u - height : height;
    header.bits = number(bytes, 28, 2);
    header.compression = number(bytes, 30, 4);
  }
  return header;
}

constexpr std::size_t kTgaHeader = 18;
struct TgaHeader {
  std::uint32_t id = 0, has_map = 0, kind = 0, map_length = 0, map_bits = 0, width = 0, height = 0,
                bits = 0, flags = 0;
  bool is_packed() const { return kind >= 8; }
  std::uint64_t pixels_at() const {
    return kTgaHeader + id + std::uint64_t{map_length} * ((map_bits + 7) / 8);
  }
};

TgaHeader tga_header(std::span<const std::uint8_t> bytes) {
  return {number(bytes, 0, 1),  number(bytes, 1, 1),  number(bytes, 2, 1),
          number(bytes, 5, 2),  number(bytes, 7, 1),  number(bytes, 12, 2),
          number(bytes, 14, 2), number(bytes, 16, 1), number(bytes, 17, 1)};
}

bool is_one_of(std::uint32_t value, std::initializer_list<std::uint32_t> known) {
  return std::find(known.begin(), known.end(), value) != known.end();
}

// Detects truncated files, because stb_image reads zeros beyond the end.
bool is_whole_bmp(std::span<const std::uint8_t> bytes) {
  const BmpHeader header = bmp_header(bytes);
  const std::uint64_t row = (header.width * header.bits + 31) / 32 * 4,
                      last = (header.width * header.bits + 7) / 8;
  return header.pixels_at + (header.height - 1) * row + last <= bytes.size();
}

bool is_whole_tga(std::span<const std::uint8_t> bytes) {
  const TgaHeader header = tga_header(bytes);
  const std::uint64_t pixel_bytes = (header.bits + 7) / 8;
  std::uint64_t left = std::uint64_t{header.width} * header.height, at = header.pixels_at();
  if (!header.is_packed()) return at + left * pixel_bytes <= bytes.size();
  while (left > 0 && at < bytes.size()) {
    const std::uint8_t packet = bytes[at];
    const std::uint64_t count = (packet & 127u) + 1u;
    at += 1 + pixel_bytes * (packet & 128u ? 1 : count);
    left -= std::min(left, count);
  }
  return left == 0 && at <= bytes.size();
}

}  // namespace

bool is_bmp(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kBmpFileHeader + 4 && bytes[0] == 'B' && bytes[1] == 'M' &&
         is_one_of(number(bytes, kBmpFileHeader, 4), {kBmpCoreHeader, 40, 52, 56, 64, 108, 124});
}

bool is_tga(std::span<const std::uint8_t> bytes) {
  if (bytes.size() <= kTgaHeader) return false;
  const TgaHeader header = tga_header(bytes);
  if (header.width == 0 || header.height == 0 || header.flags >> 6 != 0 || (header.flags & 15u) > 8)
    return false;
  const bool has_map =
      header.has_map == 1 && header.map_length > 0 && is_one_of(header.map_bits, {15, 16, 24, 32});
  const bool has_no_map = header.has_map == 0 && number(bytes, 3, 4) == 0 && header.map_bits == 0;
  switch (header.kind & ~8u) {
    case 1: return has_map && is_one_of(header.bits, {8, 16});
    case 2: return (has_map || has_no_map) && is_one_of(header.bits, {15, 16, 24, 32});
    case 3: return has_no_map && is_one_of(header.bits, {8, 16});
    default: return false;
  }
}

Result<PictureInfo> inspect_bitmap(PictureFormat format, std::span<const std::uint8_t> bytes,
                                   int largest_side) {
  if (format == PictureFormat::tga) {
    const TgaHeader header = tga_header(bytes);
    return sized_picture(format, header.width, header.height, largest_side);
  }
  const BmpHeader header = bmp_header(bytes);
  auto info = STRATA_TRY(sized_picture(format, header.width, header.height, largest_side));
  if (header.compression == 1 || header.compression == 2)
    return damaged_picture(format, "it uses run-length compression; save it without compression");
  if (header.compression > 3 || !is_one_of(header.bits, {1, 4, 8, 16, 24, 32}))
    return damaged_picture(
        format, "it has " + std::to_string(header.bits) + " bits per pixel and compression " +
                    std::to_string(header.compression) + "; save it with 24 bits, uncompressed");
  return info;
}

Result<Picture> decode_bitmap(PictureFormat format, std::span<const std::uint8_t> bytes,
                              int largest_side) {
  const auto info = STRATA_TRY(inspect_bitmap(format, bytes, largest_side));
  if (!(format == PictureFormat::bmp ? is_whole_bmp(bytes) : is_whole_tga(bytes)))
    return damaged_picture(format, "it ends too early");
  if (bytes.size() > INT_MAX) return damaged_picture(format, "it is larger than 2 GB");
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&std::free)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                            &channels, 4),
      std::free);
  if (!pixels) return damaged_picture(format, stbi_failure_reason());
  if (width != info.width || height != info.height)
    return damaged_picture(format, "its header is inconsistent");
  const std::size_t size = std::size_t(width) * std::size_t(height) * 4;
  return Picture{width, height, {pixels.get(), pixels.get() + size}};
}

}  // namespace strata
