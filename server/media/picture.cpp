#include "media/picture.h"

#include <png.h>
#include <stdio.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <stdexcept>
#include <string>

#include "media/jpeg_facts.h"
#include "media/picture_formats.h"
#include "media/picture_writer.h"

namespace strata {

using namespace std::literals;

namespace {

struct DestroyTurbo {
  void operator()(void* handle) const { tjDestroy(handle); }
};

// Returns the codec of this thread. A codec has state, so threads must not share one.
tjhandle decompressor() {
  thread_local std::unique_ptr<void, DestroyTurbo> handle(tjInitDecompress());
  if (!handle)
    throw std::runtime_error(std::string("libjpeg-turbo does not start: ") +
                             tjGetErrorStr2(nullptr));
  return handle.get();
}

// Releases libpng's data if the second step of reading does not run.
struct PngReader {
  png_image image{};
  PngReader() { image.version = PNG_IMAGE_VERSION; }
  PngReader(const PngReader&) = delete;
  ~PngReader() { png_image_free(&image); }
};

// A callback for the C library that appends the bytes of a stream to a vector.
ssize_t append_bytes(void* vector, const char* bytes, std::size_t count) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(vector);
  try {
    out.insert(out.end(), bytes, bytes + count);
  } catch (const std::bad_alloc&) {
    return 0;
  }
  return static_cast<ssize_t>(count);
}

void check_size(std::span<const std::uint8_t> rgba, int width, int height) {
  if (width < 1 || height < 1 || rgba.size() != std::size_t(width) * std::size_t(height) * 4)
    throw std::invalid_argument("The number of pixels does not match the size of the picture.");
}

Result<PictureInfo> inspect_jpeg(std::span<const std::uint8_t> bytes, int largest_side,
                                 int* color_space = nullptr) {
  int width = 0, height = 0, sampling = 0, space = 0;
  const tjhandle handle = decompressor();
  if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &width, &height, &sampling, &space) !=
      0)
    return damaged_picture(PictureFormat::jpeg, tjGetErrorStr2(handle));
  if (color_space) *color_space = space;
  return sized_picture(PictureFormat::jpeg, std::max(width, 0), std::max(height, 0), largest_side);
}

Result<PictureInfo> begin_png(PngReader& reader, std::span<const std::uint8_t> bytes,
                              int largest_side) {
  if (!png_image_begin_read_from_memory(&reader.image, bytes.data(), bytes.size()))
    return damaged_picture(PictureFormat::png, reader.image.message);
  return sized_picture(PictureFormat::png, reader.image.width, reader.image.height, largest_side);
}

// Converts CMYK pixels to RGBA in place.
void show_inks(std::vector<std::uint8_t>& pixels, bool inverted) {
  for (std::size_t i = 0; i + 3 < pixels.size(); i += 4) {
    const unsigned paper = inverted ? pixels[i + 3] : 255u - pixels[i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned light = inverted ? pixels[i + c] : 255u - pixels[i + c];
      pixels[i + c] = static_cast<std::uint8_t>((light * paper + 127) / 255);
    }
    pixels[i + 3] = 255;
  }
}

bool says_premature_end(std::string why) {
  std::transform(why.begin(), why.end(), why.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return why.find("premature end") != std::string::npos;
}

// `divisor` reduces the sides: 1, 2, 4 or 8.
Result<Picture> decode_jpeg(std::span<const std::uint8_t> bytes, int largest_side,
                            int divisor = 1) {
  int space = 0;
  const auto info = STRATA_TRY(inspect_jpeg(bytes, largest_side, &space));
  const tjscalingfactor scale{1, divisor};
  Picture picture{TJSCALED(info.width, scale), TJSCALED(info.height, scale), {}};
  picture.rgba.resize(std::size_t(picture.width) * std::size_t(picture.height) * 4);
  const tjhandle handle = decompressor();
  const bool is_cmyk = space == TJCS_CMYK || space == TJCS_YCCK;
  // LIMITSCANS is set because a small file with many scans would take minutes.
  if (tjDecompress2(handle, bytes.data(), bytes.size(), picture.rgba.data(), picture.width, 0,
                    picture.height, is_cmyk ? TJPF_CMYK : TJPF_RGBA,
                    TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0) {
    // The library returns only a warning for harmless deviations, and also for a truncated image.
    // Truncated images are rejected.
    const std::string why = tjGetErrorStr2(handle);
    if (tjGetErrorCode(handle) == TJERR_FATAL || says_premature_end(why))
      return damaged_picture(PictureFormat::jpeg, why);
  }
  if (is_cmyk) show_inks(picture.rgba, read_jpeg_facts(bytes).adobe);
  return picture;
}

Result<Picture> decode_png(std::span<const std::uint8_t> bytes, int largest_side) {
  PngReader reader;
  const auto info = STRATA_TRY(begin_png(reader, bytes, largest_side));
  reader.image.format = PNG_FORMAT_RGBA;
  reader.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // the usual color space of 16-bit photographs
  Picture picture{info.width, info.height, {}};
  picture.rgba.resize(PNG_IMAGE_SIZE(reader.image));
  if (!png_image_finish_read(&reader.image, nullptr, picture.rgba.data(), 0, nullptr))
    return damaged_picture(PictureFormat::png, reader.image.message);
  return picture;
}

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view magic, std::size_t at = 0) {
  return bytes.size() >= at + magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

// Common formats that cannot be read. The Error contains their names.
struct OtherFormat {
  std::size_t at;
  std::string_view magic, name;
};
constexpr std::array kOtherFormats{
    OtherFormat{0, "\xabKTX 20"sv, "a KTX2 (Basis Universal) texture"},
    OtherFormat{0, "\xabKTX 11"sv, "a KTX texture"},
    OtherFormat{0, "sB"sv, "a Basis Universal texture"},
    OtherFormat{0, "DDS "sv, "a DDS texture"},
    OtherFormat{0, "GIF8"sv, "a GIF"},
    OtherFormat{0, "8BPS"sv, "a Photoshop file"},
    OtherFormat{0, "\x76\x2f\x31\x01"sv, "an OpenEXR picture"},
    OtherFormat{0, "#?RADIANCE"sv, "a Radiance HDR picture"},
    OtherFormat{4, "ftypavif"sv, "an AVIF picture"},
    OtherFormat{4, "ftyphei"sv, "a HEIC picture"},
    OtherFormat{4, "ftypmif1"sv, "a HEIF picture"},
    OtherFormat{4, "jP  \r\n\x87\n"sv, "a JPEG 2000 picture"},
    OtherFormat{4, "JXL \r\n\x87\n"sv, "a JPEG XL picture"},
};

tl::unexpected<Error> no_format(std::span<const std::uint8_t> bytes) {
  for (const OtherFormat& other : kOtherFormats)
    if (starts_with(bytes, other.magic, other.at))
      return fail(
          ErrorCode::unsupported, "Unsupported picture format",
          "The picture is " + std::string(other.name) +
              ", a format that the server cannot read. Save the picture, or the textures of "
              "the model, as JPEG or PNG.");
  return fail(ErrorCode::unsupported, "Unsupported picture format",
              "The picture is not a JPEG, PNG, TIFF, WebP, BMP or TGA file. Save it in one "
              "of these formats.");
}

}  // namespace

std::string_view media_type(PictureFormat format) {
  switch (format) {
    case PictureFormat::jpeg: return "image/jpeg";
    case PictureFormat::png: return "image/png";
    case PictureFormat::tiff: return "image/tiff";
    case PictureFormat::webp: return "image/webp";
    case PictureFormat::bmp: return "image/bmp";
    case PictureFormat::tga: return "image/x-tga";
  }
  return "application/octet-stream";
}

tl::unexpected<Error> damaged_picture(PictureFormat format, const std::string& why) {
  constexpr std::array kNames{"JPEG", "PNG", "TIFF", "WebP", "BMP", "TGA"};
  return fail(ErrorCode::invalid, "Picture not readable",
              std::string("The ") + kNames.at(static_cast<std::size_t>(format)) +
                  " cannot be read: " + why + ".");
}

Result<PictureInfo> sized_picture(PictureFormat format, std::uint64_t width, std::uint64_t height,
                                  int largest_side) {
  if (width < 1 || height < 1 || std::max(width, height) > static_cast<std::uint64_t>(largest_side))
    return fail(ErrorCode::invalid, "Invalid picture size",
                "The picture has " + std::to_string(width) + " × " + std::to_string(height) +
                    " pixels. Each side must be 1 to " + std::to_string(largest_side) +
                    " pixels long.");
  return PictureInfo{format, static_cast<int>(width), static_cast<int>(height)};
}

std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, "\xff\xd8\xff"sv)) return PictureFormat::jpeg;
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n"sv)) return PictureFormat::png;
  for (const auto magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (starts_with(bytes, magic)) return PictureFormat::tiff;
  if (starts_with(bytes, "RIFF"sv) && starts_with(bytes, "WEBP"sv, 8)) return PictureFormat::webp;
  if (is_bmp(bytes)) return PictureFormat::bmp;
  if (is_tga(bytes)) return PictureFormat::tga;
  return std::nullopt;
}

Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  const auto format = picture_format(bytes);
  if (!format) return no_format(bytes);
  switch (*format) {
    case PictureFormat::jpeg: return inspect_jpeg(bytes, largest_side);
    case PictureFormat::png: {
      PngReader reader;
      return begin_png(reader, bytes, largest_side);
    }
    case PictureFormat::tiff: return inspect_tiff_picture(bytes, largest_side);
    case PictureFormat::webp: return inspect_webp(bytes, largest_side);
    case PictureFormat::bmp:
    case PictureFormat::tga: break;
  }
  return inspect_bitmap(*format, bytes, largest_side);
}

Result<Picture> decode_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  const auto format = picture_format(bytes);
  if (!format) return no_format(bytes);
  switch (*format) {
    case PictureFormat::jpeg: return decode_jpeg(bytes, largest_side);
    case PictureFormat::png: return decode_png(bytes, largest_side);
    case PictureFormat::tiff: return decode_tiff_picture(bytes, largest_side);
    case PictureFormat::webp: return decode_webp(bytes, largest_side);
    case PictureFormat::bmp:
    case PictureFormat::tga: break;
  }
  return decode_bitmap(*format, bytes, largest_side);
}

Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side) {
  const auto info = STRATA_TRY(inspect_picture(bytes));
  if (info.format != PictureFormat::jpeg) return decode_picture(bytes);
  int divisor = 1;
  while (divisor < 8 && std::max(info.width, info.height) / (2 * divisor) >= side) divisor *= 2;
  return decode_jpeg(bytes, kMaxPictureSide, divisor);
}

std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height,
                                      JpegSettings settings) {
  check_size(rgba, width, height);
  PictureWriter writer(PictureFormat::jpeg, width, height, settings);
  writer.put(rgba);
  return writer.finish();
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height) {
  check_size(rgba, width, height);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGBA;
  image.flags = PNG_IMAGE_FLAG_FAST;  // takes half the time, and the file is 10 % larger
  std::vector<std::uint8_t> png;
  const std::unique_ptr<FILE, decltype(&fclose)> file(
      fopencookie(&png, "wb", {nullptr, append_bytes, nullptr, nullptr}), fclose);
  if (!file) throw std::runtime_error("A picture was not encoded: no memory for a stream.");
  if (!png_image_write_to_stdio(&image, file.get(), 0, rgba.data(), 0, nullptr) ||
      fflush(file.get()) != 0)
    throw std::runtime_error(std::string("A picture was not encoded: ") + image.message);
  return png;
}

}  // namespace strata
