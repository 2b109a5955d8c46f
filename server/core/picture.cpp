#include "core/picture.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace strata {
namespace {

struct DestroyTurbo {
  void operator()(void* handle) const { tjDestroy(handle); }
};

// They keep tables: one a thread.
tjhandle codec(tjhandle (*make)()) {
  tjhandle handle = make();
  if (!handle) throw std::runtime_error(std::string("libjpeg-turbo does not start: ") + tjGetErrorStr2(nullptr));
  return handle;
}
tjhandle compressor() {
  thread_local std::unique_ptr<void, DestroyTurbo> handle(codec(tjInitCompress));
  return handle.get();
}
tjhandle decompressor() {
  thread_local std::unique_ptr<void, DestroyTurbo> handle(codec(tjInitDecompress));
  return handle.get();
}

// Releases what libpng keeps between the two halves of reading.
struct PngReader {
  png_image image{};
  PngReader() { image.version = PNG_IMAGE_VERSION; }
  PngReader(const PngReader&) = delete;
  ~PngReader() { png_image_free(&image); }
};

void check_size(std::span<const std::uint8_t> rgba, int width, int height) {
  if (width < 1 || height < 1 || rgba.size() != std::size_t(width) * std::size_t(height) * 4)
    throw std::invalid_argument("A picture's pixels do not have its size.");
}

tl::unexpected<Problem> damaged(PictureFormat format, const std::string& why) {
  return fail(422, "Picture not readable",
              std::string(format == PictureFormat::jpeg ? "The JPEG" : "The PNG") + " cannot be read: " + why + ".");
}

Result<PictureInfo> check_side(PictureInfo info, std::uint64_t width, std::uint64_t height, int largest_side) {
  if (width < 1 || height < 1 || std::max(width, height) > static_cast<std::uint64_t>(largest_side))
    return fail(422, "Picture size not usable",
                "The picture has " + std::to_string(width) + " × " + std::to_string(height) + " pixels; 1 to " +
                    std::to_string(largest_side) + " a side are taken.");
  info.width = static_cast<int>(width);
  info.height = static_cast<int>(height);
  return info;
}

Result<PictureInfo> inspect_jpeg(std::span<const std::uint8_t> bytes, int largest_side) {
  int width = 0, height = 0, sampling = 0, space = 0;
  const tjhandle handle = decompressor();
  if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &width, &height, &sampling, &space) != 0)
    return damaged(PictureFormat::jpeg, tjGetErrorStr2(handle));
  return check_side({PictureFormat::jpeg}, std::max(width, 0), std::max(height, 0), largest_side);
}

Result<PictureInfo> begin_png(PngReader& reader, std::span<const std::uint8_t> bytes, int largest_side) {
  if (!png_image_begin_read_from_memory(&reader.image, bytes.data(), bytes.size()))
    return damaged(PictureFormat::png, reader.image.message);
  return check_side({PictureFormat::png}, reader.image.width, reader.image.height, largest_side);
}

// `divisor` of the sides: 1, 2, 4 or 8.
Result<Picture> decode_jpeg(std::span<const std::uint8_t> bytes, int largest_side, int divisor = 1) {
  const auto info = inspect_jpeg(bytes, largest_side);
  if (!info) return tl::unexpected(info.error());
  const tjscalingfactor scale{1, divisor};
  Picture picture{TJSCALED(info->width, scale), TJSCALED(info->height, scale), {}};
  picture.rgba.resize(std::size_t(picture.width) * std::size_t(picture.height) * 4);
  const tjhandle handle = decompressor();
  // LIMITSCANS: a small file of many scans would take minutes.
  if (tjDecompress2(handle, bytes.data(), bytes.size(), picture.rgba.data(), picture.width, 0, picture.height,
                    TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0) {
    // Strange but harmless bytes are only warnings; a picture that ends too early is one, too, and is refused.
    const std::string why = tjGetErrorStr2(handle);
    if (tjGetErrorCode(handle) == TJERR_FATAL || why.find("Premature end") != std::string::npos)
      return damaged(PictureFormat::jpeg, why);
  }
  return picture;
}

Result<Picture> decode_png(std::span<const std::uint8_t> bytes, int largest_side) {
  PngReader reader;
  const auto info = begin_png(reader, bytes, largest_side);
  if (!info) return tl::unexpected(info.error());
  reader.image.format = PNG_FORMAT_RGBA;
  reader.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // what writers of photographs mean by 16 bits
  Picture picture{info->width, info->height, {}};
  picture.rgba.resize(PNG_IMAGE_SIZE(reader.image));
  if (!png_image_finish_read(&reader.image, nullptr, picture.rgba.data(), 0, nullptr))
    return damaged(PictureFormat::png, reader.image.message);
  return picture;
}

tl::unexpected<Problem> neither() {
  return fail(415, "Picture format not taken", "The picture is neither a JPEG nor a PNG; save it as one of them.");
}

}  // namespace

std::string_view media_type(PictureFormat format) { return format == PictureFormat::jpeg ? "image/jpeg" : "image/png"; }

std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kJpeg[] = {0xff, 0xd8, 0xff}, kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto starts = [&](std::span<const std::uint8_t> magic) {
    return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
  };
  if (starts(kJpeg)) return PictureFormat::jpeg;
  if (starts(kPng)) return PictureFormat::png;
  return std::nullopt;
}

Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  const auto format = picture_format(bytes);
  if (!format) return neither();
  if (*format == PictureFormat::jpeg) return inspect_jpeg(bytes, largest_side);
  PngReader reader;
  return begin_png(reader, bytes, largest_side);
}

Result<Picture> decode_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  const auto format = picture_format(bytes);
  if (!format) return neither();
  return *format == PictureFormat::jpeg ? decode_jpeg(bytes, largest_side) : decode_png(bytes, largest_side);
}

Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side) {
  const auto info = inspect_picture(bytes);
  if (!info) return tl::unexpected(info.error());
  if (info->format != PictureFormat::jpeg) return decode_png(bytes, kLargestPictureSide);
  int divisor = 1;
  while (divisor < 8 && std::max(info->width, info->height) / (2 * divisor) >= side) divisor *= 2;
  return decode_jpeg(bytes, kLargestPictureSide, divisor);
}

std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height,
                                      JpegSettings settings) {
  check_size(rgba, width, height);
  const tjhandle handle = compressor();
  const int sampling = settings.full_color ? TJSAMP_444 : TJSAMP_420;
  std::vector<std::uint8_t> jpeg(tjBufSize(width, height, sampling));
  // The fast transform's errors show only where little else is lost.
  const int transform = settings.quality < 85 ? TJFLAG_FASTDCT : TJFLAG_ACCURATEDCT;
  unsigned char* out = jpeg.data();
  unsigned long size = jpeg.size();
  // NOREALLOC: the buffer has the worst-case size, so the library never replaces it.
  if (tjCompress2(handle, rgba.data(), width, 0, height, TJPF_RGBX, &out, &size, sampling, settings.quality,
                  TJFLAG_NOREALLOC | transform) != 0)
    throw std::runtime_error(std::string("A picture was not encoded: ") + tjGetErrorStr2(handle));
  jpeg.resize(size);
  return jpeg;
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height) {
  check_size(rgba, width, height);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGBA;
  image.flags = PNG_IMAGE_FLAG_FAST;  // half the time for a tenth more bytes
  std::vector<std::uint8_t> png(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = png.size();
  if (!png_image_write_to_memory(&image, png.data(), &size, 0, rgba.data(), 0, nullptr))
    throw std::runtime_error(std::string("A picture was not encoded: ") + image.message);
  png.resize(size);
  return png;
}

}  // namespace strata
