#include <png.h>
#include <turbojpeg.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "stream/jpeg_pool.h"

namespace strata::stream {
namespace {

struct DestroyTurbo {
  void operator()(void* handle) const { tjDestroy(handle); }
};

// A compressor keeps its tables: one a thread.
tjhandle compressor() {
  thread_local std::unique_ptr<void, DestroyTurbo> handle(tjInitCompress());
  if (!handle) throw std::runtime_error(std::string("libjpeg-turbo does not start: ") + tjGetErrorStr2(nullptr));
  return handle.get();
}

void check_size(std::span<const std::uint8_t> rgba, int width, int height) {
  if (width < 1 || height < 1 || rgba.size() != std::size_t(width) * std::size_t(height) * 4)
    throw std::invalid_argument("A picture's pixels do not have its size.");
}

}  // namespace

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

}  // namespace strata::stream
